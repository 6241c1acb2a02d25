"""What workers have been told on behalf of users, and what comes of it."""

from __future__ import annotations

import asyncio
from typing import Any

from actr3d.errors import SimulationError
from workbench.worker.messages import Do, Reply
from workbench.worker.workers import Worker

MOST = 200
"""So many commands and questions of one session may wait for their answers."""


class Waiting:
    """Tells workers commands and questions, and knows who waits for which answer."""

    def __init__(self) -> None:
        self._number = 0
        self._waiting: dict[int, tuple[Worker, asyncio.Future[Reply]]] = {}

    async def ask(self, worker: Worker | None, said: Any) -> Reply:
        """Tells a worker a command or a question of `protocol`; returns what comes of it.

        Raises:
            SimulationError: If there is no worker, or too much waits already.
        """
        if worker is None:
            raise SimulationError("there is no run: begin one")
        if len(self._waiting) >= MOST:
            raise SimulationError("too much waits for its answer already; is the model busy?")
        self._number += 1  # from 1: nobody waits for 0
        reply: asyncio.Future[Reply] = asyncio.get_running_loop().create_future()
        self._waiting[self._number] = worker, reply
        self.tell(worker, said, self._number)
        return await reply

    def tell(self, worker: Worker, said: Any, number: int = 0) -> None:
        """Tells a worker a command; nobody waits for what comes of it, unless it has a number."""
        worker.send(Do(id=number, say=said.model_dump_json().encode()))

    def take(self, reply: Reply) -> None:
        """Takes an answer."""
        _, waiting = self._waiting.pop(reply.id, (None, None))
        if waiting is not None and not waiting.done():
            waiting.set_result(reply)

    def end(self, worker: Worker) -> None:
        """Lets those know who wait for an answer of a worker that it has ended."""
        for number in [number for number, (asked, _) in self._waiting.items() if asked is worker]:
            self.take(Reply(id=number, error="the run has ended"))

    def on(self, worker: Worker) -> bool:
        """Tells whether anyone waits for an answer of a worker."""
        return any(asked is worker for asked, _ in self._waiting.values())
