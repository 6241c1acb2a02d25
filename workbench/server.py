"""Serves the application until the process is interrupted, and ends the workers with it."""

from __future__ import annotations

import asyncio
import logging
import socket
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol, RequestResponseCycle

LARGEST_MESSAGE = 60_000_000
"""Maximum size of a websocket message [bytes]; pictures that viser's page sends are the largest."""
MAX_CONNECTIONS = 500
"""Maximum number of open connections; further clients are asked to come again later (status 503)."""
REQUEST_TIME = 10.0
"""A connection is closed if a complete request header does not arrive within this time after its opening or last response [s]."""


class _Server(uvicorn.Server):
    """Calls a function when it has started, and ends all runs before it waits for browsers to disconnect."""

    def __init__(self, config: uvicorn.Config, started: Callable[[], None], leave: Callable[[], Any]) -> None:
        super().__init__(config)
        self._begun = started
        self._leave = leave

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Starts the server, and reports it."""
        await super().startup(sockets)
        self._begun()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Ends all runs, then the server."""
        await self._leave()
        logging.getLogger("uvicorn.error").setLevel(logging.CRITICAL)  # requests that are aborted now are not errors
        await super().shutdown(sockets)


class PunctualProtocol(H11Protocol):
    """Closes a connection without a complete request: many of these would use up all connections."""

    _late: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Starts the timer for a request."""
        super().connection_made(transport)
        self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stops the timer."""
        super().connection_lost(exc)
        if self._late is not None:
            self._late.cancel()

    def on_response_complete(self) -> None:
        """Restarts the timer for the next request."""
        super().on_response_complete()
        self._wait()

    def _wait(self) -> None:
        if self._late is not None:
            self._late.cancel()
        self._late = self.loop.call_later(REQUEST_TIME, self._give_up, self.cycle)

    def _give_up(self, before: RequestResponseCycle | None) -> None:
        """Closes the connection if no request has begun since then; a connection that has become a websocket is left alone."""
        under_way = self.cycle is not before or (before is not None and not before.response_complete)
        if not under_way and self.transport.get_protocol() is self:
            self.transport.close()


def config_of(app: Any) -> uvicorn.Config:
    """Returns the uvicorn configuration of an application."""
    return uvicorn.Config(
        app,
        log_config=None,
        log_level="error",  # errors in a request are reported to its sender
        access_log=False,  # it would contain the token
        server_header=False,
        http=PunctualProtocol,
        ws="websockets-sansio",
        ws_max_size=LARGEST_MESSAGE,
        ws_per_message_deflate=False,
        limit_concurrency=MAX_CONNECTIONS,
        timeout_graceful_shutdown=2,
    )


def serve(app: Any, listening: socket.socket, started: Callable[[], None]) -> None:
    """Serves until the process is interrupted or terminated; calls `started` once it accepts requests."""
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    with suppress(KeyboardInterrupt):  # the usual way to end it
        _Server(config_of(app), started, app.state.leave).run(sockets=[listening])
