"""Divides physics steps into shorter parts where a body moves fast near something that it could pass through."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any, cast

import mujoco
import numpy as np
from mujoco import mjtGeom
from numpy.typing import NDArray

from actr3d.clock import seconds
from actr3d.errors import WorldError
from actr3d.world.body import Body
from actr3d.world.kernel import any_within_distance, fastest
from actr3d.world.objects import Pushes
from actr3d.world.physics import Physics
from actr3d.world.reach import radius

STRIDE = 0.006
"""The most that any point of a body may move in one physics step when something is near [m]: walking at 3 m/s with steps of 2 ms.
Contacts get stiffer with shorter steps (see `WALL_SOLREF`), so this limit is valid at any speed. Source: chosen for this library."""

MAX_PARTS = 500
"""Greatest number of parts of one physics step; more would mean a speed of 1,500 m/s: the physics has diverged. Source: chosen."""

TICK = 0.01
"""Time between two checks of bodies for deviations from their commands [s]."""


class Substepping:
    """Steps the physics of a world, and chooses the number of parts of each step from its state alone.

    Args:
        physics: The compiled scene and its state.
        bodies: Those that must not pass through anything.
        pushes: The forces by which a user pushes objects.
    """

    def __init__(self, physics: Physics, bodies: list[Body], pushes: Pushes) -> None:
        model = physics.mj_model
        self._physics = physics
        self._bodies = bodies
        self._pushes = pushes
        self._holds = [body.hold for body in bodies]
        self._whole = physics.timestep
        self._tick = max(1, round(TICK / self._whole))
        self._qvel = physics.mj_data.qvel
        self._reaches = np.vstack([np.zeros((1, model.nv)), *(body.reaches for body in bodies)])
        """By moving part and degree of freedom: the greatest way of its farthest point per unit of the degree of freedom [m]."""
        self._together = np.ones(model.nv, dtype=np.intp)
        """By degree of freedom: how many consecutive ones, from it on, form one velocity vector; 1 for a single one, 0 for later members of
        a vector."""
        for body in bodies:
            v = body.base.v
            for first, count in [(v, 2)] if body.base.planar else [(v, 3), (v + 3, 3)] if body.base.free else []:
                self._together[first : first + count] = [count] + [0] * (count - 1)
        self._others = [_others(body) for body in bodies]
        self._radii = [radius(model, body.root, body.touch_geoms) for body in bodies]

    def stretches(self, steps: int) -> Iterator[int]:
        """Divides a number of steps into stretches of 10 ms, or the rest; between them bodies check for deviations."""
        for start in range(0, steps, self._tick):
            yield min(self._tick, steps - start)

    def step(self, steps: int, watchers: Sequence[Callable[[], None]]) -> None:
        """Advances the physics by the whole steps of a stretch, divided into parts where a body is fast.

        Args:
            steps: Their number, one of `stretches`.
            watchers: Called after each part.

        Raises:
            WorldError: If a body is faster than the greatest number of parts permits: the physics has diverged.
        """
        model, data = cast("Any", self._physics.mj_model), self._physics.mj_data
        pushed = bool(self._pushes)
        fine = self._prepare(steps) or pushed  # a push may make it fast at once
        if pushed:
            self._pushes.begin(steps)
        for _ in range(steps):
            parts = self._needed() if fine else 1
            try:
                if parts > 1:
                    model.opt.timestep = self._whole / parts
                for _ in range(parts):
                    mujoco.mj_step(model, data)
                    if data.ncon:
                        for hold in self._holds:
                            hold.after_part()
                    if watchers:
                        self._physics.changed()  # a watcher may read a sensor
                        for watcher in watchers:
                            watcher()
            finally:
                if parts > 1:
                    model.opt.timestep = self._whole
        if pushed:
            self._pushes.end(steps)
        self._physics.changed()

    def _prepare(self, count: int) -> bool:
        """Corrects the bodies before some steps. Returns whether these steps must be divided: a point of a body may move more than `STRIDE`
        in one of them, and an object is near enough for a collision."""
        duration = count * self._whole
        for hold in self._holds:
            hold.before_step(duration)
        held = self._held()
        speed = self._fastest(held)
        return speed * self._whole > STRIDE and self._near(held + speed * duration)

    def _needed(self) -> int:
        """Returns the number of parts of the next step.

        Raises:
            WorldError: If there would be too many.
        """
        way = self._fastest(self._held()) * self._whole
        if not way <= STRIDE * MAX_PARTS:
            raise WorldError(f"the physics diverged near {seconds(self._physics.time)} s: forces or speeds without bounds")
        return max(1, math.ceil(way / STRIDE))

    def _fastest(self, held: float) -> float:
        """Returns an upper bound of the speed of any point of any body, or of what it holds [m/s]."""
        return fastest()(self._reaches, self._qvel, self._together, held)

    def _held(self) -> float:
        """Returns an upper bound of the extent of held objects beyond the hands [m]."""
        geoms = [geom for body in self._bodies for geom in body.contacts.held()]
        return 2 * float(self._physics.mj_model.geom_rbound[geoms].max()) if geoms else 0.0

    def _near(self, beyond: float) -> bool:
        """Returns whether any other object is within a distance [m] beyond the reach of a body."""
        self._physics.refresh_positions()
        boxes, data = self._physics.mj_model.geom_aabb, self._physics.mj_data
        for body, others, far in zip(self._bodies, self._others, self._radii, strict=True):
            if any_within_distance()(others, boxes, data.geom_xpos, data.geom_xmat, data.xpos[body.root], far + beyond):
                return True
        return False


def _others(body: Body) -> NDArray[np.intp]:
    """Returns the geoms with contacts that a body could pass through: those of other objects, without planes."""
    model = body.physics.mj_model
    others = body.physics.solid & (model.geom_type != int(mjtGeom.mjGEOM_PLANE)) & ~body.members[model.geom_bodyid]
    return np.flatnonzero(others)
