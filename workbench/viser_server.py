"""Viser's server: on loopback, for nobody but the bridge, and without a way out."""

from __future__ import annotations

import asyncio
import json
import secrets
from itertools import count
from typing import Any

import numpy as np

BRIDGE_HEADER = "x-workbench-bridge"
"""With it the bridge says that it is the bridge: any page of the user's browser could find a port on loopback."""

SHADOWS_HEADER = "x-workbench-shadows"
"""With it the bridge says whether a browser is to be shown shadows: `on` or `off`."""


def start_viser(secret: str) -> Any:
    """Starts viser's server, which lets nobody in but who knows a secret, and opens no tunnel.

    Args:
        secret: What the bridge says.
    """
    import rich
    import viser
    from viser import _messages

    rich.get_console().quiet = True  # viser prints its own address, which is not for users
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    inner: Any = server._websock_server

    async def check(client: Any) -> None:
        if not secrets.compare_digest(header_of(server, client, BRIDGE_HEADER), secret):
            connection = inner._live_connections.get(client.client_id)
            inner._live_connections.pop(client.client_id, None)
            inner._client_state_from_id.pop(client.client_id, None)
            if connection is not None:
                await connection.close(1008, "only the workbench's bridge may connect")
            raise asyncio.CancelledError  # which ends this connection's task, and nothing else

    inner._client_connect_cb.insert(0, check)
    # Any browser could ask for a tunnel that opens this server to the world.
    inner.unregister_handler(_messages.ShareUrlRequest)
    inner.unregister_handler(_messages.ShareUrlDisconnect)
    inner.disconnect_all_clients()
    server.scene.set_up_direction("+z")
    return server


def tell(server: Any, name: str, value: Any) -> None:
    """Tells every browser something of the scene that viser has no message for: it calls `scene.tell(name, value)` there.

    It arrives with what is drawn in the same `server.atomic()`; a browser that comes later, or is slow, gets the newest of each name.
    """
    from viser import _messages

    message = _messages.RunJavascriptMessage(f"scene.tell({json.dumps(name)},{json.dumps(value, allow_nan=False)})")
    # Viser keeps every message of this type for browsers that come later, for they may differ; these replace each other.
    message.redundancy_key = lambda: f"scene {name}"
    server._websock_server.queue_message(message)


class Moments:
    """Numbers what is shown, so that each browser knows which moment its shapes are of.

    A browser moves shapes a picture or more after their places have arrived, all at once. The number is the place of one more shape,
    which nobody sees, and so is known just when the others have moved.

    Args:
        server: Viser's server.
    """

    def __init__(self, server: Any) -> None:
        self._server = server
        self._numbers = count(1)
        self._handle: Any = None

    def begin(self) -> None:
        """Adds the shape to a scene that was reset."""
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
        """Returns the number of what is shown from now on; to be sent with it in one `server.atomic()`."""
        number = next(self._numbers)
        self._handle.batched_positions = np.array([[number, 0.0, 0.0]])
        return number


def header_of(server: Any, client: Any, name: str) -> str:
    """Returns what a header said with which a client has connected; an empty text where it is gone, or said nothing."""
    connection = server._websock_server._live_connections.get(client.client_id)
    return connection.request.headers.get(name, "") if connection is not None else ""
