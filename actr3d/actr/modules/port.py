"""The port: an agent's connection to its body; it sends commands, and requests readings of sensors."""

from __future__ import annotations

import sys
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from actr3d.actr.kernel.events import Event
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.parameters import named_parameters
from actr3d.actr.kernel.scheduler import Scheduler
from actr3d.actr.kernel.tree import lineage, path_of, subtree
from actr3d.actr.modules.answers import answer_slots, plain_answer
from actr3d.errors import SimulationError
from actr3d.warnings import is_library, locate

RAW_VISION = ("view", "image", "depth")
"""Raw sensors of the eye. Only a vision module should read them; any other part of an agent that reads them bypasses vision."""


class Reading(Event):
    """An answer that the body will give: `yield reading` waits for it, then `reading.value` is the answer."""

    __slots__ = ("_value", "word")

    def __init__(self, word: str) -> None:
        super().__init__(Reading)
        self.word = word

    @property
    def value(self) -> Any:
        """The body's answer.

        Raises:
            SimulationError: If it has not answered yet.
        """
        if not self.done:
            raise SimulationError(f"the body has not answered '{self.word}' yet; wait for it: yield reading")
        return self._value

    def take(self, answer: Any) -> None:
        """Stores the body's answer."""
        self._value = answer

    def describe(self) -> str:
        """Returns the name of the request."""
        return f"reading of '{self.word}'"


class CallSite(NamedTuple):
    """The line of the modeller that makes a request, for errors that occur later."""

    file: str
    line: int
    production: str | None
    """The production whose body is running; None if there is none."""

    def describe(self) -> str:
        """Returns the place as text."""
        place = f"{self.file}:{self.line}"
        return place if self.production is None else f"production '{self.production}' ({place})"


@dataclass(slots=True)
class Request:
    """A command or question of an agent to its body, until the body's next tock."""

    body: str
    """The body's name."""
    word: str
    values: tuple[Any, ...]
    named: Mapping[str, Any]
    site: CallSite | None
    """Where the modeller's code makes the request; None if a module makes it by itself."""
    port: Port
    reading: Reading | None = None
    """Receives the answer; None for a command, which has no answer."""
    to_buffer: bool = False
    """Whether the answer goes into the port's buffer."""


class Embodiment:
    """Connects an agent to its body, by the body's name and a list of requests, which the body answers at the end of each tick.

    Args:
        body: The body's name.
        outbox: The requests that wait for the next tock, in order; all agents of a simulation share it.
        tick: Length of a tick [us].
    """

    __slots__ = ("body", "outbox", "tick")

    def __init__(self, body: str, outbox: list[Request], tick: int) -> None:
        self.body = body
        self.outbox = outbox
        self.tick = tick

    def join(self, agent: Model) -> None:
        """Connects an agent, and all ports below it, to this body."""
        agent.__dict__["_embodiment"] = self


class Port(Model):
    """A part of an agent that sends requests to the body and receives its answers."""

    def _send_command(self, command: str, *values: Any, named: Mapping[str, Any] | None = None, site: CallSite | None = None) -> None:
        """Sends a command to the body, on behalf of the modeller's line at `site`, or of the one that is running."""
        named = {} if named is None else named
        embodiment = self._joined(command)
        self._trace_request("set", word=command, **_given(values, named))
        embodiment.outbox.append(Request(embodiment.body, command, values, named, site or self._call_site(), self))

    def _inquire(
        self, sensor: str, values: tuple[Any, ...] = (), options: Mapping[str, Any] | None = None, *, by_itself: bool = False, **how: bool
    ) -> Reading:
        """Asks the body for what it senses; `by_itself` if no line of the modeller's is running."""
        embodiment = self._joined(sensor)
        reading = Reading(sensor)
        site = None if by_itself else self._call_site()
        embodiment.outbox.append(Request(embodiment.body, sensor, values, options or {}, site, self, reading, **how))
        return reading

    def _call_site(self) -> CallSite | None:
        """Returns the innermost running line outside the library; None if an event of the library's own is running."""
        frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage] # Python documents it
        while is_library(frame.f_code.co_filename):
            if frame.f_code is Scheduler.EVENT_LOOP or frame.f_back is None:
                return None
            frame = frame.f_back
        firing = self.sch.firing
        return CallSite(frame.f_code.co_filename, frame.f_lineno, None if firing is None else firing.name)

    def _kept_private(self, sensor: str) -> str | None:
        """Returns the option that permits other parts to read a sensor that this part keeps private; None if it is not private."""
        return None

    def _joined(self, name: str) -> Embodiment:
        """Returns the connection to the body.

        Raises:
            SimulationError: If the agent has none, or is not converted yet.
        """
        if not self._converted:
            raise SimulationError(
                f"'{name}' is sent to a body before the agent runs; send it while its Simulation runs: in `init`, `start`, a production"
            )
        embodiment = self._find_embodiment()
        if embodiment is None:
            raise SimulationError(f"port '{self._path}' has no body; a Simulation gives an agent one: agents={{body: agent}}")
        return embodiment

    def _find_embodiment(self) -> Embodiment | None:
        """Returns the connection of the agent to a body; None for an agent without one."""
        known = self.__dict__.get("_known_embodiment")  # it lasts as long as the port's place in the tree
        if known is None:
            found = (part.__dict__["_embodiment"] for part in lineage(self) if "_embodiment" in part.__dict__)
            known = self.__dict__["_known_embodiment"] = next(found, None)
        return known

    def _take(self, request: Request, answer: Any) -> None:
        """Receives an answer as an event of the agent, and wakes the generators that wait for it."""
        reading = request.reading
        assert reading is not None
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, self._path, "answer", {"word": request.word, "value": plain_answer(answer)})
        reading.take(answer)
        self._receive(request, answer)
        self.sch.finish(reading)

    def _receive(self, request: Request, answer: Any) -> None:
        """Processes an answer; for subclasses."""


