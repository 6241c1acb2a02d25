"""The port: through it a mind tells its body what to do, and asks it what it senses."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from actr3d.actr.kernel.events import Event
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.parameters import named_parameters
from actr3d.actr.kernel.tree import lineage, path_of, subtree
from actr3d.actr.modules.answers import answer_slots, plain_answer
from actr3d.errors import SimulationError

_LIBRARY = str(Path(__file__).parents[2])
RAW_VISION = ("view",)
"""What only a vision module should ask a body for: whoever else does steps outside what vision gives an agent."""


class Reading(Event):
    """An answer that the body will give: `yield reading` waits for it, `reading.value` is it."""

    __slots__ = ("_value", "word")

    def __init__(self, word: str) -> None:
        super().__init__(Reading)
        self.word = word

    @property
    def value(self) -> Any:
        """What the body answered.

        Raises:
            SimulationError: If it has not answered yet.
        """
        if not self.done:
            raise SimulationError(f"the body has not answered '{self.word}' yet; wait for it: yield reading")
        return self._value

    def describe(self) -> str:
        """Names what was asked."""
        return f"reading of '{self.word}'"


@dataclass(slots=True)
class Request:
    """What a mind wants of its body, until the body's next tock."""

    body: str
    """The body's name."""
    word: str
    values: tuple[Any, ...]
    named: Mapping[str, Any]
    place: str
    """`file:line` where the modeller asked, for error messages."""
    port: Port
    reading: Reading | None = None
    """Where the answer goes; None where something is to be done and nothing answered."""
    to_buffer: bool = False
    """Whether the answer goes into the port's buffer."""


class Embodiment:
    """Joins a mind to its body, by the name of the body and the list of what the mind wants of it.

    Args:
        body: The body's name.
        outbox: Where requests wait for the next tock; shared by all minds of a simulation, in the order they came.
    """

    __slots__ = ("body", "outbox")

    def __init__(self, body: str, outbox: list[Request]) -> None:
        self.body = body
        self.outbox = outbox

    def join(self, mind: Model) -> None:
        """Gives a mind, and all ports below it, this body."""
        mind.__dict__["_embodiment"] = self


class Port(Model):
    """A part of a mind that speaks to the body: it tells it what to do, and takes its answers in."""

    def _tell(self, word: str, *values: Any, named: Mapping[str, Any] | None = None, place: str | None = None) -> None:
        """Tells the body to do something, for the modeller's line at `place`, or for the one that is running."""
        named = {} if named is None else named
        embodiment = self._joined(word)
        self._trace_request("set", word=word, **_given(values, named))
        embodiment.outbox.append(Request(embodiment.body, word, values, named, place or place_of_caller(), self))

    def _inquire(
        self, word: str, values: tuple[Any, ...] = (), options: Mapping[str, Any] | None = None, place: str | None = None, **how: bool
    ) -> Reading:
        """Asks the body what it senses."""
        embodiment = self._joined(word)
        reading = Reading(word)
        embodiment.outbox.append(Request(embodiment.body, word, values, options or {}, place or place_of_caller(), self, reading, **how))
        return reading

    def _kept_private(self, word: str) -> str | None:
        """Returns the option by which this part lets others ask for a word that it keeps to itself; None where it keeps none."""
        return None

    def _joined(self, word: str) -> Embodiment:
        """Returns the body that a word is for.

        Raises:
            SimulationError: If the agent has none, or does not live yet.
        """
        if not self._converted:
            raise SimulationError(
                f"'{word}' is said to a body before the agent lives; say it while its Simulation runs: in `init`, `start`, a production"
            )
        embodiment = self._find_embodiment()
        if embodiment is None:
            raise SimulationError(f"port '{self._path}' leads to no body; a Simulation gives an agent one: minds={{body: agent}}")
        return embodiment

    def _find_embodiment(self) -> Embodiment | None:
        """Returns what joins its mind to a body; None for a mind without."""
        return next((part.__dict__["_embodiment"] for part in lineage(self) if "_embodiment" in part.__dict__), None)

    def _take(self, request: Request, answer: Any) -> None:
        """Takes the answer in, as an event of the mind, and wakes whoever waits for it."""
        reading = request.reading
        assert reading is not None
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, self._path, "answer", {"word": request.word, "value": plain_answer(answer)})
        reading._value = answer
        self._receive(request, answer)
        self.sch.finish(reading)

    def _receive(self, request: Request, answer: Any) -> None:
        """Does with an answer what this part does with it; for subclasses."""


