"""The skin: what touches which part of a body, and how hard.

The contacts and forces are those that the solver finds for the present state. A touch that begins and ends between two
readings is not felt.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

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
    """Which: the name of a geom of the body."""
    other: str
    """With what: the object's name in the scene."""
    force: float
    """How hard [N]: what presses square to the surface, summed over all contacts of the two."""


@sensor
def contacts(body: Body) -> tuple[Touch, ...]:
    """Senses what touches the skin, in the order of names."""
    world = body.world
    world.solve()
    model, data = world.mj_model, world.mj_data
    if data.ncon == 0:
        return ()
    pairs: NDArray[np.int32] = data.contact.geom
    ours = body.members[model.geom_bodyid[pairs]]
    forces: defaultdict[tuple[str, str], float] = defaultdict(float)
    wrench: NDArray[np.float64] = np.zeros(6)
    for number in np.flatnonzero(ours[:, 0] != ours[:, 1]).tolist():
        mine, other = pairs[number] if ours[number, 0] else pairs[number][::-1]
        if int(mine) in body.feels and data.contact.dist[number] <= 0:
            mujoco.mj_contactForce(model, data, number, wrench)
            forces[body.geom_name(int(mine)), object_name(model, int(other))] += float(wrench[0])
    return tuple(Touch(part=part, other=other, force=force) for (part, other), force in sorted(forces.items()))


def object_name(model: Any, geom: int) -> str:
    """Returns what an object in the world is called: its body's name, or its own where it lies in the world itself."""
    root = int(model.body_rootid[model.geom_bodyid[geom]])
    return str(model.body(root).name if root else model.geom(geom).name)
