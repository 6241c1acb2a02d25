"""Sends a file that is already open, complete even if it is renamed or deleted meanwhile."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from io import FileIO
from typing import Any

from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from workbench.disconnects import DisconnectedError, while_connected

PART = 256 * 1024
"""How much is read and sent at a time [bytes]."""


def of_kinds(media_types: Iterable[str]) -> dict[str, Any]:
    """Returns the arguments of a route that describe responses which are files of some media types."""
    return {"response_class": Response, "responses": {200: {"content": {kind.partition(";")[0]: {} for kind in media_types}}}}


class OpenFile(Response):
    """Responds with the content of an open file, and closes the file at the end or when the client has disconnected.

    Args:
        file: The open file.
        media_type: Its media type.
        name: The file name of a download; None if the response is not a download.
    """

    def __init__(self, file: FileIO, media_type: str, name: str | None = None) -> None:
        self._file = file
        self._size = os.fstat(file.fileno()).st_size
        self.status_code = 200
        self.media_type = media_type
        self.background = None
        headers: Mapping[str, str] = {} if name is None else {"content-disposition": f'attachment; filename="{name}"'}
        self.init_headers({"content-length": str(self._size), **headers})

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Sends the response."""
        try:
            with suppress(DisconnectedError):
                await while_connected(self._send(send), receive)
        finally:
            self._file.close()

    async def _send(self, send: Send) -> None:
        await send({"type": "http.response.start", "status": self.status_code, "headers": self.raw_headers})
        left = self._size
        while left:
            # The read must finish even if the task is cancelled: the file must not be closed during it.
            reading = asyncio.ensure_future(asyncio.to_thread(self._file.read, min(PART, left)))
            try:
                part = await asyncio.shield(reading)
            except asyncio.CancelledError:
                await asyncio.wait([reading])
                raise
            if not part:
                return  # the file was truncated; the client sees a response shorter than announced
            left -= len(part)
            await send({"type": "http.response.body", "body": part, "more_body": True})
        await send({"type": "http.response.body", "body": b"", "more_body": False})
