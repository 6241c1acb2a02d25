"""How finely the physics is stepped: finer where a body moves fast near something that it could get through."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, cast

import mujoco
import numpy as np
from mujoco import mjtGeom, mjtJoint
from numpy.typing import NDArray

from actr3d.clock import seconds
from actr3d.errors import WorldError

if TYPE_CHECKING:
    from actr3d.world.body import Body
    from actr3d.world.world import World

STRIDE = 0.006
"""The most that any point of a body may move in one physics step when something is near [m]: walking at 3 m/s with steps of 2 ms.
Contacts get stiffer with shorter steps (see `WALL_SOLREF`), so what holds at this stride holds at any speed. Ours."""

MOST = 500
"""The most parts that a physics step is cut into; what would need more moves at 1,500 m/s, and has diverged. Ours."""


TICK = 0.01
"""How often bodies look whether they keep what they are told [s]."""


class Pace:
    """Steps the physics of a world, and chooses from its state alone how many parts each step is cut into.

    Args:
        world: Whose.
        bodies: Those that may not get through anything.
    """

    def __init__(self, world: World, bodies: list[Body]) -> None:
        self._world = world
        self._bodies = bodies
        self._tick = max(1, round(TICK / world.scene.timestep))
        self._reaches = np.vstack([np.zeros((0, world.mj_model.nv)), *(_reaches(body) for body in bodies)])
        """By moving part and degree of freedom: how many metres its farthest point goes for one of the joint's, at most."""
        planar = [slice(body.base.v, body.base.v + 2) for body in bodies if body.base.planar]
        free = [slice(body.base.v + n, body.base.v + n + 3) for body in bodies if body.base.free for n in (0, 3)]
        self._together = planar + free
        """Degrees of freedom whose speeds add as vectors do."""
        self._others = [_others(body) for body in bodies]
        self._radii = [float(_lengths(body).max(initial=0.0)) for body in bodies]

    def steps(self, steps: int) -> Iterator[None]:
        """Advances the physics by whole steps, cut into parts where a body is fast; yields after each part.

        Raises:
            WorldError: If a body gets faster than any number of parts is enough for: the physics has diverged.
        """
        model, data = cast("Any", self._world.mj_model), self._world.mj_data
        whole = self._world.scene.timestep
        fast = False
        for step in range(steps):
            if step % self._tick == 0:
                fast = self._prepare(min(self._tick, steps - step))
            parts = self._parts() if fast else 1
            model.opt.timestep = whole / parts
            try:
                for _ in range(parts):
                    mujoco.mj_step(model, data)
                    if data.ncon:
                        for body in self._bodies:
                            body.holding.notice()
                    yield
            finally:
                model.opt.timestep = whole
        self._world.changed()

    def _prepare(self, steps: int) -> bool:
        """Lets the bodies hold what they are told to for some steps; returns whether these are to be cut into parts: a body may go
        farther than its stride in one of them, and something is so near that it could hit it in all."""
        self._world.changed()
        duration = steps * self._world.scene.timestep
        for body in self._bodies:
            body.holding.before_step(duration)
        speed = self._fastest()
        return speed * self._world.scene.timestep > STRIDE and self._near(speed * duration)

    def _parts(self) -> int:
        way = self._fastest() * self._world.scene.timestep
        if not way <= STRIDE * MOST:
            raise WorldError(f"the physics diverged near {seconds(self._world.time)} s: forces or speeds without bounds")
        return max(1, math.ceil(way / STRIDE))

    def _fastest(self) -> float:
        """Returns a speed that no point of any body exceeds [m/s]."""
        speeds = np.abs(self._world.mj_data.qvel)
        for together in self._together:
            speeds[together.start] = math.hypot(*speeds[together].tolist())
            speeds[together.start + 1 : together.stop] = 0
        fastest = float((self._reaches @ speeds).max(initial=0.0))
        held = self._held()
        return fastest + held * float(speeds.sum()) if held else fastest

    def _held(self) -> float:
        """Returns how far what hands hold reaches beyond them, at most [m]."""
        geoms = [geom for body in self._bodies for hand in body.hands.values() for geom in hand.geoms]
        return 2 * float(self._world.mj_model.geom_rbound[geoms].max()) if geoms else 0.0

    def _near(self, way: float) -> bool:
        """Returns whether any other thing is within reach of a body that goes so far [m]."""
        self._world.refresh()
        model, data = self._world.mj_model, self._world.mj_data
        held = self._held()
        for body, others, radius in zip(self._bodies, self._others, self._radii, strict=True):
            from_it = data.xpos[body.root] - data.geom_xpos[others]
            within = np.einsum("nij,ni->nj", data.geom_xmat[others].reshape(-1, 3, 3), from_it) - model.geom_aabb[others, :3]
            gaps = np.maximum(np.abs(within) - model.geom_aabb[others, 3:], 0)
            if (np.einsum("ij,ij->i", gaps, gaps) < (radius + held + way) ** 2).any():
                return True
        return False


