"""The body schema: what is felt of the joints, and postures with the size felt in them, as chunks for declarative memory."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from actr3d.motor.limbs import BodyPart, DegreeOfFreedom, Limbs, on_grid
from actr3d.world.command_registry import checked_name

AWAY, AWAY_SLIDE = 5.0, 0.01
"""Displacement from the first felt position above which a posture also includes a joint that it does not always include: of a hinge
[degrees], of a slide [m]. Source: chosen; limbs that hold still while others swing yield by about a degree."""


class BodySchema:
    """Stores the felt positions of the joints, and makes posture chunks from them.

    All numbers in chunks are rounded to a grid; otherwise no posture would ever occur twice and merge.

    A posture has a slot for each joint that the body's named movements turn to any angle (without such movements, for
    each joint), and one for every other joint that is away from its start.

    Args:
        limbs: The body.
        positions: By joint, its first felt position [rad] or [m].
        angle_grid: Step to which angles are rounded [degrees].
        size_grid: Step to which lengths are rounded [m].
        step: Distance beyond the former extreme that makes a new one [degrees]; None for never.
        slide: The same for slides [m].
    """

    def __init__(
        self,
        limbs: Limbs,
        positions: Mapping[str, float],
        *,
        angle_grid: float,
        size_grid: float,
        step: float | None,
        slide: float | None,
    ) -> None:
        self.limbs = limbs
        self._size_grid = size_grid
        self._grids = {joint: angle_grid if plan.kind == "hinge" else size_grid for joint, plan in limbs.joints.items()}
        steps = {"hinge": math.inf if step is None else step, "slide": math.inf if slide is None else slide}
        self._steps = {joint: steps[plan.kind] * limbs.unit[joint] for joint, plan in limbs.joints.items()}
        named = {joint for movement in limbs.plan.movements if movement.to is None for joint, _ in movement.joints}
        self._always = [joint for joint in limbs.order if joint in named or not named]
        self._first = dict(positions)
        self.felt = positions
        """By joint, its felt position [rad] or [m]."""
        self.minimum, self.maximum = dict(positions), dict(positions)
        """By joint, the minimum and maximum of its felt positions."""
        self._start = {joint: self.shown(joint, positions[joint]) for joint in limbs.order}
        self.at = dict(self._start)
        """By joint, its felt position on the grid."""
        self._from, self._to = dict(positions), dict(positions)
        """By joint, the least and the greatest of its felt positions since the one on the grid last changed."""
        self._least, self._most = dict(positions), dict(positions)
        """By joint, the least and the greatest of its positions in the postures that were stored."""

    def feel(self, positions: Mapping[str, float]) -> Sequence[str]:
        """Updates the felt positions of all joints [rad] or [m], given in the order of the body, and their values on the grid.

        A position between two felt ones with the same grid value has that value too, and is no new extreme.

        Returns:
            The joints whose position is outside the range of felt positions with the same grid value.
        """
        least, most = self._from, self._to
        known = zip(positions, least.values(), positions.values(), most.values(), strict=True)
        new = tuple([joint for joint, low, at, high in known if not low <= at <= high])
        self.felt = positions
        for joint in new:
            at = positions[joint]
            if at < self.minimum[joint]:
                self.minimum[joint] = at
            elif at > self.maximum[joint]:
                self.maximum[joint] = at
            shown = self.shown(joint, at)
            if shown != self.at[joint]:
                least[joint] = most[joint] = at
                self.at[joint] = shown
            elif at < least[joint]:
                least[joint] = at
            else:
                most[joint] = at
        return new

    def shown(self, joint: str, position: float) -> float:
        """Returns a joint's position on the grid: degrees, or metres for a slide."""
        return on_grid(position / self.limbs.unit[joint], self._grids[joint])

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
            self.minimum[joint], self.maximum[joint] = min(self.minimum[joint], at), max(self.maximum[joint], at)
        felt, on_the_grid = self.felt, self.at
        self.felt = {**felt, **positions}
        self.at = {**on_the_grid, **{joint: self.shown(joint, at) for joint, at in positions.items()}}
        try:
            chunk = self.posture(name, "done", next(iter(positions)), box)
            self.note(positions)
        finally:
            self.felt, self.at = felt, on_the_grid
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
            ends = {"maximum": self.shown(joint, self.maximum[joint]), "minimum": self.shown(joint, self.minimum[joint])}
            extreme = next((which for which, end_at in ends.items() if at[joint] == end_at != self._start[joint]), "none")
            self.note((joint,))
        angles = {of: value for of, value in at.items() if of in self._always or self._away(of)}
        return {"posture": name, "end": end, "extreme": extreme, **angles, **box}

    def _away(self, joint: str) -> bool:
        limbs = self.limbs
        away = AWAY * limbs.unit[joint] if limbs.joints[joint].kind == "hinge" else AWAY_SLIDE
        return abs(self.felt[joint] - self._first[joint]) > away

    def extremes(self, joints: Iterable[str]) -> tuple[str, ...]:
        """Returns the joints that are at least one step beyond their extremes in all earlier postures."""
        further: list[str] = []
        for joint in joints:
            at = self.felt[joint]
            step = self._steps[joint]
            if at >= self._most[joint] + step or at <= self._least[joint] - step:
                further.append(joint)
        return tuple(further)

    def note(self, joints: Iterable[str]) -> None:
        """Updates the extremes of some joints with their present positions."""
        for joint in joints:
            at = self.felt[joint]
            self._least[joint] = min(self._least[joint], at)
            self._most[joint] = max(self._most[joint], at)

    def degree_of_freedom(self, joint: str) -> DegreeOfFreedom:
        """Returns the present knowledge of a joint.

        Raises:
            WorldError: If the body has no such joint.
        """
        limbs = self.limbs
        plan = limbs.joints[checked_name(joint, limbs.joints, limbs.plan.name, "joint")]
        return DegreeOfFreedom(
            name=joint,
            axis=plan.axis,
            lower=plan.lower,
            upper=plan.upper,
            angle=self.felt[joint],
            minimum=self.minimum[joint],
            maximum=self.maximum[joint],
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
