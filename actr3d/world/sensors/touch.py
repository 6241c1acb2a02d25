"""The skin: what touches which part of a body, and how hard.

From the first time that its contacts are asked for, a body's skin watches every physics step and keeps the hardest moment
of each touch within a tick, so that a blow that is over before the tick is felt too. The first reading is of the present
state alone.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from actr3d.world.sensors.registry import sensor

if TYPE_CHECKING:
    from actr3d.world.body import Body


@dataclass(frozen=True, kw_only=True)
class Touch:
    """One part of the skin that something touches."""

    part: str
    """Which: the name of a geom of the body, or of an object that it holds."""
    other: str
    """With what: the object's name in the scene."""
    force: float
    """How hard [N]: what presses square to the surface, summed over all contacts of the two."""


@sensor
def contacts(body: Body) -> tuple[Touch, ...]:
    """Senses what touches the skin and how hard [N], in the order of names: the hardest moments of the last tick."""
    if body.touched is None:
        body.touched = present(body)
    return body.touched


def present(body: Body) -> tuple[Touch, ...]:
    """Returns what touches the skin in the present state, in the order of names. For observers: it starts no watch."""
    body.world.solve()
    return last_felt(body)


def step_and_feel(steps: Iterable[None], bodies: Iterable[Body]) -> None:
    """Takes single steps of the physics, and gives each of some bodies the hardest moments of all its touches.

    Args:
        steps: Takes the next step whenever it is asked for the next item.
        bodies: Those that feel, all of one world.
    """
    felt: list[tuple[Body, dict[tuple[str, str], Touch]]] = [(body, {}) for body in bodies]
    for _ in steps:
        for body, hardest in felt:
            for touch in last_felt(body):
                known = hardest.get((touch.part, touch.other))
                if known is None or touch.force > known.force:
                    hardest[touch.part, touch.other] = touch
    for body, hardest in felt:
        body.touched = tuple(touch for _, touch in sorted(hardest.items()))


def last_felt(body: Body) -> tuple[Touch, ...]:
    """Returns the touches that the solver has last found, in the order of names. For observers of single steps."""
    model, data = body.world.mj_model, body.world.mj_data
    if data.ncon == 0:
        return ()
    pairs: NDArray[np.int32] = data.contact.geom
    own = body.members[model.geom_bodyid]
    ours = body.sides(own)
    held = {geom for hand in body.hands.values() for geom in hand.geoms}
    if held:  # what it holds feels for it, but not what holds it
        ours = np.where(ours.any(axis=1, keepdims=True), ours, body.sides(body.own() & ~own))
    forces: defaultdict[tuple[str, str], float] = defaultdict(float)
    wrench: NDArray[np.float64] = np.zeros(6)
    for number in np.flatnonzero(ours[:, 0] != ours[:, 1]).tolist():
        side = 0 if ours[number, 0] else 1
        mine = int(pairs[number, side])
        if (mine in body.feels or mine in held) and data.contact.dist[number] <= 0:
            mujoco.mj_contactForce(model, data, number, wrench)
            part = body.world.owners[mine] if mine in held else body.geom_name(mine)
            forces[part, body.world.other_side(number, 1 - side)] += float(wrench[0])
    return tuple(Touch(part=part, other=other, force=force) for (part, other), force in sorted(forces.items()))
