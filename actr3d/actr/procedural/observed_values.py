"""What productions see that no model's change records: plain objects, properties, and what modellers' functions say.

It is not looked at again for an explanation: a property may answer otherwise, or change something, each time it is
asked. What can be read without running any code is told to a trace after each match, the rest as it was last seen.
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
    """What a modeller's function in a pattern said when it was last asked."""

    given: Bindings
    """The variables as it got them."""
    agrees: bool
    bound: Bindings
    """The variables after it, and after the functions that followed it."""
    time: int
    """When [us]."""

    def plain(self) -> list[Any]:
        """Returns it as plain values, for the trace and for explanations."""
        return [_plain(self.given), self.agrees, _plain(self.bound)]


def _plain(bound: Bindings) -> dict[str, Any]:
    """Returns variables as a trace keeps them: plain values as they are, others as text."""
    found: dict[str, Any] = {}
    for name, value in bound.items():
        found[name] = value if type(value) in LASTING_TYPES else plain_text(value) or f"<{type(value).__name__}>"
    return found


def answer_label(production: str, number: int) -> str:
    """Returns the label under which a trace has what the function in a production's condition said."""
    return f"{production}()[{number}]"


def tells_changes(target: Any, key: Any) -> bool:
    """Tells whether a trace learns of every change of an attribute, as long as its value is plain."""
    if not isinstance(target, Model) or not isinstance(key, str) or "." in key:
        return False
    return type(target).__getitem__ is Model.__getitem__ and key not in UNWATCHED and key[:1] != "_"


def is_recorded(target: Any, key: Any) -> bool:
    """Tells whether every change of what a reading reads goes through the trace by itself.

    A key of None asks whether the target is empty.
    """
    if key is None or reads_chunk(target, key):
        return hasattr(target, "chunk")
    return tells_changes(target, key) and _lasts(target, key)


def _lasts(target: Any, key: str) -> bool:
    """Tells whether an attribute's present value never changes by itself."""
    own: dict[str, Any] = target.__dict__
    return type(own.get(key, MISSING)) in LASTING_TYPES


class Observed:
    """What the productions of one system see beyond what the trace records by itself."""

    def __init__(self) -> None:
        self.looked: dict[str, Any] = {}
        """What productions saw when they last looked, as text; None for what was not there."""
        self.asked: dict[tuple[str, int], Asked] = {}
        """What functions said, by the production's name and the condition's number."""
        self.used = False
        """Whether productions look at anything of that kind."""
        self._watched: dict[str, tuple[Any, Any]] = {}
        self._told: dict[str, Any] = {}
        self._listener: object = None

    def watch(self, name: str, key: Any, target: Any) -> str:
        """Takes in one reading, and returns its label; a key of None asks whether the target is empty."""
        label = f"{name}.{key}"
        if not (hasattr(target, "chunk") if key is None else reads_chunk(target, key)):
            self._watched[label] = target, key
            self.used = True
        return label

    def news(self, listener: object) -> dict[str, Any]:
        """Returns what has changed since the same listener last asked, or all for a new one.

        Values are as text, None for what is not there; emptiness is True or False; a function's word is a list of the
        variables before, whether it agreed, and the variables after it.
        """
        if listener is not self._listener:
            self._listener, self._told = listener, {}
        known = self.everything()
        news = {label: value for label, value in known.items() if self._told.get(label, UNKNOWN) != value}
        # What is not among it is told by the trace's other events now; if it comes back, that is news.
        self._told = known
        return news

    def everything(self) -> dict[str, Any]:
        """Returns all that productions see now, or saw when they last looked, as `news` tells it."""
        known: dict[str, Any] = {}
        for label, (target, key) in self._watched.items():
            if not (tells_changes(target, key) and _lasts(target, key)):
                value = self._reading(label, target, key)
                if value is not UNKNOWN:
                    known[label] = value
        for (name, number), asked in self.asked.items():
            known[answer_label(name, number)] = asked.plain()
        return known

    def _reading(self, label: str, target: Any, key: Any) -> Any:
        if key is None:
            return plain_empty(target)
        value = plain_value(target, key)
        if value is MISSING:
            return None
        text = None if value is UNKNOWN else plain_text(value)
        return self.looked.get(label, UNKNOWN) if text is None else text
