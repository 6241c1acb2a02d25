"""Starts viser's server on loopback, where only the bridge can connect and no tunnel can be opened."""

from __future__ import annotations

import asyncio
import json
import secrets
from itertools import count
from typing import Any

import numpy as np

BRIDGE_HEADER = "x-workbench-bridge"
"""The header with which the bridge proves its identity: any web page in the user's browser could find a port on loopback."""

SHADOWS_HEADER = "x-workbench-shadows"
"""The header with which the bridge says whether a browser gets shadows: `on` or `off`."""


def start_viser(secret: str) -> Any:
    """Starts viser's server, which admits only clients that know the secret, and opens no tunnel."""
    import rich
    import viser
    from viser import _messages

    rich.get_console().quiet = True  # viser prints its own address, which users must not open
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    inner = _inner(server)

    async def check(client: Any) -> None:
        if not secrets.compare_digest(header_of(server, client, BRIDGE_HEADER), secret):
            connection = inner._live_connections.pop(client.client_id, None)
            inner._client_state_from_id.pop(client.client_id, None)
            if connection is not None:
                await connection.close(1008, "only the workbench's bridge may connect")
            raise asyncio.CancelledError  # ends only the task of this connection

    inner._client_connect_cb.insert(0, check)
    # Any browser could ask for a tunnel that exposes this server to the internet.
    inner.unregister_handler(_messages.ShareUrlRequest)
    inner.unregister_handler(_messages.ShareUrlDisconnect)
    inner.disconnect_all_clients()
    server.scene.set_up_direction("+z")
    return server


def send_scene_data(server: Any, name: str, value: Any) -> None:
    """Sends every browser scene data that viser has no message for: it calls `scene.receive(name, value)` there.

    The data arrives with what is drawn in the same `server.atomic()`; a late or slow browser gets only the newest value of each name.
    """
    from viser import _messages

    message = _messages.RunJavascriptMessage(f"scene.receive({json.dumps(name)},{json.dumps(value, allow_nan=False)})")
    # Viser keeps every message of this type for later browsers, as they may differ; with one key, newer ones replace older ones.
    message.redundancy_key = lambda: f"scene {name}"
    _inner(server).queue_message(message)


class Moments:
    """Numbers the states that are shown, so that each browser knows which state its shapes belong to.

    A browser moves all shapes at once, one or more frames after their poses have arrived. The number is the position of one more,
    invisible shape, so a browser knows it exactly when the other shapes have moved.
    """

    def __init__(self, server: Any) -> None:
        self._server = server
        self._numbers = count(1)
        self._handle: Any = None

    def begin(self) -> None:
        """Adds the invisible shape after the scene was reset."""
        self._handle = self._server.scene.add_batched_meshes_simple(
            "/moment",
            vertices=np.zeros((3, 3), dtype=np.float32),
            faces=np.array([[0, 1, 2]], dtype=np.uint32),
            batched_wxyzs=np.array([[1.0, 0.0, 0.0, 0.0]]),
            batched_positions=np.zeros((1, 3)),
            lod="off",
            cast_shadow=False,
            receive_shadow=False,
        )

    def next(self) -> int:
        """Returns the number of the next state; must be sent with that state in one `server.atomic()`."""
        number = next(self._numbers)
        self._handle.batched_positions = np.array([[number, 0.0, 0.0]])
        return number


def header_of(server: Any, client: Any, name: str) -> str:
    """Returns a header that a client sent when it connected; empty if the client is gone or did not send it."""
    connection = _inner(server)._live_connections.get(client.client_id)
    return connection.request.headers.get(name, "") if connection is not None else ""


def _inner(server: Any) -> Any:
    """Returns the websocket server inside viser's server. Viser has no other way to check clients, or to send them other messages."""
    return server._websock_server
