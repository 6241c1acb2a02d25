"""Serves until it is interrupted: the application, and the workers with it."""

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
"""No message on a websocket is longer [bytes]; pictures that viser's page sends are the largest."""
MOST_CONNECTIONS = 500
"""Who comes while so many are open is told to come again later."""
REQUEST_TIME = 10.0
"""So long a connection may be open, or have had its last answer, until all headers of a request have come [s]."""


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


class PunctualProtocol(H11Protocol):
    """Closes a connection on which no request comes, or only part of one: many of these would leave no room for others."""

    _late: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begins to wait for a request."""
        super().connection_made(transport)
        self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Waits no more."""
        super().connection_lost(exc)
        if self._late is not None:
            self._late.cancel()

    def on_response_complete(self) -> None:
        """Waits for the next request."""
        super().on_response_complete()
        self._wait()

    def _wait(self) -> None:
        if self._late is not None:
            self._late.cancel()
        self._late = self.loop.call_later(REQUEST_TIME, self._give_up, self.cycle)

    def _give_up(self, before: RequestResponseCycle | None) -> None:
        """Closes the connection where no request has begun since then; one that has become a websocket is none of ours."""
        under_way = self.cycle is not before or (before is not None and not before.response_complete)
        if not under_way and self.transport.get_protocol() is self:
            self.transport.close()


def config_of(app: Any) -> uvicorn.Config:
    """Returns how an application is served."""
    return uvicorn.Config(
        app,
        log_config=None,
        log_level="error",  # what is wrong with somebody's request is for who has sent it
        access_log=False,  # it would write the token down
        server_header=False,
        http=PunctualProtocol,
        ws="websockets-sansio",
        ws_max_size=LARGEST_MESSAGE,
        ws_per_message_deflate=False,
        limit_concurrency=MOST_CONNECTIONS,
        timeout_graceful_shutdown=2,
    )


def serve(app: Any, listening: socket.socket, started: Callable[[], None]) -> None:
    """Serves until the process is interrupted or terminated.

    Args:
        app: The application.
        listening: Where it listens.
        started: Is called once it answers.
    """
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    with suppress(KeyboardInterrupt):  # which is how users end it
        _Server(config_of(app), started, app.state.leave).run(sockets=[listening])
