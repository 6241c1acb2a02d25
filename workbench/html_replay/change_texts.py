"""Writes users' changes as the timeline does: `aperture 50 -> 40 cm`, `speed 1.2 -> 1.5 m/s`, `set buffer goal count 2 -> count 3`.

The page's own texts are in `static/timeline/commands.js`.
"""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Iterable, Mapping
from typing import Any, cast

import numpy as np
from mujoco import MjModel

from actr3d.change import CHANGES
from actr3d.simulation import Command
from actr3d.trace import TraceEvent
from actr3d.values import to_json
from workbench.live_parameters import parameter_set_by
from workbench.loader import ModelListing


class ChangeTexts:
    """Knows the values that changes replace; it receives all events of a recording in their order.

    Args:
        listing: The model, as far as its text says what it is.
        values: The parameters at the start of the run, by name.
        widths: The widths of apertures at the start [m], by the number of the simulation and the name.
    """

    def __init__(self, listing: ModelListing, values: Mapping[str, Any], widths: Mapping[tuple[int, str], float]) -> None:
        self._listing = listing
        self._known: dict[tuple[Any, ...], str] = {("parameter", 1, name): value_text(value) for name, value in values.items()}
        self._known |= {("aperture", *key): _centimetres(width) for key, width in widths.items()}
        self._buffers: dict[str, list[str]] = {}
        """The contents of buffers: the one before, and the present one, which a change of a buffer has just set."""

    def take(self, event: TraceEvent) -> None:
        """Notes the chunk of a buffer."""
        if event.kind == "buffer":
            before = self._buffers.get(event.source, ["", "empty"])[-1]
            self._buffers[event.source] = [before, chunk_text(event.data.get("chunk"))]

    def text(self, event: TraceEvent) -> str:
        """Returns a command as text."""
        given = cast("dict[str, Any]", event.data.get("data") or {})
        one = Command(0, str(event.data.get("command")), tuple(given.get("values") or ()), given.get("named") or {}, given.get("body"))
        if one.word != "aperture":
            found = parameter_set_by(self._listing.parameters, one.word, one.values, one.named, one.body)
            if found is not None:
                parameter, value = found
                return f"{parameter.name} {self._changed(('parameter', event.run, parameter.name), value_text(value), parameter.unit)}"
        change = None if one.body else CHANGES.get(one.word)
        arguments = None if change is None else _arguments(change, one)
        if change is None or arguments is None:
            named = [f"{name}: {value_text(value)}" for name, value in one.named.items()]
            return " ".join([one.word, *([one.body] if one.body else []), *map(value_text, one.values), *named])
        title = one.word.replace("_", " ")
        if one.word == "aperture" and isinstance(arguments["width"], int | float):
            name = arguments["name"]
            what = self._changed(("aperture", event.run, name), _centimetres(arguments["width"]), "cm")
            return f"aperture {what}" if name == "aperture" else f"aperture {name} {what}"
        if change.of == "parameter":
            path = arguments["path"]
            return f"{title} {path} {self._changed(('path', path), value_text(arguments['value']))}"
        if change.of == "buffer":
            before = self._buffers.get(arguments["buffer"], ["empty"])[0]
            return f"{title} {arguments['buffer']} {before} -> {arguments.get('chunk', 'empty')}"
        if one.word == "move":
            return f"{title} {arguments['object']} to {_place(**arguments)}"
        filled = re.sub(r"\{(\w+)\}", lambda found: value_text(arguments.get(found[1])), change.text)
        return f"{title} {filled}"

    def _changed(self, key: tuple[Any, ...], text: str, unit: str | None = None) -> str:
        before = self._known.get(key)
        self._known[key] = text
        return f"{'' if before is None else f'{before} -> '}{text}{f' {unit}' if unit else ''}"


def chunk_text(slots: Any) -> str:
    """Returns a chunk in the notation of models, with its values as the trace shows them."""
    if not isinstance(slots, Mapping):
        return "empty" if slots is None else str(slots)
    named = cast("Mapping[str, Any]", slots)
    return " ".join(value_text(value) if name.isdecimal() else f"{name}:{value_text(value)}" for name, value in named.items())


def value_text(value: Any) -> str:
    """Returns a value as the trace shows it: with at most four decimals."""
    if isinstance(value, float):
        return np.format_float_positional(value, 4, trim="-")
    return "none" if value is None else value if isinstance(value, str) else to_json(value)


def widths_in(model: MjModel, walls: Mapping[str, Any]) -> Iterable[tuple[str, float]]:
    """Yields the names and the widths [m] of apertures in a compiled scene.

    Args:
        model: The scene.
        walls: The places of the apertures, by name; see `actr3d.world.scene_objects.Gap`.
    """
    for name, gap in walls.items():
        left, right = gap["segments"]
        between = math.dist(*(model.body_pos[model.geom_bodyid[side]][:2] for side in (left, right)))
        yield name, float(between - model.geom_size[left][1] - model.geom_size[right][1])


def _arguments(change: type[Any], one: Command) -> dict[str, Any] | None:
    """Returns the arguments of a change by the names of its fields; None if they do not fit."""
    signature = inspect.signature(change)
    try:
        bound = signature.bind(*one.values, **one.named)
    except TypeError:
        return None
    bound.apply_defaults()
    return bound.arguments


def _place(*, x: float, y: float, heading: float | None, **_: Any) -> str:
    turned = "" if heading is None else f", {math.degrees(heading):.0f}°"
    return f"({value_text(x)}, {value_text(y)}) m{turned}"


def _centimetres(width: float) -> str:
    return f"{100 * width:.1f}".removesuffix(".0")
