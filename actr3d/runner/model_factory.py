"""Builds what a model file describes: `build(parameters) -> Simulation`, with a frozen dataclass of parameters."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any, get_type_hints

from actr3d.actr.loading import load_text
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.errors import ConfigurationError, ModelFileError, SettingError, alternatives
from actr3d.parameter_schema import Parameter, parameters_of
from actr3d.runner.build_check import RIGHT, check_build, line_of_build
from actr3d.simulation import Simulation


class Blueprint:
    """A loaded model file that can build simulations.

    Args:
        source: The source text.
        filename: The file name used in tracebacks.
        folder: The folder of its own helper modules; None for none.
        helpers: Stores the texts of these modules, and provides those that are known already.

    Raises:
        ModelFileError: If the source is not Python 3, or its `build` is not valid.
        Exception: Any error that the model itself raises.
    """

    def __init__(self, source: str, filename: str, folder: Path | None = None, helpers: HelperTexts | None = None) -> None:
        check_build(source, filename)
        self._filename = filename
        self._module = load_text(source, filename, folder=folder, helpers=helpers)
        self._build: Any = getattr(self._module, "build", None)
        code = getattr(self._build, "__code__", None)
        self._place = f"{filename}:{code.co_firstlineno if code is not None else line_of_build(source)}"
        if not callable(self._build):
            found = f"it is {self._build!r}" if hasattr(self._module, "build") else "there is none"
            raise ModelFileError(f"{self._place}: build is not a function when the file has run ({found}); write {RIGHT}")
        try:
            names = list(inspect.signature(self._build).parameters)
        except (TypeError, ValueError) as error:
            raise ModelFileError(f"{self._place}: the arguments of build are not known ({error}); write {RIGHT}") from None
        self._kind: type[Any] | None = None
        if names:
            self._kind = get_type_hints(self._build).get(names[0])
            if not isinstance(self._kind, type) or not is_dataclass(self._kind):
                found = str(getattr(self._kind, "__name__", self._kind)).replace(f"{self._module.__name__}.", "")
                raise ModelFileError(f"{self._place}: build({names[0]}: {found}): its parameter must be a dataclass; write {RIGHT}")
        self.fields: tuple[Parameter, ...] = () if self._kind is None else parameters_of(self._kind)
        """Its parameters."""

    def build(self, settings: Mapping[str, Any]) -> tuple[Simulation, dict[str, Any]]:
        """Builds a simulation.

        Args:
            settings: Values of its parameters, by name; the others have their defaults.

        Returns:
            The simulation, and the values of all parameters by name.

        Raises:
            SettingError: If a parameter does not exist, or its value is not valid.
            ModelFileError: If the file builds something else.
            Exception: Any error that the model itself raises.
        """
        given = [] if self._kind is None else [self._parameters(self._kind, settings)]
        if settings and not given:
            raise SettingError(f"{self._filename}: build takes no parameters (given {', '.join(settings)})")
        simulation = self._build(*given)
        if not isinstance(simulation, Simulation):
            raise ModelFileError(f"{self._place}: build must return a Simulation (returned {simulation!r})")
        vars(simulation)["_built_by"] = self._module  # keeps its helper modules alive, which the agents may need
        return simulation, asdict(given[0]) if given else {}

    def _parameters(self, kind: type[Any], settings: Mapping[str, Any]) -> Any:
        known = [field.name for field in self.fields]
        for name in settings:
            if name not in known:
                raise SettingError(f"{kind.__name__} has no parameter '{name}'{alternatives(name, known, 'it has:')}")
        try:
            return kind(**settings)
        except ConfigurationError as error:
            raise SettingError(str(error)) from None
        except TypeError as error:
            raise SettingError(f"{kind.__name__}: {error}") from None
