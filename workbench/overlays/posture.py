"""Shows the posture that a body is commanded to take, as a translucent copy of the parts that are still moving there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from mujoco import MjData

from workbench.overlays.overlay import Observed, Overlay, OverlayCanvas, overlay

if TYPE_CHECKING:
    from actr3d.world.body import Body

SLIGHT = 1e-3
"""A part counts as arrived if its position [m] and axes differ by less than this in total."""
COLOUR = (60, 170, 90)


class Copies:
    """Translucent copies of the parts of bodies that would be elsewhere in another posture.

    Args:
        canvas: The 3D view.
        name: Their name in viser's tree.
        colour: Red, green, blue, 0 to 255.
    """

    def __init__(self, canvas: OverlayCanvas, name: str, colour: tuple[int, int, int]) -> None:
        self._server, self._model, self._data = canvas.server, canvas.model, MjData(canvas.model)
        self._name, self._colour = name, colour
        self._handles: dict[int, Any] = {}
        self._seen: set[int] = set()

    def draw(self, data: MjData, targets: list[Any]) -> None:
        """Draws the parts that joints at other positions would move.

        Args:
            data: The current state.
            targets: The positions, as index in `qpos` and value [rad] or [m].
        """
        self._seen = self._pose(data, targets) if targets else set()
        for number in self._seen - self._handles.keys():
            self._handles[number] = self._copy(number)
        for number in self._seen:
            handle = self._handles[number]
            if handle is not None:
                handle.position, handle.wxyz = self._data.xpos[number].copy(), self._data.xquat[number].copy()

    def _pose(self, data: MjData, targets: list[Any]) -> set[int]:
        """Computes the posture; returns the MuJoCo bodies whose pose differs from the current one."""
        now, then = data, self._data
        then.qpos[:], then.mocap_pos[:], then.mocap_quat[:] = now.qpos, now.mocap_pos, now.mocap_quat
        for place, target in targets:
            then.qpos[int(place)] = target
        mujoco.mj_kinematics(self._model, then)
        off = np.abs(then.xpos - now.xpos).max(axis=1) + np.abs(then.xmat - now.xmat).max(axis=1)
        return set(np.flatnonzero(off > SLIGHT).tolist())

    def _copy(self, number: int) -> Any:
        """Returns a translucent copy of a part; None if the part has no shape."""
        from mjviser.conversions import merge_geoms

        geoms = [
            geom for geom in range(self._model.ngeom) if self._model.geom_bodyid[geom] == number and self._model.geom_rgba[geom, 3] > 0
        ]
        if not geoms:
            return None
        mesh = merge_geoms(self._model, geoms)
        return self._server.scene.add_mesh_simple(
            f"{self._name}/{number}", mesh.vertices, mesh.faces, color=self._colour, opacity=0.35, cast_shadow=False, visible=False
        )

    def show(self, visible: bool) -> None:
        """Shows or hides the copies."""
        for number, handle in self._handles.items():
            seen = visible and number in self._seen
            if handle is not None and handle.visible != seen:
                handle.visible = seen


@overlay("posture", "commanded posture")
class Posture(Overlay):
    """Shows the moving parts at their commanded positions, relative to the body's current position."""

    def __init__(self, canvas: OverlayCanvas) -> None:
        self._copies = Copies(canvas, "/overlays/posture", COLOUR)
        self.drawn = (self._copies,)

    @staticmethod
    def data(observed: Observed) -> dict[str, Any]:
        """Returns the commanded joint positions [rad] or [m], with their index in `qpos`, of each body."""
        return {name: _targets(body) for name, body in observed.simulation.world.bodies.items()}

    def draw(self, data: MjData, by_body: dict[str, Any] | None) -> None:
        """Draws the parts that differ from the current posture."""
        self._copies.draw(data, [target for body in (by_body or {}).values() for target in body])
        self.switch()


def _targets(body: Body) -> list[list[float]]:
    """Returns the positions to which joints are moving, as index in `qpos` and position [rad] or [m]."""
    targets = body.motion.targets
    return [[int(joint.q), targets[name][0]] for name, joint in body.joints.items() if name in targets]
