"""A recording that is being written."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any, Self, cast

from actr3d.actr.kernel.run_limits import Contacts
from actr3d.clock import MICROSECONDS
from actr3d.errors import RecordingError
from actr3d.forks import detach_in_copies
from actr3d.recording.facts import LEFT, SAME_AS, check_fact, is_of_simulation
from actr3d.recording.schema import FORMAT, versions
from actr3d.recording.writer import Answer, CommandRow, NoWriter, State, Writer
from actr3d.trace import TraceEvent

USUAL_PERIOD = 10_000
"""The assumed length of a tick if the facts do not give it [us]: for a program, whose simulations may have different ticks."""
MAX_WAITING = 100_000
"""The maximum number of events that wait to be written; beyond it, the run waits for the disk."""

_OF_OTHERS: list[object] = []
"""The writers of other processes, in a forked copy: they are kept, because closing their files would disturb the others."""


class Recording:
    """Writes one run, or one program with all its runs, to one file: facts, then every event, state, command and answer as they occur.

    Everything is written within a quarter of a second, and the run waits for this after each second of simulated time; what is
    written survives if the program is killed. All items are counted; after `cut`, counting continues from what was kept.

    Args:
        path: The file; it must not exist.
        facts: What is known about the run before it begins: the model's source, its parameters, the seed. Plain values: numbers
            (also infinite ones and nan), texts, True, False, None, and lists and dicts of these; the keys of dicts are texts, and
            tuples are recorded as lists.

    Raises:
        RecordingError: If the file exists already, or cannot be created, or a fact is not plain.
    """

    def __init__(self, path: Path | str, facts: Mapping[str, Any]) -> None:
        all_facts: dict[str, Any] = {"form": FORMAT, "versions": versions(), **facts}
        self._writer: Writer | NoWriter = Writer(Path(path), [(name, _plain(name, value)) for name, value in all_facts.items()])
        self._append = self._writer.events.append
        self._time = 0
        """The simulated time of the latest item [us]; each run of a program begins at 0."""
        self._unwritten = 0
        """The simulated time that has passed, in all runs, since everything was written [us]."""
        self._period = all_facts.get("period_us", USUAL_PERIOD)
        detach_in_copies(self)
        self.events = self.answers = self.commands = self.states = 0
        """The number of items of each sort that it has received."""
        self._scenes: dict[bytes, str] = {}
        """By its checksum, the fact of a program's simulation that has been written whole; later ones of the same scene refer to it."""
        self._over = {"ended": False, "failed": False}
        """Whether each of these facts has been written, and holds."""
        self.may_fail = False
        """Whether the run goes on if the file cannot be written: it still repeats another recording, so nobody needs this one."""
        self.ending: Callable[[], None] | None = None
        """Called before the recording is closed, to add the last items; items added later are not recorded."""

    def fact(self, name: str, value: Any) -> None:
        """Writes a fact that becomes known during the run: plain values.

        Raises:
            RecordingError: If the values are not plain.
        """
        text = _plain(name, value)
        if is_of_simulation(name) and value is None:
            self._scenes = {checksum: one for checksum, one in self._scenes.items() if one != name}
        elif is_of_simulation(name):
            first = self._scenes.setdefault(sha256(text.encode()).digest(), name)
            text = text if first == name else json.dumps({SAME_AS: first})
        self._writer.facts.append((name, text))
        if name in self._over:
            self._over[name] = value is not None

    def leave(self) -> None:
        """Records that the user left the run at its current time, unless it was over or had failed."""
        if not any(self._over.values()):
            self.fact("ended", {"by": LEFT})

    def event(self, event: TraceEvent) -> None:
        """Writes an event."""
        self.events += 1
        self._append(event)
        if event.time_us != self._time:
            self._pass(event.time_us)

    def _pass(self, time: int) -> None:
        """Notes the time of an item [us]; writes everything after each second of simulated time."""
        self._unwritten += max(0, time - self._time)
        self._time = time
        if self._unwritten >= MICROSECONDS:
            self._unwritten = 0
            self._writer.flush()

    def detach(self) -> None:
        """Records nothing from now on: this is a forked copy of the process, and the run is recorded in the other."""
        _OF_OTHERS.append(self._writer)
        self._drop()

    @property
    def failure(self) -> RecordingError | None:
        """Why the file can no longer be written; None if it can."""
        return self._writer.failure

    def stop(self) -> None:
        """Records nothing from now on, while the run goes on; the file keeps what was written."""
        writer = self._writer
        self._drop()
        with suppress(RecordingError):
            writer.close()

    def _drop(self) -> None:
        self.ending = None
        self._writer = NoWriter()
        self._append = self._writer.events.append

    def event_alone(self, event: TraceEvent) -> None:
        """Writes an event of a program that may record nothing but events.

        Raises:
            RecordingError: If the file can no longer be written.
        """
        self.event(event)
        self.check()

    def answer(self, run: int, tick: int, body: str, word: str, value: Any) -> None:
        """Writes a body's answer at the end of the current tick; the value must not change afterwards."""
        self.answers += 1
        self._writer.answers.append(Answer(run, tick, body, word, value))

    def command(self, run: int, tick: int, data: Mapping[str, Any]) -> None:
        """Writes a user's command that was given after a tick."""
        self.commands += 1
        self._writer.commands.append(CommandRow(run, tick, json.dumps(data)))

    def state(self, run: int, tick: int, data: bytes, contacts: Contacts) -> None:
        """Writes the physics state of a run at its start, and then at the end of each tick; it must be the last item of the tick.

        Args:
            run: The number of the simulation.
            tick: The number of the tick; 0 for the start.
            data: The state.
            contacts: The contacts in that tick; they must not change afterwards.

        Raises:
            RecordingError: If the file can no longer be written.
        """
        self.states += 1
        writer = self._writer
        writer.states.append(State(run, tick, data, self.events, contacts))
        if tick * self._period != self._time:
            self._pass(tick * self._period)
        self.check()

    def check(self) -> None:
        """Waits for the disk if too many items are in memory.

        Raises:
            RecordingError: If the file can no longer be written.
        """
        writer = self._writer
        if len(writer.events) > MAX_WAITING or len(writer.states) > MAX_WAITING:
            writer.flush()
        if writer.failure is not None and not self.may_fail:
            raise writer.failure

    def flush(self) -> None:
        """Writes all items that it has received; does nothing if the file can no longer be written."""
        self._writer.flush()

    def cut(self, ticks: int, events: int, answers: int, commands: int) -> None:
        """Removes everything after a tick of the only run, and all but the first events, answers and commands: the run goes back.

        If the file can no longer be written, nothing is removed, and the next item raises the error: the change that sent the run
        another way is made by then.
        """
        self.states, self.events, self.answers, self.commands = ticks + 1, events, answers, commands
        self._writer.cut(ticks, events, answers, commands)

    def copy_to(self, path: Path | str, **facts: Any) -> None:
        """Writes everything recorded until now to a new file: a closed recording of a run that was left at this point.

        The run and this recording continue; nothing is shared with the copy. If the run was not over yet, the copy states
        that it ended by «left».

        Args:
            path: The new file; it must not exist.
            facts: Facts of the copy alone.

        Raises:
            RecordingError: If the file exists already or cannot be written (it is then removed), or if this recording
                could not be written before, or a fact cannot be recorded.
        """
        self._writer.copy_to(Path(path), [(name, _plain(name, value)) for name, value in facts.items()])

    def close(self) -> None:
        """Writes the remaining items, and closes the file.

        Raises:
            RecordingError: If the file cannot be written.
        """
        ending, self.ending = self.ending, None
        if ending is not None:
            ending()
        self._writer.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        if error is None:
            self.close()
        else:
            with suppress(RecordingError):  # the first error is the one to report
                self.close()


def _plain(name: str, value: Any) -> str:
    check_fact(name, value)
    try:
        text = json.dumps(value)
        _check_keys(value)
    except (TypeError, ValueError, RecursionError) as error:
        raise RecordingError(f"the fact '{name}' cannot be recorded, only numbers, texts, and lists and dicts of these: {error}") from None
    return text


def _check_keys(value: Any) -> None:
    """Checks that all keys of the dicts in a value are texts: JSON would make texts of others."""
    if isinstance(value, dict):
        for key, part in cast("dict[Any, Any]", value).items():
            if not isinstance(key, str):
                raise TypeError(f"the keys of a dict must be texts (got {key!r})")
            _check_keys(part)
    elif isinstance(value, (list, tuple)):
        for part in cast("list[Any]", value):
            _check_keys(part)
