"""Tracks the commands and questions that were sent to workers, until their replies arrive."""

from __future__ import annotations

import asyncio
import pickle
from typing import Any

from actr3d.errors import SimulationError
from workbench.worker.messages import CommandMessage, Reply
from workbench.worker.workers import Worker

MAX_WAITING = 200
"""Maximum number of commands and questions of one session that wait for replies."""


class PendingRequests:
    """Sends commands and questions to workers, and delivers each reply to the caller that waits for it."""

    def __init__(self) -> None:
        self._number = 0
        self._waiting: dict[int, tuple[Worker, asyncio.Future[Reply]]] = {}

    async def ask(self, worker: Worker | None, said: Any) -> Reply:
        """Sends a worker a page command, and returns its reply.

        Raises:
            SimulationError: If there is no worker, or too many requests wait already.
        """
        if worker is None:
            raise SimulationError("there is no run; start one")
        if len(self._waiting) >= MAX_WAITING:
            raise SimulationError("too many requests are waiting for a reply; is the model busy?")
        self._number += 1  # starts at 1: number 0 means that nobody waits for the reply
        reply: asyncio.Future[Reply] = asyncio.get_running_loop().create_future()
        self._waiting[self._number] = worker, reply
        self.send(worker, said, self._number)
        return await reply

    def send(self, worker: Worker, said: Any, number: int = 0) -> None:
        """Sends a worker a command; without a number, nobody waits for the reply."""
        worker.send(CommandMessage(id=number, command=pickle.dumps(said)))

    def take(self, reply: Reply) -> None:
        """Delivers a reply to its caller."""
        _, waiting = self._waiting.pop(reply.id, (None, None))
        if waiting is not None and not waiting.done():
            waiting.set_result(reply)

    def end(self, worker: Worker) -> None:
        """Answers all requests that wait for a worker with an error, as it has ended."""
        for number in [number for number, (asked, _) in self._waiting.items() if asked is worker]:
            self.take(Reply(id=number, error="the run has ended"))

    def on(self, worker: Worker) -> bool:
        """Returns whether anyone waits for a reply of a worker."""
        return any(asked is worker for asked, _ in self._waiting.values())
