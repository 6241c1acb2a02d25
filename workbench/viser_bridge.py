"""Connects browsers to viser: its page and its websocket are served on the workbench's port, behind its login."""

from __future__ import annotations

import asyncio
import contextlib
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from workbench.scene_view import SceneView

POLICY = (
    "default-src 'none'; script-src 'self' 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob:; worker-src 'self' blob:; "
    "connect-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; "
    "frame-ancestors 'self'"
)
"""What viser's page may load: without this policy, a server address in the page's URL could give another server control of it."""
MAX_VIEWS = 32
"""Maximum number of open 3D views."""


ADDED = (
    '<script src="/static/viser_shim.js"></script><script type="module" src="/static/scene/view.js"></script>'
    '<link rel="stylesheet" href="/static/scene/view.css">'
)
"""HTML that is inserted into viser's page."""


@cache
def page() -> str:
    """Returns viser's page, which understands `?panel=hidden` and `?darkMode`."""
    spec = find_spec("viser")
    assert spec is not None
    assert spec.origin is not None
    text = (Path(spec.origin).parent / "client" / "build" / "index.html").read_text(encoding="utf-8")
    return text.replace("<head>", f"<head>{ADDED}", 1)


class Bridge:
    """Forwards websocket messages between browsers and viser's server."""

    def __init__(self) -> None:
        self._open = 0

    async def carry(self, browser: WebSocket, view: SceneView | None) -> None:
        """Forwards messages of one websocket until one side disconnects.

        Args:
            browser: The browser's websocket, not yet accepted. With `?shadows=off` it gets no shadows.
            view: The 3D view that it requests; None if there is none.
        """
        if view is None or view.over or self._open >= MAX_VIEWS:
            await browser.close(1008)
            return
        self._open += 1
        try:
            if await view.wait():
                await self._carry(browser, view)
            else:
                await browser.close(1008)
        finally:
            self._open -= 1

    async def _carry(self, browser: WebSocket, view: SceneView) -> None:
        import websockets
        from websockets.typing import Subprotocol

        port, headers = view.address(shadows=browser.query_params.get("shadows") != "off")
        offered = [Subprotocol(name) for name in browser.scope.get("subprotocols", [])]
        try:
            # Only these headers are forwarded: neither the workbench's cookie nor its token.
            upstream = await websockets.connect(
                f"ws://127.0.0.1:{port}",
                subprotocols=offered or None,
                additional_headers=headers,
                max_size=None,
                compression=None,
                proxy=None,
            )
        except (OSError, websockets.WebSocketException):
            await browser.close(1011)
            return
        async with upstream:
            await browser.accept(subprotocol=upstream.subprotocol)
            ways = [asyncio.create_task(_up(browser, upstream)), asyncio.create_task(_down(browser, upstream))]
            try:
                await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
            finally:
                for way in ways:
                    way.cancel()
                await asyncio.gather(*ways, return_exceptions=True)
        with contextlib.suppress(RuntimeError, WebSocketDisconnect):
            await browser.close()


async def _up(browser: WebSocket, upstream: Any) -> None:
    while True:
        message = await browser.receive()
        if message["type"] == "websocket.disconnect":
            return
        data = message.get("bytes")
        await upstream.send(message.get("text") if data is None else data)


async def _down(browser: WebSocket, upstream: Any) -> None:
    async for data in upstream:
        await (browser.send_text(data) if isinstance(data, str) else browser.send_bytes(data))