class Searching(Port):
    """A module that searches for things, and whose searches can be explained.

    It puts what it finds into its buffer; the slot `feature` of the chunk names the kind of thing.
    """

    _buffer: Any

    def _kinds(self) -> Mapping[str, Collection[str]]:
        """Returns the kinds of things that it can find, with the slots that their chunks can have besides `feature`."""
        return {}

    def _latest_searches(self) -> list[tuple[int, Mapping[str, Any], str]]:
        """Returns the last top-down and bottom-up search: the time of the view [us], what was in it, and the outcome."""
        return []


def latest_searches(module: Searching) -> list[tuple[int, Mapping[str, Any], str]]:
    """Returns the last top-down and bottom-up search of a module: the time of its view [us], what was in it, and the outcome."""
    return module._latest_searches()  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def kinds_put_into(buffer: object, module: Searching) -> Mapping[str, Collection[str]]:
    """Returns the kinds of things that a module can put into a buffer, with their slots; none if its buffer is another."""
    if module._buffer is not buffer:  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model
        return {}
    return module._kinds()  # pyright: ignore[reportPrivateUsage] # the same


class BodyPort(Port):
    """Sends an agent's commands to its body, and receives the body's answers.

    `set(word, …)` sends a command; `get(word, …)` asks for what the body senses, and so does `request(word, …)`, with the answer
    as a chunk in a buffer. The body executes commands at the end of the current tick, then moves, then answers; the answers
    are available when the next tick begins. `busy` is True while answers are outstanding, and `error` after an empty answer to
    `request`.

    `view` is the raw view, `image` and `depth` are pictures: an agent that asks for one of them bypasses vision, which the trace
    records (`outside_vision`). If the agent has a `Vision`, that keeps them private, unless it is made with `private_view=False`.

    Args:
        buffer: The buffer for the answers to `request`; None for a port without `request`.
    """

    @named_parameters
    def __init__(self, buffer: Any = None) -> None:
        self._buffer = buffer
        self._outstanding = 0
        self.busy = False
        self.error = False

    def set(self, word: str, *values: Any, **named: Any) -> None:
        """Sends a command to the body: `set("walk", 1.2)`.

        Raises:
            SimulationError: If the agent has no body, or is not converted yet.
        """
        self._send_command(word, *values, named=named)

    def get(self, word: str, *values: Any, **options: Any) -> Reading:
        """Asks the body for what it senses: `reading = self.body.get("pose")`, then `yield reading`, then `reading.value`.

        Raises:
            SimulationError: If the agent has no body, is not converted yet, or keeps the sensor private to one of its modules.
        """
        return self._ask("get", word, values, options)

    def request(self, word: str, *values: Any, **options: Any) -> Reading:
        """Asks the body for what it senses; the answer is a chunk: the sensor's name, then the sensed values, by name or in order.

        Raises:
            SimulationError: If the agent has no body, is not converted yet, or keeps the sensor private to one of its modules; or
                if the port has no buffer.
        """
        self._joined(word)
        if self._buffer is None:
            raise SimulationError(f"port '{self._path}' has no buffer to put the answer to '{word}' into; give it one: BodyPort(buffer)")
        return self._ask("request", word, values, options)

    def _ask(self, call: str, sensor: str, values: tuple[Any, ...], options: Mapping[str, Any]) -> Reading:
        embodiment = self._joined(sensor)
        outside = {}
        if sensor in RAW_VISION:
            self._check_private(sensor, embodiment)
            outside = {"outside_vision": True}
        self._trace_request(call, word=sensor, **_given(values, options), **outside)
        if call == "request":
            self.error = False
        reading = self._inquire(sensor, values, options, to_buffer=call == "request")
        self._outstanding += 1
        self.busy = True
        return reading

    def _check_private(self, sensor: str, embodiment: Embodiment) -> None:
        """Raises an error for a sensor that another part of the agent keeps private."""
        agent = next(part for part in lineage(self) if part.__dict__.get("_embodiment") is embodiment)
        for part in subtree(agent):
            option = part._kept_private(sensor) if isinstance(part, Port) else None  # of this class, and extended by subclasses
            if option is not None:
                raise SimulationError(
                    f"port '{self._path}' cannot ask body '{embodiment.body}' for '{sensor}': agent '{path_of(agent)}' "
                    f"({type(agent).__name__}) keeps it private to its module '{path_of(part)}'; make that with {option} to let other "
                    "ports of the agent have it too"
                )

    def _receive(self, request: Request, answer: Any) -> None:
        """Puts an answer into the buffer, if it was a `request`."""
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
    """Returns the arguments of a command or a sensor as the trace records them."""
    return {**({"values": values} if values else {}), **({"named": named} if named else {})}


def note_request(error: Exception, port: Port, site: CallSite | None) -> None:
    """Adds to an error which part of an agent made the request that caused it, and where.

    That is also the location of an error of the library, unless a line of the modeller's led to it, as in a detector.
    """
    where = ""
    if site is not None:
        where = f" in {site.describe()}"
        locate(error, site.file, site.line)
    error.add_note(f"  requested by '{path_of(port)}'{where}")
