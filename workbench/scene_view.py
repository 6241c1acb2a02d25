"""Shows the 3D view of a session: a viser server on loopback that draws the newest state of the run."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import secrets
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel

from actr3d.world.compiled import from_bytes
from workbench.backdrop import Outlines, Shades, lay_grounds, light
from workbench.curves import INTEGRATION
from workbench.geom_colours import dress
from workbench.overlays import OVERLAYS, Overlay, OverlayCanvas, ViewSettings
from workbench.overlays.frustum import Frustum
from workbench.scene_framing import SceneFraming
from workbench.viser_panel import Panel
from workbench.viser_server import BRIDGE_HEADER, SHADOWS_HEADER, Moments, header_of, send_scene_data, start_viser
from workbench.worker.messages import Facts, State, notice

if TYPE_CHECKING:
    from workbench.page_commands.command import PageCommand
    from workbench.session import Session

PATIENCE = 60.0
"""Longest time for which a browser waits for the scene of a run [s]: a large one takes seconds to build, a run may never get that far."""


class SceneView:
    """Shows the world of a session's run with overlays and viser's own panel.

    Everything is drawn in a separate thread from a copy of the model. If states arrive faster than they can be drawn, only the newest is
    drawn. As long as no browser wants it, nothing is built or drawn, and the worker computes no data for overlays.

    Args:
        session: The session to show; it receives the commands that users give in the panel.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._loop = asyncio.get_running_loop()
        self._secret = secrets.token_urlsafe(32)
        self._lock = threading.Lock()
        self._changed = asyncio.Event()
        self._asked = False
        """Whether a browser is about to connect."""
        self._facts: Facts | None = None
        self._state: State | None = None
        self._look = session.look
        self._server: Any = None
        self._moments: Moments
        self._scene: _RunScene | None = None
        self._panel: Panel | None = None
        self._ready = asyncio.Event()
        """Set while the scene is that of the newest run, or cannot be drawn."""
        self.over = False
        session.watchers.append(self._watch)
        self._task = asyncio.create_task(self._draw_on())

    # -- updates from the session

    def _watch(self, what: Facts | State | ViewSettings | None) -> None:
        if what is None:
            self._task.cancel()
            self.over = True
            if self._server is not None:
                threading.Thread(target=self._stop, daemon=True).start()
        elif isinstance(what, Facts):
            self._facts, self._state = what, None
            self._ready.clear()
        elif isinstance(what, ViewSettings):
            self._look = what
        elif what.physics is not None:
            self._state = what
        self._changed.set()

    async def _draw_on(self) -> None:
        """Draws the newest state whenever there is something new; what cannot be drawn is reported, and the next run is tried again."""
        while True:
            await self._changed.wait()
            self._changed.clear()
            try:
                await self._draw_newest()
            except Exception as error:
                logging.getLogger("workbench").exception("the 3D view cannot be drawn")
                self._session.add_notice(notice("error", f"the 3D view of this run cannot be drawn: {type(error).__name__}: {error}"))
                self._scene = None
                self._ready.set()

    async def _draw_newest(self) -> None:
        """Draws the newest state, if a browser shows it; builds the scene before if the run is new."""
        watched = self._server is not None and bool(self._server.get_clients())
        if not (watched or self._asked):
            self._session.draw(())
            return
        facts, self._facts = self._facts, None
        if facts is not None:
            await asyncio.to_thread(self._build, facts)
        self._session.draw(self._scene.asked(self._look) if watched and self._scene is not None else ())
        state, self._state = self._state, None
        if self._scene is None:
            return
        await asyncio.to_thread(self._draw, self._scene, state)
        if state is not None and self._facts is None:
            self._asked = False
            self._ready.set()

    # -- access for browsers

    @property
    def exists(self) -> bool:
        """Whether the run on screen has a world."""
        facts = self._session.facts
        return facts is not None and facts.mj_model is not None

    def prepare(self) -> None:
        """Builds the scene of the newest run for a browser that is about to connect, unless it is there already."""
        if not self._ready.is_set():
            self._asked = True
            self._changed.set()

    async def wait(self) -> bool:
        """Waits until the scene is that of the newest run, but not longer than `PATIENCE`; returns whether there is one."""
        self.prepare()
        ready = asyncio.ensure_future(self._ready.wait())
        await asyncio.wait([ready, self._task], timeout=PATIENCE, return_when=asyncio.FIRST_COMPLETED)
        ready.cancel()
        return self._ready.is_set() and self._scene is not None and not self.over

    def address(self, *, shadows: bool) -> tuple[int, dict[str, str]]:
        """Returns the port of viser's server, and the headers that admit the bridge and say whether shadows are wanted."""
        return int(self._server.get_port()), {BRIDGE_HEADER: self._secret, SHADOWS_HEADER: "on" if shadows else "off"}

    # -- the scene

    def _build(self, facts: Facts) -> None:
        """Builds the scene of a new run."""
        with self._lock:
            self._scene = None
            if facts.mj_model is None:
                if self._server is not None:
                    self._server.scene.reset()
                return
            if self._server is None:
                self._server = start_viser(self._secret)
                if self.over:  # the session was closed in the meantime
                    self._server.stop()
                    return
                self._moments = Moments(self._server)
                self._server.gui.configure_theme(show_logo=False, show_share_button=False)
                self._server.on_client_connect(self._come)
                self._server.on_client_disconnect(self._wake)
            with self._server.atomic():
                self._server.scene.reset()
                self._moments.begin()
                self._scene = _RunScene(self._server, self._moments, facts, self._look, self._panel_for, self._said)

    def _panel_for(self, apertures: dict[str, tuple[int, int]]) -> Panel:
        """Returns the panel: the one of the previous run if it has the same apertures, otherwise a new one."""
        if self._panel is None or self._panel.apertures != apertures:
            self._panel = Panel(self._server.gui, apertures, self._look, self._said)
        return self._panel

    def _stop(self) -> None:
        with self._lock, contextlib.suppress(Exception):
            self._server.stop()

    def _draw(self, scene: _RunScene, state: State | None) -> None:
        with self._lock, self._server.atomic():
            scene.look(self._look)
            if state is not None:
                scene.show(state)

    def _come(self, client: Any) -> None:
        """Sets up the lights for a browser that connects, and shows it the newest state."""
        light(client, shadows=header_of(self._server, client, SHADOWS_HEADER) != "off")
        self._wake(client)

    def _wake(self, _: Any) -> None:
        self._loop.call_soon_threadsafe(self._changed.set)

    def _said(self, command: PageCommand) -> None:
        """Sends a command from the panel or an overlay to the session, which runs in another thread."""

        def notify() -> None:
            self._session.run_task(self._submit(command))

        self._loop.call_soon_threadsafe(notify)

    async def _submit(self, command: PageCommand) -> None:
        """Submits a command; if it is refused, reports the reason and shows the state of the run again, as handles and sliders differ."""
        reply = await command.submit(self._session)
        if reply.error is None:
            return
        self._session.add_notice(notice("error", reply.error))
        if self._session.state is not None:
            self._watch(self._session.state)


