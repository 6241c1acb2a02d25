"""Builds what a model file describes: `build(parameters) -> Simulation`, with a frozen dataclass of parameters."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import asdict, fields, is_dataclass
from pathlib import Path
from typing import Any, get_type_hints

from actr3d.actr.helper_texts import HelperTexts
from actr3d.actr.loading import load_text
from actr3d.errors import ConfigurationError, ModelFileError, did_you_mean
from actr3d.simulation import Simulation


def build(
    source: str, filename: str, settings: Mapping[str, Any], folder: Path | None = None, helpers: HelperTexts | None = None
) -> tuple[Simulation, dict[str, Any]]:
    """Loads a model's text and builds its simulation.

    Args:
        source: The text.
        filename: How tracebacks call it.
        settings: Values of its parameters, by name; the others have their defaults.
        folder: Where it finds its own helper modules; None for none.
        helpers: Where the texts of these are kept, and come from where they are known.

    Returns:
        The simulation, and the values of all parameters by name.

    Raises:
        ModelFileError: If it is no Python 3, or its `build` is not what it should be.
        ConfigurationError: If there is no such parameter, or it does not take such a value.
        Exception: Whatever it raises itself.
    """
    module = load_text(source, filename, folder=folder, helpers=helpers)
    function: Any = module.build
    names = list(inspect.signature(function).parameters)
    if len(names) > 1:
        raise ModelFileError(f"{filename}: build takes one argument, its parameters (it takes {', '.join(names)})")
    given: list[Any] = []
    if names:
        kind = get_type_hints(function).get(names[0])
        if not isinstance(kind, type) or not is_dataclass(kind):
            raise ModelFileError(f"{filename}: build({names[0]}) does not say which dataclass its parameters are of")
        given = [_parameters(kind, settings)]
    elif settings:
        raise ConfigurationError(f"{filename}: build takes no parameters (given {', '.join(settings)})")
    simulation = function(*given)
    if not isinstance(simulation, Simulation):
        raise ModelFileError(f"{filename}: build must return a Simulation (returned {simulation!r})")
    vars(simulation)["_built_by"] = module  # its helper modules go with it, and those may be all that the minds are of
    return simulation, asdict(given[0]) if given else {}


def _parameters(kind: type[Any], settings: Mapping[str, Any]) -> Any:
    known = [field.name for field in fields(kind)]
    for name in settings:
        if name not in known:
            hint = did_you_mean(name, known)
            raise ConfigurationError(f"{kind.__name__} has no parameter '{name}'{hint}; it has: {', '.join(known) or 'none'}")
    try:
        return kind(**settings)
    except TypeError as error:
        raise ConfigurationError(f"{kind.__name__}: {error}") from None
