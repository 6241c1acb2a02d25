"""A recording of a program that is run again where its user goes back: each thing is written once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from actr3d.recording import Recording
from actr3d.trace import TraceEvent


class RecordedOnce:
    """Hands on what one time through a program tells, unless it is known from an earlier time; the same things come in the same order.

    Args:
        recording: What has been told up to now.
        left: Tells whether the program is being left: what it does then, as in `finally`, is nothing that it does by itself.
    """

    def __init__(self, recording: Recording, left: Callable[[], bool]) -> None:
        self._recording = recording
        self._left = left
        self._events = self._states = self._answers = self._commands = 0

    def event(self, event: TraceEvent) -> None:
        """Takes an event.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self._events += 1
        if self._events > self._recording.events and not self._left():
            self._recording.event_alone(event)

    def state(self, run: int, tick: int, data: bytes) -> None:
        """Takes the physics at the start of a run, or at the end of a tick.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self._states += 1
        if self._states > self._recording.states and not self._left():
            self._recording.state(run, tick, data)

    def answer(self, run: int, tick: int, body: str, word: str, value: Any) -> None:
        """Takes what a body answered."""
        self._answers += 1
        if self._answers > self._recording.answers and not self._left():
            self._recording.answer(run, tick, body, word, value)

    def command(self, run: int, tick: int, data: Mapping[str, Any]) -> None:
        """Takes what a user did."""
        self._commands += 1
        if self._commands > self._recording.commands and not self._left():
            self._recording.command(run, tick, data)
