"""Records a program that is run again when its user goes back: each item is written only once."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from typing import Any

from actr3d.recording import Recording
from actr3d.trace import TraceEvent


class RecordedOnce:
    """Passes items of one pass through a program to the recording, except those known from an earlier pass; the order is always the same.

    Args:
        recording: The recording with the items so far.
        left: Returns whether the program is being left: what it does then, as in `finally`, is not recorded.
    """

    def __init__(self, recording: Recording, left: Callable[[], bool]) -> None:
        self._recording = recording
        self._left = left
        self._events = self._states = self._answers = self._commands = 0
        self._held: list[Callable[[], object]] | None = None
        """Writes the items of a change that is being made; None otherwise."""

    @contextmanager
    def changing(self) -> Generator[None]:
        """Makes a change of a user in the block; if it succeeds, what an earlier pass has recorded after the present is removed.

        Raises:
            RecordingError: If the file can no longer be written.
        """
        recording, events, commands = self._recording, self._events, self._commands
        self._held = []
        try:
            yield
            if recording.events > events or recording.commands > commands:
                recording.cut(self._states - 1, events, self._answers, commands)
        except BaseException:
            self._held.clear()
            raise
        finally:
            held, self._held = self._held, None
            for write in held:
                write()

    def event(self, event: TraceEvent) -> None:
        """Records an event.

        Raises:
            RecordingError: If the file can no longer be written.
        """
        self._events += 1
        if self._held is not None:
            self._held.append(lambda: self._recording.event_alone(event))
        elif self._events > self._recording.events and not self._left():
            self._recording.event_alone(event)

    def state(self, run: int, tick: int, data: bytes) -> None:
        """Records the physics at the start of a run, or at the end of a tick.

        Raises:
            RecordingError: If the file can no longer be written.
        """
        self._states += 1
        if self._states > self._recording.states and not self._left():
            self._recording.state(run, tick, data)

    def answer(self, run: int, tick: int, body: str, word: str, value: Any) -> None:
        """Records a body's answer to a query."""
        self._answers += 1
        if self._answers > self._recording.answers and not self._left():
            self._recording.answer(run, tick, body, word, value)

    def command(self, run: int, tick: int, data: Mapping[str, Any]) -> None:
        """Records a command of a user."""
        self._commands += 1
        if self._held is not None:
            self._held.append(lambda: self._recording.command(run, tick, data))
        elif self._commands > self._recording.commands and not self._left():
            self._recording.command(run, tick, data)
