"""Relates commands of users to the model's parameters that they change during a run."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from actr3d.change import CHANGES
from actr3d.parameter_schema import Parameter


def value_changed_by(parameters: Iterable[Parameter], data: Mapping[str, Any]) -> tuple[str, Any] | None:
    """Returns the name of the parameter or aperture that a recorded command changes, and its new value; None if it changes none."""
    from actr3d.simulation import Command  # takes long to import; the server needs only the names in this module

    one = Command.from_data(0, data)
    set_by = parameter_set_by(parameters, one.word, one.values, one.named, one.body)
    if set_by is not None:
        return set_by[0].name, set_by[1]
    return (str(one.named.get("name", one.word)), one.values[0]) if one.word == "aperture" and one.values else None


def parameter_set_by(
    parameters: Iterable[Parameter], word: str, values: Sequence[Any], named: Mapping[str, Any], body: str | None
) -> tuple[Parameter, Any] | None:
    """Returns the parameter that a command changes, and its new value; None if it changes none.

    Args:
        parameters: The parameters of the model.
        word: The command.
        values: Its arguments.
        named: Its named arguments.
        body: The body that it is for, if any.
    """
    for parameter in parameters:
        live = parameter.live
        if live is None or live.word != word or live.body not in (None, body):
            continue
        before = list(live.before)
        if word in CHANGES:
            signature = inspect.signature(CHANGES[word])
            try:
                given = signature.bind(*values, **named).arguments
            except TypeError:
                continue  # it cannot be carried out
            same = signature.bind_partial(*before).arguments
            name = next((name for name in signature.parameters if name not in same), "")
            usual = {field: same.get(field, one.default) for field, one in signature.parameters.items()}
            if name in given and all(value == usual[field] for field, value in given.items() if field != name):
                return parameter, given[name]
        elif not named and len(values) == len(before) + 1 and list(values[:-1]) == before:
            return parameter, values[-1]
    return None
