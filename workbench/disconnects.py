"""Work for a request that ends when the client of the request disconnects."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from typing import Any, TypeVar

from starlette.types import Receive

from actr3d.errors import Actr3dError

T = TypeVar("T")


class DisconnectedError(Actr3dError):
    """The client of a request has disconnected."""


async def while_connected(work: Coroutine[Any, Any, T], receive: Receive) -> T:
    """Returns the result of some work, which is cancelled when the client of a request disconnects.

    Raises:
        DisconnectedError: If the client has disconnected.
    """
    working, leaving = asyncio.create_task(work), asyncio.create_task(_disconnected(receive))
    try:
        await asyncio.wait([working, leaving], return_when=asyncio.FIRST_COMPLETED)
        if working.done():
            return working.result()
        raise DisconnectedError("nobody waits for it any more")
    finally:
        working.cancel()
        leaving.cancel()
        await asyncio.gather(working, leaving, return_exceptions=True)


async def _disconnected(receive: Receive) -> None:
    """Waits until the client of a request has disconnected."""
    while (await receive())["type"] != "http.disconnect":
        pass
