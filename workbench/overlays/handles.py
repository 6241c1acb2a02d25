"""Shows handles with which a user moves bodies by hand."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from mujoco import MjData

from actr3d.world.frames import yaw_in, yaw_quaternion
from workbench.overlays.overlay import Observed, Overlay, OverlayCanvas, overlay
from workbench.page_commands.changes import SimulationCommand

SIZE = 0.8
"""Length of a handle's arrows [m]."""
ABOVE = 0.02
"""Height of the handles above the ground [m]."""


@overlay("handles", "handles to move things")
class Handles(Overlay):
    """Shows arrows and an arc at the foot of each body, wall or object that can be moved: dragging them moves or turns it.

    The thing moves when its handle is released. This is a user's change like any other: it is recorded, and can be undone.
    """

    def __init__(self, canvas: OverlayCanvas) -> None:
        self._server, self._send = canvas.server, canvas.send
        self._handles: dict[str, Any] = {}
        self._held: set[str] = set()

    @staticmethod
    def data(observed: Observed) -> dict[str, Any]:
        """Returns the position [m] and heading [rad] of each thing that can be moved: (x, y, heading)."""
        objects = observed.simulation.world.objects
        return {name: list(objects.pose(name)) for name in objects.names}

    def draw(self, data: MjData, by_body: dict[str, Any] | None) -> None:
        """Draws the handles; one that is being dragged stays where it is."""
        for name, (x, y, heading) in (by_body or {}).items():
            handle = self._handles.get(name) or self._add(name)
            if name not in self._held:
                handle.position = (x, y, ABOVE)
                handle.wxyz = yaw_quaternion(heading)
        self.switch()

    def _add(self, name: str) -> Any:
        """Adds the handle of a body or object."""
        handle = self._server.scene.add_transform_controls(
            f"/overlays/handles/{len(self._handles)}", scale=SIZE, active_axes=(True, True, False), depth_test=False, visible=False
        )
        hold: Callable[[Any], None] = partial(self._hold, name)
        release: Callable[[Any], None] = partial(self._release, name)
        handle.on_drag_start(hold)
        handle.on_drag_end(release)
        self._handles[name] = handle
        return handle

    def _hold(self, name: str, _: Any) -> None:
        self._held.add(name)

    def _release(self, name: str, event: Any) -> None:
        """Moves a body or object to where its handle was released."""
        self._held.discard(name)
        x, y, _ = (float(value) for value in event.target.position)
        values = (name, round(x, 3), round(y, 3), round(yaw_in([float(value) for value in event.target.wxyz]), 4))
        self._send(SimulationCommand(word="move", values=values))

    def switch(self) -> None:
        """Shows or hides the handles."""
        for handle in self._handles.values():
            if handle.visible != self.visible:
                handle.visible = self.visible
