"""Serves until it is interrupted: the application, and the workers with it."""

from __future__ import annotations

import logging
import socket
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import uvicorn

LARGEST_MESSAGE = 60_000_000
"""No message on a websocket is longer [bytes]; pictures that viser's page sends are the largest."""


class _Server(uvicorn.Server):
    """Tells when it has started; ends what runs before it waits for browsers to leave."""

    def __init__(self, config: uvicorn.Config, started: Callable[[], None], leave: Callable[[], Any]) -> None:
        super().__init__(config)
        self._begun = started
        self._leave = leave

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Starts, and tells so."""
        await super().startup(sockets)
        self._begun()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Ends."""
        await self._leave()
        logging.getLogger("uvicorn.error").setLevel(logging.CRITICAL)  # that requests are broken off now is no error
        await super().shutdown(sockets)


def serve(app: Any, listening: socket.socket, started: Callable[[], None]) -> None:
    """Serves until the process is interrupted or terminated.

    Args:
        app: The application.
        listening: Where it listens.
        started: Is called once it answers.
    """
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    config = uvicorn.Config(
        app,
        log_config=None,
        log_level="warning",
        access_log=False,  # it would write the token down
        server_header=False,
        ws="websockets-sansio",
        ws_max_size=LARGEST_MESSAGE,
        ws_per_message_deflate=False,
        limit_concurrency=500,
        timeout_graceful_shutdown=2,
    )

    with suppress(KeyboardInterrupt):  # which is how users end it
        _Server(config, started, app.state.leave).run(sockets=[listening])
