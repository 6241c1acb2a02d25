"""What other threads ask a simulation to do."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future


class Submissions:
    """Takes commands from any thread, and carries them out in the simulation's own."""

    def __init__(self) -> None:
        self._waiting: deque[tuple[Future[None], Callable[[], None]]] = deque()

    def __bool__(self) -> bool:
        return bool(self._waiting)

    def add(self, command: Callable[[], None]) -> Future[None]:
        """Takes a command; returns what tells when it is done, or raises what went wrong with it."""
        future: Future[None] = Future()
        self._waiting.append((future, command))
        return future

    def carry_out(self) -> None:
        """Carries out what has come."""
        while self._waiting:
            future, command = self._waiting.popleft()
            if not future.set_running_or_notify_cancel():
                continue
            try:
                command()
            except Exception as error:  # noqa: BLE001 - it is told to who asked
                future.set_exception(error)
            else:
                future.set_result(None)
