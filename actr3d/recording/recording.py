"""A recording that is being made."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from actr3d.clock import MICROSECONDS
from actr3d.errors import RecordingError
from actr3d.recording.facts import check_fact
from actr3d.recording.form import FORM, LEFT, versions
from actr3d.recording.writer import Answer, Command, State, Writer
from actr3d.trace import TraceEvent

USUAL_PERIOD = 10_000
"""How long a tick is where the recording does not say it [us]: that of a program, whose simulations may differ in it."""
MOST_WAITING = 100_000
"""So many events may wait to be written; then the run waits for the disk."""


class Recording:
    """Writes one run, or one program with all its runs, to one file: facts, then every event, state, command and answer as they come.

    It is written a quarter of a second later at the latest, and the run waits for that after each second of simulated time; what is
    written outlives a program that is killed. All are counted; after `cut`, the counting goes on from what was kept.

    Args:
        path: The file; it must not exist.
        facts: What can be told of the run before it begins: the model's source, its parameters, the seed; plain values.

    Raises:
        RecordingError: If the file exists already, or cannot be made, or a fact is not plain.
    """

    def __init__(self, path: Path | str, facts: Mapping[str, Any]) -> None:
        told: dict[str, Any] = {"form": FORM, "versions": versions(), **facts}
        self._writer = Writer(Path(path), [(name, _plain(name, value)) for name, value in told.items()])
        self._append = self._writer.events.append
        self._second = 0
        """The latest second of simulated time; the ones before are in the file."""
        self._ticks_a_second = max(1, MICROSECONDS // told.get("period_us", USUAL_PERIOD))
        self.events = self.answers = self.commands = self.states = 0
        """How many of each it has been given."""
        self._over = {"ended": False, "failed": False}
        """Whether these facts have been told, and hold."""
        self.ending: Callable[[], None] | None = None
        """Called before it is closed, to tell the rest; what is told later is not recorded."""

    def fact(self, name: str, value: Any) -> None:
        """Writes a fact that becomes known in the run: plain values.

        Raises:
            RecordingError: If they are not plain.
        """
        self._writer.facts.append((name, _plain(name, value)))
        if name in self._over:
            self._over[name] = value is not None

    def leave(self) -> None:
        """Writes that the user left the run where it is now, unless it was over, or had failed."""
        if not any(self._over.values()):
            self.fact("ended", {"by": LEFT})

    def event(self, event: TraceEvent) -> None:
        """Writes an event."""
        self.events += 1
        self._append(event)
        second = event.time_us // MICROSECONDS
        if second != self._second:
            self._second = second
            self._writer.flush()

    def event_alone(self, event: TraceEvent) -> None:
        """Writes an event of a program, which may tell of nothing else.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self.event(event)
        self.check()

    def answer(self, run: int, tick: int, body: str, word: str, value: Any) -> None:
        """Writes what a body answered at the end of a tick that is about to end; nobody may change it any more."""
        self.answers += 1
        self._writer.answers.append(Answer(run, tick, body, word, value))

    def command(self, run: int, tick: int, data: Mapping[str, Any]) -> None:
        """Writes what a user did after a tick."""
        self.commands += 1
        self._writer.commands.append(Command(run, tick, json.dumps(data)))

    def state(self, run: int, tick: int, data: bytes) -> None:
        """Writes the physics of a run at its start, and then at the end of each tick; the tick is over then.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self.states += 1
        writer = self._writer
        writer.states.append(State(run, tick, data, self.events))
        second = tick // self._ticks_a_second
        if second != self._second:
            self._second = second
            writer.flush()
        if len(writer.states) > MOST_WAITING or len(writer.events) > MOST_WAITING or writer.failure is not None:
            self.check()

    def check(self) -> None:
        """Waits where too much has come to be kept in memory.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        writer = self._writer
        if len(writer.events) > MOST_WAITING or len(writer.states) > MOST_WAITING:
            writer.flush()
        if writer.failure is not None:
            raise writer.failure

    def flush(self) -> None:
        """Writes what has come, now; nothing where the file cannot be written any more."""
        self._writer.flush()

    def cut(self, ticks: int, events: int, answers: int, commands: int) -> None:
        """Drops what came after a tick of the only run, and all but the first few events, answers and commands: it goes another way.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self.states, self.events, self.answers, self.commands = ticks + 1, events, answers, commands
        self._writer.cut(ticks, events, answers, commands)
        self.check()

    def copy_to(self, path: Path | str) -> None:
        """Writes all that was recorded so far to a new file: a closed recording of a run that was left at this point.

        The run and this recording go on; nothing is shared with the copy. Where the run was not over yet, the copy says
        that it ended by «left».

        Args:
            path: The new file; it must not exist.

        Raises:
            RecordingError: If the file exists already or cannot be written (nothing is left of it then), or if this recording
                could not be written before.
        """
        self._writer.copy_to(Path(path))

    def close(self) -> None:
        """Writes what is left, and closes the file.

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
            with suppress(RecordingError):  # what went wrong first is what is told
                self.close()


def _plain(name: str, value: Any) -> str:
    check_fact(name, value)
    try:
        return json.dumps(value)
    except (TypeError, ValueError, RecursionError) as error:
        raise RecordingError(f"the fact '{name}' cannot be recorded, only numbers, texts, and lists and dicts of these: {error}") from None