class Searching(Port):
    """A module that looks for things, and whose searches are explained."""

    def _latest_searches(self) -> list[tuple[int, Mapping[str, Any], str]]:
        """Returns of the last top-down and the last bottom-up search when the view was taken in [us], what was in it, the outcome."""
        return []


def latest_searches(module: Searching) -> list[tuple[int, Mapping[str, Any], str]]:
    """Returns the last top-down and bottom-up search of a module: the time of its view [us], what was in it, and the outcome."""
    return module._latest_searches()


class BodyPort(Port):
    """Carries a mind's commands to its body, and the body's answers back.

    `set(word, …)` tells the body what to do; `get(word, …)` asks it for what it senses, `request(word, …)` likewise, with
    the answer as a chunk in a buffer. The body does what it is told at the end of the present tick, then moves, then
    answers; the answers are there when the next tick begins. `busy` is True while answers are outstanding; `error`
    after an answer to `request` that was nothing.

    `view` is the raw view: with it an agent steps outside what vision gives, and the trace says so (`outside_vision`). Where
    the agent has a `Vision`, that keeps the view private, unless it is made with `private_view=False`.

    Args:
        buffer: Where the answers to `request` go; None for a port without.
    """

    @named_parameters
    def __init__(self, buffer: Any = None) -> None:
        Model.__init__(self)
        self._buffer = buffer
        self._outstanding = 0
        self.busy = False
        self.error = False

    def set(self, word: str, *values: Any, **named: Any) -> None:
        """Tells the body to do something: `set("walk", 1.2)`.

        Raises:
            SimulationError: If the agent has no body, or does not live yet.
        """
        self._tell(word, *values, named=named)

    def get(self, word: str, *values: Any, **options: Any) -> Reading:
        """Asks the body what it senses: `reading = self.body.get("pose")`, then `yield reading`, then `reading.value`.

        Raises:
            SimulationError: If the agent has no body, does not live yet, or keeps the word private to one of its modules.
        """
        return self._ask("get", word, values, options)

    def request(self, word: str, *values: Any, **options: Any) -> Reading:
        """Asks the body what it senses; the answer comes as a chunk: the word, then what was sensed, by name or in order.

        Raises:
            SimulationError: If the agent has no body, does not live yet, or keeps the word private to one of its modules; or if
                the port has no buffer.
        """
        self._joined(word)
        if self._buffer is None:
            raise SimulationError(f"port '{self._path}' has no buffer to put the answer to '{word}' into; give it one: BodyPort(buffer)")
        return self._ask("request", word, values, options)

    def _ask(self, call: str, word: str, values: tuple[Any, ...], options: Mapping[str, Any]) -> Reading:
        embodiment = self._joined(word)
        outside = {}
        if word in RAW_VISION:
            self._check_private(word, embodiment)
            outside = {"outside_vision": True}
        self._trace_request(call, word=word, **_given(values, options), **outside)
        if call == "request":
            self.error = False
        reading = self._inquire(word, values, options, to_buffer=call == "request")
        self._outstanding += 1
        self.busy = True
        return reading

    def _check_private(self, word: str, embodiment: Embodiment) -> None:
        """Refuses a word that another part of the agent keeps private."""
        agent = next(part for part in lineage(self) if part.__dict__.get("_embodiment") is embodiment)
        for part in subtree(agent):
            option = part._kept_private(word) if isinstance(part, Port) else None
            if option is not None:
                raise SimulationError(
                    f"port '{self._path}' cannot ask body '{embodiment.body}' for '{word}': agent '{path_of(agent)}' "
                    f"({type(agent).__name__}) keeps it private to its module '{path_of(part)}'; make that with {option} to let other "
                    "ports of the agent have it too"
                )

    def _receive(self, request: Request, answer: Any) -> None:
        """Puts an answer into the buffer, where that was asked."""
        self._outstanding -= 1
        if request.to_buffer:
            if answer is None:
                self._buffer.clear()
                self.error = True
            else:
                self._buffer.set(answer_slots(request.word, answer))
        if self._outstanding == 0:
            self.busy = False


def _given(values: tuple[Any, ...], named: Mapping[str, Any]) -> dict[str, Any]:
    """Returns what the trace tells of the values that a word is given."""
    return {**({"values": values} if values else {}), **({"named": named} if named else {})}


def place_of_caller() -> str:
    """Returns where the innermost running line that is not the library's stands."""
    frame = sys._getframe(2)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_LIBRARY):
        frame = frame.f_back
    return f"{frame.f_code.co_filename}:{frame.f_lineno}"
