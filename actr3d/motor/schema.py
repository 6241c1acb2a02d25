"""The body schema: postures with the size felt in them, as chunks for declarative memory."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from actr3d.motor.limbs import Limbs, on_grid

AWAY, AWAY_SLIDE = 5.0, 0.01
"""Displacement from the first felt position above which a posture also includes a joint that it does not always include: of a hinge
[degrees], of a slide [m]. Source: chosen; limbs that hold still while others swing yield by about a degree."""


class BodySchema:
    """Makes posture chunks from felt values. All numbers are rounded to a grid; otherwise no posture would ever occur twice and merge.

    A posture has a slot for each joint that the body's named movements turn to any angle (without such movements, for
    each joint), and one for every other joint that is away from its start.

    Args:
        limbs: The body, felt at the start.
        angle_grid: Step to which angles are rounded [degrees].
        size_grid: Step to which lengths are rounded [m].
        step: Distance beyond the former extreme that makes a new one [degrees]; None for never.
        slide: The same for slides [m].
    """

    def __init__(self, limbs: Limbs, angle_grid: float, size_grid: float, step: float | None, slide: float | None) -> None:
        self._limbs = limbs
        self._size_grid = size_grid
        self._grids = {joint: angle_grid if plan.kind == "hinge" else size_grid for joint, plan in limbs.joints.items()}
        steps = {"hinge": math.inf if step is None else step, "slide": math.inf if slide is None else slide}
        self._steps = {joint: steps[plan.kind] * limbs.unit[joint] for joint, plan in limbs.joints.items()}
        named = {joint for movement in limbs.plan.movements if movement.to is None for joint, _ in movement.joints}
        self._always = [joint for joint in limbs.order if joint in named or not named]
        self._first = dict(limbs.felt)
        self._start = {joint: self.shown(joint, limbs.felt[joint]) for joint in limbs.order}
        self.at = dict(self._start)
        """By joint, its felt position on the grid."""
        self._from, self._to = dict(limbs.felt), dict(limbs.felt)
        """By joint, the least and the greatest of its felt positions since the one on the grid last changed."""
        self._least, self._most = dict(limbs.felt), dict(limbs.felt)

    def feel(self, positions: Mapping[str, float]) -> Sequence[str]:
        """Updates the felt positions of some joints [rad] or [m], and their values on the grid.

        A position between two felt ones with the same grid value has that value too, and is no new extreme.

        Returns:
            The joints whose position is outside the range of felt positions with the same grid value.
        """
        least, most = self._from, self._to
        new = {joint: at for joint, at in positions.items() if not least[joint] <= at <= most[joint]}
        self._limbs.felt.update(positions)
        self._limbs.feel(new)
        for joint, at in new.items():
            shown = self.shown(joint, at)
            if shown != self.at[joint]:
                least[joint] = most[joint] = at
                self.at[joint] = shown
            elif at < least[joint]:
                least[joint] = at
            else:
                most[joint] = at
        return tuple(new)

    def shown(self, joint: str, position: float) -> float:
        """Returns a joint's position on the grid: degrees, or metres for a slide."""
        return on_grid(position / self._limbs.unit[joint], self._grids[joint])

    def size(self, length: float) -> float:
        """Returns a length on the grid [m]."""
        return on_grid(length, self._size_grid)

    def posture(self, name: str, end: str, joint: str | None, box: dict[str, Any]) -> dict[str, Any]:
        """Returns the present posture as a chunk.

        Args:
            name: The movement that led here, or another name.
            end: How the movement ended.
            joint: The joint that moved: the slot `extreme` shows whether this is its extreme.
            box: The felt width, depth, height and middle.
        """
        limbs = self._limbs
        at = self.at
        extreme = "none"
        if joint is not None:
            ends = {"maximum": self.shown(joint, limbs.maximum[joint]), "minimum": self.shown(joint, limbs.minimum[joint])}
            extreme = next((which for which, end_at in ends.items() if at[joint] == end_at != self._start[joint]), "none")
            self.note((joint,))
        angles = {of: value for of, value in at.items() if of in self._always or self._away(of)}
        return {"posture": name, "end": end, "extreme": extreme, **angles, **box}

    def _away(self, joint: str) -> bool:
        limbs = self._limbs
        away = AWAY * limbs.unit[joint] if limbs.joints[joint].kind == "hinge" else AWAY_SLIDE
        return abs(limbs.felt[joint] - self._first[joint]) > away

    def extremes(self, joints: Iterable[str]) -> tuple[str, ...]:
        """Returns the joints that are at least one step beyond their extremes in all earlier postures."""
        limbs = self._limbs
        further: list[str] = []
        for joint in joints:
            at = limbs.felt[joint]
            step = self._steps[joint]
            if at >= self._most[joint] + step or at <= self._least[joint] - step:
                further.append(joint)
        return tuple(further)

    def note(self, joints: Iterable[str]) -> None:
        """Updates the extremes of some joints with their present positions."""
        for joint in joints:
            at = self._limbs.felt[joint]
            self._least[joint] = min(self._least[joint], at)
            self._most[joint] = max(self._most[joint], at)
