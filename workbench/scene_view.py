"""The 3D view of a session: a viser server on loopback, which is fed from the newest state of the run."""

from __future__ import annotations

import asyncio
import contextlib
import secrets
import threading
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel

from workbench import protocol as say
from workbench.compiled import loaded
from workbench.curves import INTEGRATION
from workbench.overlays import Overlay, make_overlays
from workbench.worker.messages import Facts, State

if TYPE_CHECKING:
    from workbench.session import Session

BRIDGE_HEADER = "x-workbench-bridge"
"""With it the bridge says that it is the bridge: any page of the user's browser could find a port on loopback."""
VIEWS = ("free", "follow", "eye", "top")


class SceneView:
    """Shows the world of a session's run, and has run, pause, step, the camera and the aperture in viser's own panel.

    Everything is drawn in a thread of its own, from a copy of the model; where states come faster than they can be drawn,
    the newest is drawn.

    Args:
        session: What is shown, and told what users do in the panel.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._loop = asyncio.get_running_loop()
        self._secret = secrets.token_urlsafe(32)
        self._lock = threading.Lock()
        self._changed = asyncio.Event()
        self._facts: Facts | None = None
        self._state: State | None = None
        self._server: Any = None
        self._scene: Any = None
        self._model: MjModel | None = None
        self._data: MjData | None = None
        self._overlays: dict[str, Overlay] = {}
        self._handles: dict[str, Any] = {}
        self._last_base: Any = None
        self._quiet = False
        """Whether the panel is being set to what is so, which is nothing that a user does."""
        self.ready = asyncio.Event()
        """Set once there is something to see."""
        self.over = False
        session.watchers.append(self._watch)
        self._task = asyncio.create_task(self._draw_on())

    # -- what the session tells

    def _watch(self, _: Session, what: Facts | State | None) -> None:
        if what is None:
            self._task.cancel()
            self.over = True
            if self._server is not None:
                threading.Thread(target=self._stop, daemon=True).start()
        elif isinstance(what, Facts):
            self._facts, self._state = what, None
        elif what.physics is not None:
            self._state = what
        self._changed.set()

    async def _draw_on(self) -> None:
        """Draws the newest, as often as there is something new."""
        while True:
            await self._changed.wait()
            self._changed.clear()
            facts, self._facts = self._facts, None
            if facts is not None:
                await asyncio.to_thread(self._build, facts)
            # Where nobody looks, nothing is drawn; who comes is shown the newest.
            if self.ready.is_set() and not self._watched():
                continue
            state, self._state = self._state, None
            if state is not None and self._scene is not None:
                await asyncio.to_thread(self._draw, state)
                if not self.ready.is_set():
                    self.ready.set()
                    self._session.scene_ready()

    def _watched(self) -> bool:
        return self._server is None or bool(self._server.get_clients())

    # -- the bridge's side

    def address(self) -> tuple[int, dict[str, str]]:
        """Returns the port of viser's own server, and the headers that let the bridge in."""
        return int(self._server.get_port()), {BRIDGE_HEADER: self._secret}

    # -- the scene

    def _build(self, facts: Facts) -> None:
        """Makes the scene of a new run."""
        with self._lock:
            if facts.mj_model is None:
                if self._server is not None:
                    self._server.scene.reset()
                self._scene = None
                return
            if self._server is None:
                self._server = self._start()
            import msgspec
            from mjviser import ViserMujocoScene

            model = self._model = loaded(facts.mj_model)
            self._data = MjData(model)
            world = msgspec.json.decode(facts.world)
            with self._server.atomic():
                self._server.scene.reset()
                # It scales what the model says of looks: it gets a copy of its own.
                self._scene = ViserMujocoScene(self._server, loaded(facts.mj_model), 1)
                self._scene.camera_tracking_enabled = False  # it would shift the world
                self._scene.show_contact_points = True
                self._scene.set_refresh_handler(lambda: None)  # its own threads read no data
                self._overlays = make_overlays(self._server, model, world)
                self._make_panel(world)
            self._last_base = None

    def _start(self) -> Any:
        """Starts viser's server, which lets nobody in but the bridge, and opens no way out."""
        import rich
        import viser
        from viser import _messages

        rich.get_console().quiet = True  # viser prints its own address, which is not for users
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        inner: Any = server._websock_server

        async def check(client: Any) -> None:
            connection = inner._live_connections.get(client.client_id)
            told = connection.request.headers.get(BRIDGE_HEADER, "") if connection is not None else ""
            if not secrets.compare_digest(told, self._secret):
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
        server.gui.configure_theme(show_logo=False, show_share_button=False)
        server.scene.set_up_direction("+z")
        server.on_client_connect(self._place_camera)
        return server

    def _stop(self) -> None:
        with self._lock, contextlib.suppress(Exception):
            self._server.stop()

    def _draw(self, state: State) -> None:
        """Shows a state."""
        with self._lock:
            model, data = self._model, self._data
            if model is None or data is None or self._scene is None or state.physics is None:
                return
            numbers = np.frombuffer(state.physics)
            if numbers.size != mujoco.mj_stateSize(model, INTEGRATION):
                return
            mujoco.mj_setState(model, data, numbers, INTEGRATION)
            mujoco.mj_forward(model, data)
            with self._server.atomic():
                self._scene.update_from_mjdata(data)
                for overlay in self._overlays.values():
                    overlay.draw(data, state)
                self._show_in_panel(state)
                self._move_cameras(data)

    # -- the camera

    def _base(self, data: MjData) -> Any:
        """Returns where the first body that moves is."""
        assert self._model is not None
        moving = np.flatnonzero(self._model.body_dofnum > 0)
        return np.array(data.xpos[moving[0]] if moving.size else np.zeros(3))

    def _place_camera(self, client: Any) -> None:
        """Gives a browser that comes a view from the side, of the newest state."""
        self._loop.call_soon_threadsafe(self._changed.set)
        if self._data is None:
            return
        base = self._base(self._data)
        client.camera.position = base + np.array((-3.5, -3.5, 3.0))
        client.camera.look_at = base + np.array((1.5, 0.0, 1.0))
        client.camera.up_direction = np.array((0.0, 0.0, 1.0))

    def _move_cameras(self, data: MjData) -> None:
        base, before = self._base(data), self._last_base
        self._last_base = base
        view = self._handles["view"].value if "view" in self._handles else "free"
        if view == "free" or (before is not None and view != "eye" and np.array_equal(base, before)):
            return
        for client in self._server.get_clients().values():
            camera = client.camera
            if view == "follow" and before is not None:
                camera.position, camera.look_at = camera.position + base - before, camera.look_at + base - before
            elif view == "top":
                camera.position, camera.look_at = base + np.array((-0.01, 0.0, 9.0)), base
            elif view == "eye":
                self._look_through_eye(camera, data)

    def _look_through_eye(self, camera: Any, data: MjData) -> None:
        site = next((overlay.site for overlay in self._overlays.values() if overlay.site is not None), None)
        if site is not None:
            place, axes = np.array(data.site_xpos[site]), data.site_xmat[site].reshape(3, 3)
            camera.position, camera.look_at, camera.up_direction = place, place + axes[:, 0], axes[:, 2]

    # -- viser's own panel

    def _make_panel(self, world: dict[str, Any]) -> None:
        gui = self._server.gui
        gui.reset()
        self._handles = {"time": gui.add_markdown("")}
        buttons = gui.add_button_group("run", ("run", "pause", "step", "back"))
        words: dict[str, Callable[[], Any]] = {"run": say.Run, "pause": say.Pause, "step": say.Step, "back": say.Back}

        @buttons.on_click
        def _(_: Any) -> None:
            self._said(words[buttons.value]())

        for name in world["apertures"][:8]:
            slider = gui.add_slider(f"{name} [cm]", min=0, max=300, step=1, initial_value=0)
            slider.on_update(partial(self._slid, name, slider))
            self._handles[f"aperture {name}"] = slider
        self._handles["view"] = gui.add_dropdown("camera", VIEWS, initial_value="free")
        self._handles["view"].on_update(self._turned)
        for name, overlay in self._overlays.items():
            box = gui.add_checkbox(name, initial_value=overlay.visible)
            box.on_update(partial(_switch, overlay, box))

    def _show_in_panel(self, state: State) -> None:
        pace = "" if state.measured is None else f" · {state.measured:.1f}x"
        text = f"**t = {state.time:.2f} s** · {state.status}{pace}"
        if self._handles["time"].content != text:
            self._handles["time"].content = text
        self._quiet = True
        for name, width in state.apertures.items():
            slider = self._handles.get(f"aperture {name}")
            if slider is not None and round(slider.value) != round(100 * width):
                slider.value = min(300, round(100 * width))
        self._quiet = False

    def _slid(self, name: str, slider: Any, _: Any) -> None:
        if not self._quiet:
            self._said(say.Aperture(width=slider.value / 100, name=name))

    def _turned(self, _: Any) -> None:
        with self._lock:
            if self._data is not None:
                self._last_base = None
                self._move_cameras(self._data)

    def _said(self, command: Any) -> None:
        """Hands what a user does in the panel to the session, whose thread is another."""

        def tell() -> None:
            self._session._keep(self._session.carry_out(command, "3D view"))

        self._loop.call_soon_threadsafe(tell)


def _switch(overlay: Overlay, box: Any, _: Any) -> None:
    """Shows or hides an overlay, as its box says."""
    overlay.show(box.value)
