"""What productions read that is not recorded as a change of a model: plain objects, properties, results of modellers' functions.

An explanation must not read it again, because a property may return another value, or change something, at each call.
After each match, a trace receives the current values that can be read without running any code, and the last known of the rest.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from actr3d.actr.chunks.chunk import LASTING_TYPES
from actr3d.actr.chunks.pattern import MISSING, Bindings
from actr3d.actr.chunks.safe_text import plain_text
from actr3d.actr.kernel.buffer import reads_chunk
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tracing import UNWATCHED
from actr3d.actr.procedural.safe_reading import UNKNOWN, plain_empty, plain_value


class Asked(NamedTuple):
    """The last result of a modeller's function in a pattern."""

    given: Bindings
    """The variables before the call."""
    agrees: bool
    bound: Bindings
    """The variables after it, and after the functions that followed."""
    time: int
    """The time of the call [us]."""

    def plain(self) -> list[Any]:
        """Returns the result as plain values, for the trace and for explanations."""
        return [_plain(self.given), self.agrees, _plain(self.bound)]


def _plain(bound: Bindings) -> dict[str, Any]:
    """Returns variables as a trace keeps them: plain values unchanged, others as text."""
    found: dict[str, Any] = {}
    for name, value in bound.items():
        found[name] = value if type(value) in LASTING_TYPES else plain_text(value) or f"<{type(value).__name__}>"
    return found


def result_label(production: str, number: int) -> str:
    """Returns the label under which a trace has the result of the function in a production's condition."""
    return f"{production}()[{number}]"


def records_changes(target: Any, key: Any) -> bool:
    """Returns whether a trace records every change of an attribute, as long as its value is plain."""
    if not isinstance(target, Model) or not isinstance(key, str) or "." in key:
        return False
    return type(target).__getitem__ is Model.__getitem__ and key not in UNWATCHED and key[:1] != "_"


def is_recorded(target: Any, key: Any) -> bool:
    """Returns whether the trace records every change of a slot or attribute anyway.

    A key of None means whether the target is empty.
    """
    if key is None or reads_chunk(target, key):
        return hasattr(target, "chunk")
    return records_changes(target, key) and _lasts(target, key)


def _lasts(target: Any, key: str) -> bool:
    """Returns whether an attribute's current value is immutable."""
    own: dict[str, Any] = target.__dict__
    return type(own.get(key, MISSING)) in LASTING_TYPES


class Observed:
    """What the productions of one system read beyond what the trace records anyway."""

    def __init__(self) -> None:
        self.looked: dict[str, Any] = {}
        """What productions read last, as text; None for what was missing."""
        self.asked: dict[tuple[str, int], Asked] = {}
        """The last results of functions, by the production's name and the condition's number."""
        self.used = False
        """Whether productions read anything of that kind."""
        self._watched: dict[str, tuple[Any, Any]] = {}
        self._reported: dict[str, Any] = {}
        self._listener: object = None

    def watch(self, name: str, key: Any, target: Any) -> str:
        """Adds one reading, and returns its label; a key of None means whether the target is empty."""
        label = f"{name}.{key}"
        if not (hasattr(target, "chunk") if key is None else reads_chunk(target, key)):
            self._watched[label] = target, key
            self.used = True
        return label

    def news(self, listener: object) -> dict[str, Any]:
        """Returns what has changed since the last call by the same listener, or everything for a new one.

        Values are text, None for what is missing; emptiness is True or False; a function's result is a list of the variables
        before, whether it agreed, and the variables after.
        """
        if listener is not self._listener:
            self._listener, self._reported = listener, {}
        known = self.everything()
        news = {label: value for label, value in known.items() if self._reported.get(label, UNKNOWN) != value}
        # The trace's other events now report what is not included here; if it is included again, that is news.
        self._reported = known
        return news

    def everything(self) -> dict[str, Any]:
        """Returns everything that productions read, now or last, in the form of `news`."""
        known: dict[str, Any] = {}
        for label, (target, key) in self._watched.items():
            if not (records_changes(target, key) and _lasts(target, key)):
                value = self._reading(label, target, key)
                if value is not UNKNOWN:
                    known[label] = value
        for (name, number), asked in self.asked.items():
            known[result_label(name, number)] = asked.plain()
        return known

    def _reading(self, label: str, target: Any, key: Any) -> Any:
        if key is None:
            return plain_empty(target)
        value = plain_value(target, key)
        if value is MISSING:
            return None
        text = None if value is UNKNOWN else plain_text(value)
        return self.looked.get(label, UNKNOWN) if text is None else text