def _others(body: Body) -> NDArray[np.intp]:
    """Returns the geoms that a body could get through: planes have no other side."""
    model = body.world.mj_model
    solid = (model.geom_contype | model.geom_conaffinity) != 0
    solid &= (model.geom_type != int(mjtGeom.mjGEOM_PLANE)) & ~body.members[model.geom_bodyid]
    return np.flatnonzero(solid)


def _lengths(body: Body) -> NDArray[np.float64]:
    """Returns for each solid geom of a body how far its farthest point is from the base in any posture, at most [m]."""
    return np.array([_length(body, geom, body.root, np.zeros(3)) for geom in body.feeling.tolist()])


def _reaches(body: Body) -> NDArray[np.float64]:
    """Returns for each solid geom and each degree of freedom how far its farthest point goes for one of the joint's, at most [m]."""
    model = body.world.mj_model
    reaches = np.zeros((len(body.feeling), model.nv))
    for row, geom in enumerate(body.feeling.tolist()):
        for joint in range(model.njnt):
            carried = int(model.jnt_bodyid[joint])
            if not body.members[carried] or not _carries(model, carried, int(model.geom_bodyid[geom])):
                continue
            first, kind = int(model.jnt_dofadr[joint]), int(model.jnt_type[joint])
            far = _length(body, geom, carried, model.jnt_pos[joint])
            if kind == int(mjtJoint.mjJNT_FREE):
                reaches[row, first : first + 3], reaches[row, first + 3 : first + 6] = 1.0, far
            else:
                count = 3 if kind == int(mjtJoint.mjJNT_BALL) else 1
                reaches[row, first : first + count] = 1.0 if kind == int(mjtJoint.mjJNT_SLIDE) else far
    return np.unique(reaches, axis=0)


def _length(body: Body, geom: int, start: int, at: NDArray[np.float64]) -> float:
    """Returns how far a geom's farthest point is from a point on a MuJoCo body that carries it, in any posture, at most [m]."""
    model = body.world.mj_model
    carrier = int(model.geom_bodyid[geom])
    far = float(model.geom_rbound[geom])
    if carrier == start:
        return far + float(np.linalg.norm(model.geom_pos[geom] - at))
    far += float(np.linalg.norm(model.geom_pos[geom]))
    while int(model.body_parentid[carrier]) != start:
        far += float(np.linalg.norm(model.body_pos[carrier])) + _slide(model, carrier)
        carrier = int(model.body_parentid[carrier])
    return far + float(np.linalg.norm(model.body_pos[carrier] - at)) + _slide(model, carrier)


def _slide(model: Any, body: int) -> float:
    """Returns how far the slides of a MuJoCo body can take it from its place, where they have limits [m]."""
    first = int(model.body_jntadr[body])
    slides = [n for n in range(first, first + int(model.body_jntnum[body])) if model.jnt_type[n] == int(mjtJoint.mjJNT_SLIDE)]
    return sum(float(np.abs(model.jnt_range[n]).max()) for n in slides if model.jnt_limited[n])


def _carries(model: Any, carrier: int, body: int) -> bool:
    while body > carrier:
        body = int(model.body_parentid[body])
    return body == carrier
