"""The contacts of one body: which geoms are its own, what touches its skin, and with which force."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from actr3d.world.grasp import Hand
from actr3d.world.physics import Physics


@dataclass(frozen=True, kw_only=True)
class Touch:
    """One part of the skin that something touches."""

    part: str
    """The name of a geom of the body, or of an object that it holds."""
    other: str
    """The name in the scene of the object that touches it."""
    force: float
    """Normal force [N], summed over all contacts of the two."""


class BodyContacts:
    """Finds the contacts of one body, and of the objects that it holds, with anything else.

    Args:
        physics: The compiled scene and its state.
        members: (nbody,) by MuJoCo body: whether it is part of the body.
        skin: By geom that feels contacts: its name in the body.
        hands: The hands of the body.
    """

    def __init__(self, physics: Physics, members: NDArray[np.bool_], skin: Mapping[int, str], hands: Collection[Hand]) -> None:
        self._physics = physics
        self._members = members
        self._skin = skin
        self._hands = hands
        self._own_or_soft = np.append(members[physics.mj_model.geom_bodyid], False)  # the last: soft objects, whose geom is -1

    def held(self) -> list[int]:
        """Returns the geoms of the objects that the body holds."""
        return [geom for hand in self._hands for geom in hand.geoms] if self._physics.grasped else []

    def own_geoms(self) -> NDArray[np.bool_]:
        """Returns by geom of the world (ngeom,) whether it is part of the body or held by it."""
        own: NDArray[np.bool_] = self._members[self._physics.mj_model.geom_bodyid]
        own[self.held()] = True
        return own

    def none(self) -> bool:
        """Returns whether neither the body nor an object that it holds touches anything else, at the present positions."""
        self._physics.refresh_contacts()
        if self._physics.mj_data.ncon == 0:
            return True
        sides = self._sides(self.own_geoms())
        return not np.any(sides[:, 0] != sides[:, 1])

    def any_in_step(self, apart_from: NDArray[np.bool_] | None = None) -> bool:
        """Returns whether anything touched the body in the last physics step.

        Args:
            apart_from: By geom, whether its contacts do not count, `(ngeom + 1,)`; the last entry is for soft objects. None: all count.
        """
        own, held = self._own_or_soft, self.held()
        if held:
            own = own.copy()
            own[held] = True
        pairs = self._physics.mj_data.contact.geom
        one, other = own[pairs].T
        touching = one != other
        return bool((touching if apart_from is None else touching & ~apart_from[pairs].any(axis=1)).any())

    def touches(self) -> tuple[Touch, ...]:
        """Returns the touches of the solver's last result, sorted by name. For observers of single physics steps."""
        model, data = self._physics.mj_model, self._physics.mj_data
        if data.ncon == 0:
            return ()
        pairs: NDArray[np.int32] = data.contact.geom
        own = self._members[model.geom_bodyid]
        sides = self._sides(own)
        held = set(self.held())
        if held:  # contacts of a held object count as the body's, except those with the hand that holds it
            sides = np.where(sides.any(axis=1, keepdims=True), sides, self._sides(self.own_geoms() & ~own))
        forces: defaultdict[tuple[str, str], float] = defaultdict(float)
        wrench: NDArray[np.float64] = np.zeros(6)
        for number in np.flatnonzero(sides[:, 0] != sides[:, 1]).tolist():
            side = 0 if sides[number, 0] else 1
            geom = int(pairs[number, side])
            if (geom in self._skin or geom in held) and data.contact.dist[number] <= 0:
                mujoco.mj_contactForce(model, data, number, wrench)
                part = self._physics.owners[geom] if geom in held else self._skin[geom]
                forces[part, self._physics.other_side(number, 1 - side)] += float(wrench[0])
        return tuple(Touch(part=part, other=other, force=force) for (part, other), force in sorted(forces.items()))

    def _sides(self, own: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Returns for each contact which of its two sides (n, 2) are the body's, given which geoms are; soft objects have none."""
        contact = self._physics.mj_data.contact
        soft = self._members[self._physics.soft][contact.flex] if len(self._physics.soft) else False
        return np.where(contact.geom >= 0, own[contact.geom], soft)
