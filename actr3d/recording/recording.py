"""A recording that is being made."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from actr3d.actr.answers import plain_answer
from actr3d.errors import RecordingError
from actr3d.recording.form import FORM, versions
from actr3d.recording.writer import Cut, State, Writer
from actr3d.trace import TraceEvent


class Recording:
    """Writes one run to one file: facts about it, then every event, state, command and answer as they come.

    What has come is on the disk a quarter of a second later, also where the program is killed then. Events, commands and
    answers are counted; after `cut`, the counting goes on from what was kept.

    Args:
        path: The file; it must not exist.
        facts: What can be told of the run before it begins: the model's source, its parameters, the seed; plain values.

    Raises:
        RecordingError: If the file exists already, or cannot be made.
    """

    def __init__(self, path: Path | str, facts: Mapping[str, Any]) -> None:
        told = {"form": FORM, "versions": versions(), **facts}
        self._writer = Writer(Path(path), [(name, json.dumps(value)) for name, value in told.items()])
        self._put = self._writer.put
        self.events = self.commands = self.answers = self.states = 0
        """How many of each it has been given."""

    @property
    def _tick(self) -> int:
        """The last whole tick; the start, tick 0, has a state too."""
        return max(0, self.states - 1)

    def fact(self, name: str, value: Any) -> None:
        """Writes a fact that becomes known in the run.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self._put("facts", (name, json.dumps(value)))

    def event(self, event: TraceEvent) -> None:
        """Writes an event.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self.events += 1
        self._put("events", (self.events, self._tick, event.time_us, event.source, event.kind, event.to_json()))

    def answer(self, body: str, word: str, value: Any) -> None:
        """Writes what a body answered at the end of the tick that is about to end.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self.answers += 1
        self._put("answers", (self.answers, self._tick + 1, body, word, json.dumps(plain_answer(value))))

    def command(self, data: Mapping[str, Any]) -> None:
        """Writes what a user did after the last whole tick.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self.commands += 1
        self._put("commands", (self.commands, self._tick, json.dumps(data)))

    def state(self, data: bytes) -> None:
        """Writes the physics at the start, and then at the end of each tick; the tick is over then.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self._put("states", State(self.states, data))
        self.states += 1

    def cut(self, tick: int, events: int, commands: int, answers: int) -> None:
        """Drops what came after a tick, and all but the first few events, commands and answers: the run goes another way.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self.states, self.events, self.commands, self.answers = tick + 1, events, commands, answers
        self._put("cut", Cut(tick, events, commands, answers))

    def close(self) -> None:
        """Writes what is left, and closes the file.

        Raises:
            RecordingError: If the file cannot be written.
        """
        self._writer.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        if error is None:
            self.close()
        else:
            with suppress(RecordingError):  # what went wrong first is what is told
                self.close()
