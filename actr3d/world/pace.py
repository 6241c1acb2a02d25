"""How finely the physics is stepped: finer where a body moves fast near something that it could get through."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, cast

import mujoco
import numpy as np
from mujoco import mjtGeom
from numpy.typing import NDArray

from actr3d.clock import seconds
from actr3d.errors import WorldError
from actr3d.world.reach import radius, reaches

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
        self._holdings = [body.holding for body in bodies]
        self._hands = [hand for body in bodies for hand in body.hands.values()]
        self._whole = world.scene.timestep
        self._tick = max(1, round(TICK / self._whole))
        self._qvel = world.mj_data.qvel
        self._reaches = np.vstack([np.zeros((1, world.mj_model.nv)), *(reaches(body) for body in bodies)])
        """By moving part and degree of freedom: how many metres its farthest point goes for one of the joint's, at most."""
        self._farthest = self._reaches.max(axis=0)
        """The same for the part that goes farthest."""
        planar = [slice(body.base.v, body.base.v + 2) for body in bodies if body.base.planar]
        free = [slice(body.base.v + n, body.base.v + n + 3) for body in bodies if body.base.free for n in (0, 3)]
        self._together = planar + free
        """Degrees of freedom whose speeds add as vectors do."""
        self._others = [_others(body) for body in bodies]
        self._radii = [radius(body) for body in bodies]

    def steps(self, steps: int) -> Iterator[None]:
        """Advances the physics by whole steps, cut into parts where a body is fast; yields after each part.

        Raises:
            WorldError: If a body gets faster than any number of parts is enough for: the physics has diverged.
        """
        model, data = cast("Any", self._world.mj_model), self._world.mj_data
        for start in range(0, steps, self._tick):
            count = min(self._tick, steps - start)
            fine = self._prepare(count)
            for _ in range(count):
                parts = self._needed() if fine else 1
                try:
                    if parts > 1:
                        model.opt.timestep = self._whole / parts
                    for _ in range(parts):
                        mujoco.mj_step(model, data)
                        if data.ncon:
                            for holding in self._holdings:
                                holding.notice()
                        yield
                finally:
                    if parts > 1:
                        model.opt.timestep = self._whole

    def _prepare(self, count: int) -> bool:
        """Lets the bodies hold what they are told to for some steps; returns whether these are to be cut into parts: a body may go
        farther than its stride in one of them, and something is so near that it could hit it in all."""
        self._world.changed()
        duration, fastest = count * self._whole, 0.0
        for holding in self._holdings:
            fastest = max(fastest, holding.before_step(duration))
        held = self._held()
        if not held and (fastest * self._whole <= STRIDE or self._bound() * self._whole <= STRIDE):
            return False
        fastest = self._fastest(held)
        return fastest * self._whole > STRIDE and self._near(held + fastest * duration)

    def _bound(self) -> float:
        """Returns a speed that no point of any body exceeds [m/s], quickly; without what hands hold."""
        return float(np.abs(self._qvel).dot(self._farthest))

    def _needed(self) -> int:
        """Returns how many parts the next step is to be cut into."""
        way = self._fastest(self._held()) * self._whole
        if not way <= STRIDE * MOST:
            raise WorldError(f"the physics diverged near {seconds(self._world.time)} s: forces or speeds without bounds")
        return max(1, math.ceil(way / STRIDE))

    def _fastest(self, held: float) -> float:
        """Returns a speed that no point of any body, or of what it holds, exceeds [m/s]."""
        speeds = np.abs(self._qvel)
        for together in self._together:
            speeds[together.start] = math.hypot(*speeds[together].tolist())
            speeds[together.start + 1 : together.stop] = 0
        fastest = float((self._reaches @ speeds).max())
        return fastest + held * float(speeds.sum()) if held else fastest

    def _held(self) -> float:
        """Returns how far what hands hold reaches beyond them, at most [m]."""
        geoms = [geom for hand in self._hands for geom in hand.geoms]
        return 2 * float(self._world.mj_model.geom_rbound[geoms].max()) if geoms else 0.0

    def _near(self, beyond: float) -> bool:
        """Returns whether any other thing is no farther than so much beyond the reach of a body [m]."""
        self._world.refresh()
        model, data = self._world.mj_model, self._world.mj_data
        for body, others, far in zip(self._bodies, self._others, self._radii, strict=True):
            from_it = data.xpos[body.root] - data.geom_xpos[others]
            within = np.einsum("nij,ni->nj", data.geom_xmat[others].reshape(-1, 3, 3), from_it) - model.geom_aabb[others, :3]
            gaps = np.maximum(np.abs(within) - model.geom_aabb[others, 3:], 0)
            if (np.einsum("ij,ij->i", gaps, gaps) < (far + beyond) ** 2).any():
                return True
        return False


def _others(body: Body) -> NDArray[np.intp]:
    """Returns the geoms that a body could get through: planes have no other side."""
    model = body.world.mj_model
    solid = (model.geom_contype | model.geom_conaffinity) != 0
    solid &= (model.geom_type != int(mjtGeom.mjGEOM_PLANE)) & ~body.members[model.geom_bodyid]
    return np.flatnonzero(solid)