class _RunScene:
    """Draws the scene of one run.

    Args:
        server: Viser's server.
        moments: Numbers the states that are shown.
        facts: The facts of the run; it has a scene.
        look: Which overlays are shown.
        panel: Returns viser's own panel for the given apertures.
        send: Sends a user's command to the session.
    """

    def __init__(
        self,
        server: Any,
        moments: Moments,
        facts: Facts,
        look: ViewSettings,
        panel: Callable[[dict[str, tuple[int, int]]], Panel],
        send: Callable[[PageCommand], None],
    ) -> None:
        import msgspec
        from mjviser import ViserMujocoScene

        assert facts.mj_model is not None
        self._model: MjModel = from_bytes(facts.mj_model)
        self.data = MjData(self._model)
        mujoco.mj_forward(self._model, self.data)
        world: dict[str, Any] = msgspec.json.decode(facts.world)
        # The scene scales the model's visual settings, so it gets a copy of its own.
        copy = from_bytes(facts.mj_model)
        dress(copy, [body["root"] for name, body in world["bodies"].items() if name in world["agents"]])
        self._scene: Any = ViserMujocoScene(server, copy, 1)
        self._scene.camera_tracking_enabled = False  # it would shift the world
        self._scene.set_refresh_handler(lambda: None)  # so that its own threads read no data
        server.scene.configure_environment_map(hdri=None)  # it takes much of the drawing time without a graphics card
        canvas = OverlayCanvas(server, self._scene, self._model, world, send)
        self._overlays: dict[str, Overlay] = {name: overlay(canvas) for name, overlay in OVERLAYS.items()}
        for name, shown in self._overlays.items():
            shown.show(name in look.shown)
        self._server, self._moments = server, moments
        self._stage = SceneFraming(self._model, [world["bodies"][name]["root"] for name in world["agents"]])
        self._time: float | None = None  # of the state that is shown [s]
        self._outlines = Outlines(server, self._model)
        self._shades = Shades(self._model, self._stage.ground)
        send_scene_data(server, "stage", self._stage.data(lay_grounds(server, self._model)))
        self._send_now()
        self._panel = panel({name: (least, most) for name, (least, most) in world["widths"].items()})
        self._look: ViewSettings | None = None

    def asked(self, look: ViewSettings) -> tuple[str, ...]:
        """Returns the overlays whose data the worker must send: those shown, and always the field of view, for the view through the eye."""
        return tuple(name for name in self._overlays if name in look.shown | {"frustum"})

    def look(self, look: ViewSettings) -> None:
        """Shows the chosen overlays."""
        if look == self._look:
            return
        self._look = look
        for name, overlay in self._overlays.items():
            overlay.show(name in look.shown)
        self._panel.choose(look)
        self._scene.update_from_mjdata(self.data)
        self._send_now()

    def show(self, state: State) -> None:
        """Shows a state of the run."""
        assert state.physics is not None
        numbers = np.frombuffer(state.physics)
        if numbers.size != mujoco.mj_stateSize(self._model, INTEGRATION):
            return
        mujoco.mj_setState(self._model, self.data, numbers, INTEGRATION)
        mujoco.mj_forward(self._model, self.data)
        self._scene.update_from_mjdata(self.data)
        for name, overlay in self._overlays.items():
            if overlay.visible or name == "frustum":
                overlay.draw(self.data, state.overlay_data.get(name))
        self._panel.show(state)
        self._time = state.time
        self._send_now()

    def _send_now(self) -> None:
        """Sends browsers the time, the positions of the body, its eye and its head, and the shadows and labels."""
        if not np.isfinite(self.data.xpos).all():
            return  # physics has diverged: keep the last valid state
        self._outlines.draw(self.data)
        eyes = self._overlays["frustum"]
        assert isinstance(eyes, Frustum)
        now = {
            "moment": self._moments.next(),
            "time": self._time,
            "body": self._stage.base(self.data).round(5).tolist(),
            "eye": eyes.eye(self.data),
            "heads": eyes.heads(self.data),
            "shade": self._shades.quads(self.data),
            "labels": [label for overlay in self._overlays.values() if overlay.visible for label in overlay.labels],
        }
        send_scene_data(self._server, "now", now)
