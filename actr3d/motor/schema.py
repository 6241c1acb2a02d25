"""The body schema: what is felt of the joints, and postures with the size felt in them, as chunks for declarative memory."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from actr3d.motor.kernel import GRID, HIGH, LEAST, LOW, MAXIMUM, MINIMUM, MOST, PLACE, STEP, UNIT, note_felt
from actr3d.motor.limbs import BodyPart, DegreeOfFreedom, Limbs, on_grid
from actr3d.world.command_registry import checked_name

AWAY, AWAY_SLIDE = 5.0, 0.01
"""Displacement from the first felt position above which a posture also includes a joint that it does not always include: of a hinge
[degrees], of a slide [m]. Source: chosen; limbs that hold still while others swing yield by about a degree."""


SIZES = ("width", "depth", "height", "middle")
"""The felt sizes of the body."""

OTHER_SLOTS = ("posture", "end", "extreme", *SIZES)
"""The slots of a posture that are not joints."""


class BodySchema:
    """Stores the felt positions of the joints and the felt sizes of the body, and makes posture chunks from them.

    All numbers in chunks are rounded to a grid; otherwise no posture would ever occur twice and merge.

    A posture has a slot for each joint that the body's named movements turn to any angle (without such movements, for
    each joint), and one for every other joint that is away from its start.

    Args:
        limbs: The body.
        positions: The first felt positions of the joints, in the order of the body [rad] or [m].
        sizes: The first felt sizes, in the order of `SIZES` [m].
        angle_grid: Step to which angles are rounded [degrees].
        size_grid: Step to which lengths are rounded [m].
        step: Distance beyond the former extreme that makes a new one [degrees]; None for never.
        slide: The same for slides [m].
    """

    def __init__(
        self,
        limbs: Limbs,
        positions: Sequence[float],
        sizes: Sequence[float],
        *,
        angle_grid: float,
        size_grid: float,
        step: float | None,
        slide: float | None,
    ) -> None:
        self.limbs = limbs
        self._size_grid = size_grid
        self._number = {joint: number for number, joint in enumerate(limbs.order)}
        named = {joint for movement in limbs.plan.movements if movement.to is None for joint, _ in movement.joints}
        self._always = [joint for joint in limbs.order if joint in named or not named]
        angle = angle_grid, math.inf if step is None else step
        length = size_grid, math.inf if slide is None else slide
        units = [limbs.unit[joint] for joint in limbs.order]
        steps = [angle if limbs.joints[joint].kind == "hinge" else length for joint in limbs.order]
        felt = [*positions, *sizes]
        self._rows = rows = np.empty((10, len(felt)))
        """Of each joint and each size, see `actr3d.motor.kernel`."""
        rows[UNIT] = [*units, *[1.0] * len(SIZES)]
        rows[GRID] = [*[grid for grid, _ in steps], *[size_grid] * len(SIZES)]
        rows[STEP] = [*[step * unit for (_, step), unit in zip(steps, units, strict=True)], *[math.inf] * len(SIZES)]
        rows[[LOW, HIGH, MINIMUM, MAXIMUM, LEAST, MOST]] = felt
        rows[PLACE] = np.rint(rows[LOW] / rows[UNIT] / rows[GRID])
        self._new = np.empty(len(felt), dtype=np.intp)
        self._first = self._felt = positions
        self._start = {joint: self.shown(joint, at) for joint, at in zip(limbs.order, positions, strict=True)}
        self.at = dict(self._start)
        """By joint, its felt position on the grid."""
        self.box = {name: self.size(size) for name, size in zip(SIZES, sizes, strict=True)}
        """By name, the felt sizes on the grid [m]."""

    def feel(self, positions: Sequence[float], sizes: Sequence[float]) -> tuple[Sequence[str], Sequence[str]]:
        """Updates what is felt, in the order of the body and of `SIZES` [rad] or [m], and the values on the grid.

        Returns:
            The joints whose value on the grid has changed, or that are at least one step beyond their extremes in all earlier postures; and
            the sizes whose value on the grid has changed.
        """
        self._felt = positions
        count = note_felt()(np.array((*positions, *sizes)), self._rows, self._new)
        joints: list[str] = []
        changed: list[str] = []
        numbers: list[int] = self._new[:count].tolist()
        for number in numbers:
            if number < len(positions):
                joint = self.limbs.order[number]
                joints.append(joint)
                self.at[joint] = self.shown(joint, positions[number])
            else:
                number -= len(positions)
                changed.append(SIZES[number])
                self.box[SIZES[number]] = self.size(sizes[number])
        return joints, changed

    def felt(self, joint: str) -> float:
        """Returns the felt position of a joint [rad] or [m]."""
        return self._felt[self._number[joint]]

    def shown(self, joint: str, position: float) -> float:
        """Returns a joint's position on the grid: degrees, or metres for a slide."""
        return on_grid(position / self.limbs.unit[joint], self._rows.item(GRID, self._number[joint]))

    def size(self, length: float) -> float:
        """Returns a length on the grid [m]."""
        return on_grid(length, self._size_grid)

    def known(self, name: str, positions: Mapping[str, float], box: dict[str, Any]) -> dict[str, Any]:
        """Returns a posture that the agent knows as a chunk, as if a movement of its first joint had ended there.

        Args:
            name: The movement.
            positions: By joint, its position there [rad] or [m]; the other joints are as they are now.
            box: As for `posture`.
        """
        for joint, at in positions.items():
            number = self._number[joint]
            self._rows[MINIMUM, number] = min(self._rows[MINIMUM, number], at)
            self._rows[MAXIMUM, number] = max(self._rows[MAXIMUM, number], at)
        felt, on_the_grid = self._felt, self.at
        self._felt = [positions.get(joint, at) for joint, at in zip(self.limbs.order, felt, strict=True)]
        self.at = {**on_the_grid, **{joint: self.shown(joint, at) for joint, at in positions.items()}}
        try:
            chunk = self.posture(name, "done", next(iter(positions)), box)
            self.note(positions)
        finally:
            self._felt, self.at = felt, on_the_grid
        return chunk

    def posture(self, name: str, end: str, joint: str | None, box: dict[str, Any]) -> dict[str, Any]:
        """Returns the present posture as a chunk.

        Args:
            name: The movement that led here, or another name.
            end: How the movement ended.
            joint: The joint that moved: the slot `extreme` shows whether this is its extreme.
            box: The felt width, depth, height and middle.
        """
        at = self.at
        extreme = "none"
        if joint is not None:
            minimum, maximum = self._extremes(joint)
            ends = {"maximum": self.shown(joint, maximum), "minimum": self.shown(joint, minimum)}
            extreme = next((which for which, end_at in ends.items() if at[joint] == end_at != self._start[joint]), "none")
            self.note((joint,))
        angles = {of: value for of, value in at.items() if of in self._always or self._away(of)}
        return {"posture": name, "end": end, "extreme": extreme, **angles, **box}

    def _away(self, joint: str) -> bool:
        limbs = self.limbs
        away = AWAY * limbs.unit[joint] if limbs.joints[joint].kind == "hinge" else AWAY_SLIDE
        return abs(self.felt(joint) - self._first[self._number[joint]]) > away

    def _extremes(self, joint: str) -> tuple[float, float]:
        """Returns the minimum and maximum of the felt positions of a joint [rad] or [m]."""
        number = self._number[joint]
        return self._rows.item(MINIMUM, number), self._rows.item(MAXIMUM, number)

    def extremes(self, joints: Iterable[str]) -> tuple[str, ...]:
        """Returns the joints that are at least one step beyond their extremes in all earlier postures."""
        further: list[str] = []
        for joint in joints:
            number = self._number[joint]
            at, step = self._felt[number], self._rows.item(STEP, number)
            if at >= self._rows.item(MOST, number) + step or at <= self._rows.item(LEAST, number) - step:
                further.append(joint)
        return tuple(further)

    def note(self, joints: Iterable[str]) -> None:
        """Updates the extremes of some joints with their present positions."""
        for joint in joints:
            number = self._number[joint]
            self._rows[LEAST, number] = min(self._rows[LEAST, number], self._felt[number])
            self._rows[MOST, number] = max(self._rows[MOST, number], self._felt[number])

    def degree_of_freedom(self, joint: str) -> DegreeOfFreedom:
        """Returns the present knowledge of a joint.

        Raises:
            WorldError: If the body has no such joint.
        """
        limbs = self.limbs
        plan = limbs.joints[checked_name(joint, limbs.joints, limbs.plan.name, "joint")]
        minimum, maximum = self._extremes(joint)
        return DegreeOfFreedom(
            name=joint,
            axis=plan.axis,
            lower=plan.lower,
            upper=plan.upper,
            angle=self.felt(joint),
            minimum=minimum,
            maximum=maximum,
            driven=plan.driven,
        )

    def tree(self) -> BodyPart:
        """Returns the present knowledge of all parts, from the base on."""
        plan = self.limbs.plan
        made: dict[str, BodyPart] = {}
        for part in reversed(plan.parts):
            carried = tuple(made[other.name] for other in plan.parts if other.on == part.name)
            joints = tuple(self.degree_of_freedom(joint.name) for joint in part.joints)
            made[part.name] = BodyPart(name=part.name, joints=joints, parts=carried)
        return made[plan.parts[0].name]
