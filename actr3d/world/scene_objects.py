"""The simple objects of a scene: floor, walls, apertures, tracks, loose objects."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, MinLen
from mujoco import MjModel, MjSpec, mjtGeom

from actr3d.configuration import Configuration, InRadians
from actr3d.errors import ConfigurationError
from actr3d.world.frames import FULL_TURN, wrapped, yaw_quaternion

Name = Annotated[str, MinLen(1)]
Length = Annotated[float, Gt(0)]
Positive = Annotated[float, Gt(0)]
Heading = Annotated[float, Ge(-FULL_TURN), Le(FULL_TURN), InRadians()]
Colour = tuple[float, float, float, float]

SHAPES = {
    "box": (mjtGeom.mjGEOM_BOX, 3, "length, width and height"),
    "sphere": (mjtGeom.mjGEOM_SPHERE, 1, "the radius"),
    "ellipsoid": (mjtGeom.mjGEOM_ELLIPSOID, 3, "three radii"),
    "cylinder": (mjtGeom.mjGEOM_CYLINDER, 2, "radius and height"),
    "capsule": (mjtGeom.mjGEOM_CAPSULE, 2, "radius and height without the round ends"),
}
"""By shape: MuJoCo's type, the number of sizes, and their meaning."""

SHARPEST = math.radians(150)
"""Greatest turn of a track at a point [rad]: the corner of its outer line is four times as far away as the line. Source: chosen."""

LEAST_SIZE, LEAST_MASS = 1e-4, 1e-6
"""Least size [m] and mass [kg] of a loose object: MuJoCo needs an inertia of at least 1e-15 kg m^2, which any shape of these has."""

WALL_SOLREF = (5e-4, 1.0)
"""Stiffness of a wall's contacts: (time constant [s], damping ratio). MuJoCo raises the time constant to at least twice the physics
step, the stiffest that it simulates faithfully, so in effect this is twice any step: 4 ms at 2 ms, which keeps a body that runs into
a wall at 3 m/s within millimetres of its surface."""


@dataclass(frozen=True, kw_only=True)
class Floor(Configuration):
    """The ground: an endless plane at z = 0, with a spotlight above the origin."""

    name: Name = "floor"
    """Its name in the scene."""

    colour: Colour = (0.82, 0.83, 0.85, 1.0)
    """Red, green, blue, alpha in 0 to 1."""

    def add_to(self, mj_spec: MjSpec) -> None:
        """Adds the plane and the light."""
        mj_spec.worldbody.add_geom(name=self.name, type=mjtGeom.mjGEOM_PLANE, size=[0, 0, 0.05], rgba=self.colour)
        mj_spec.worldbody.add_light(name=f"{self.name}_light", pos=[0, 0, 6], dir=[0, 0, -1])


@dataclass(frozen=True, kw_only=True)
class Wall(Configuration):
    """A straight wall on the floor between two points."""

    name: Name
    """Its name in the scene."""

    start: tuple[float, float]
    """Start of its middle line, (x, y) [m]."""

    end: tuple[float, float]
    """End of its middle line, (x, y) [m]."""

    height: Length = 2.5
    """[m]"""

    thickness: Length = 0.1
    """[m]"""

    colour: Colour = (0.75, 0.71, 0.66, 1.0)
    """Red, green, blue, alpha in 0 to 1."""

    def __post_init__(self) -> None:
        """Checks the fields.

        Raises:
            ConfigurationError: If a field is wrong, or the wall has no length.
        """
        super().__post_init__()
        if math.dist(self.start, self.end) == 0:
            raise ConfigurationError(f"Wall '{self.name}': start and end are the same point {self.start}")

    def add_to(self, mj_spec: MjSpec) -> None:
        """Adds a body with one box, which only a user can move."""
        (x1, y1), (x2, y2) = self.start, self.end
        body = mj_spec.worldbody.add_body(
            name=self.name,
            pos=[(x1 + x2) / 2, (y1 + y2) / 2, self.height / 2],
            quat=yaw_quaternion(math.atan2(y2 - y1, x2 - x1)),
            mocap=True,
        )
        size = [math.dist(self.start, self.end) / 2, self.thickness / 2, self.height / 2]
        body.add_geom(name=self.name, type=mjtGeom.mjGEOM_BOX, size=size, rgba=self.colour, solref=WALL_SOLREF)


@dataclass(frozen=True)
class Gap:
    """The place of an aperture in a compiled scene."""

    position: tuple[float, float]
    """The middle of the gap on the floor, (x, y) [m]."""
    heading: float
    """The direction in which one walks through it [rad]."""
    thickness: float
    """The thickness of the wall [m]."""
    segments: tuple[int, int]
    """The geoms to the left and to the right of the gap."""


@dataclass(frozen=True, kw_only=True)
class Aperture(Configuration):
    """A doorway: the gap between two wall segments in one line. Its width can be set before and during a run."""

    name: Name = "aperture"
    """Its name in the scene; the segments are `<name>_left` and `<name>_right`, as seen when walking along `heading`."""

    width: Annotated[float, Ge(0)] = 0.8
    """The free width between the segments [m]; 0 is a closed wall."""

    position: tuple[float, float] = (7.0, 0.0)
    """The middle of the gap on the floor, (x, y) [m]. Source of the default: 7 m of approach, as in the original (docs/human-data.md)."""

    heading: Heading = 0.0
    """The direction in which one walks through it [rad], 0 along x."""

    closing: Annotated[float, Ge(0)] = 0.0
    """How fast it closes from the start on [m/s]. An object that only one segment touches is pushed aside; an object between both segments
    stops the closing."""

    segment: Length = 2.5
    """Length of each wall segment [m]. Segments keep their length and slide when the width changes."""

    height: Length = 2.5
    """[m]"""

    thickness: Length = 0.1
    """[m]"""

    colour: Colour = (0.75, 0.71, 0.66, 1.0)
    """Red, green, blue, alpha in 0 to 1."""

    def add_to(self, mj_spec: MjSpec) -> None:
        """Adds the two segments, as mocap bodies, whose positions are part of the physics state."""
        for side, position in self.segment_positions(self.width).items():
            body = mj_spec.worldbody.add_body(name=f"{self.name}_{side}", pos=position, quat=yaw_quaternion(self.heading), mocap=True)
            size = [self.thickness / 2, self.segment / 2, self.height / 2]
            name = f"{self.name}_{side}"
            body.add_geom(name=name, type=mjtGeom.mjGEOM_BOX, size=size, rgba=self.colour, solref=WALL_SOLREF)

    def segment_positions(self, width: float) -> dict[str, tuple[float, float, float]]:
        """Returns the centres of the segments for a free width [m]: {side: (x, y, z)} in the world frame [m]."""
        reach = (width + self.segment) / 2
        (x, y), z = self.position, self.height / 2
        left = (-math.sin(self.heading) * reach, math.cos(self.heading) * reach)
        return {"left": (x + left[0], y + left[1], z), "right": (x - left[0], y - left[1], z)}

    def gap_in(self, mj_model: MjModel) -> Gap:
        """Returns the place of the aperture in a compiled scene."""
        left, right = (int(mj_model.geom(f"{self.name}_{side}").id) for side in ("left", "right"))
        return Gap(self.position, self.heading, self.thickness, (left, right))

    def width_of(self, left: tuple[float, float, float]) -> float:
        """Returns the free width [m] when the left segment's centre is at `left`."""
        return 2 * math.dist(self.position, left[:2]) - self.segment


@dataclass(frozen=True, kw_only=True)
class Track(Configuration):
    """Two lines on the floor to drive or walk between. Visible, without contact."""

    name: Name = "track"
    """Its name in the scene; the lines are `<name>_0`, `<name>_1`, … along each side."""

    points: Annotated[tuple[tuple[float, float], ...], MinLen(2)]
    """The middle line, (x, y) points in order [m]."""

    width: Length = 3.0
    """Between the middles of the lines [m]. Source of the default: a usual lane of a rural road."""

    line: Length = 0.1
    """Width of a painted line [m]."""

    colour: Colour = (0.95, 0.95, 0.95, 1.0)
    """Red, green, blue, alpha in 0 to 1."""

    def __post_init__(self) -> None:
        """Checks the fields.

        Raises:
            ConfigurationError: If a field is wrong, two points in a row are the same, or a corner is too sharp.
        """
        super().__post_init__()
        for n, (one, other) in enumerate(pairwise(self.points)):
            if one == other:
                raise ConfigurationError(f"Track '{self.name}'.points: the points {n} and {n + 1} are the same, {one}")
        for n, (before, after) in enumerate(pairwise(self._headings()), start=1):
            turn = abs(wrapped(after - before))
            if turn > SHARPEST:
                most, got = math.degrees(SHARPEST), math.degrees(turn)
                raise ConfigurationError(
                    f"Track '{self.name}'.points: must turn by <= {most:g} degrees at a point (got {got:.0f} at point {n})"
                )

    def add_to(self, mj_spec: MjSpec) -> None:
        """Adds one thin box for each piece of each line, all in one fixed body."""
        body = mj_spec.worldbody.add_body(name=self.name)
        sides = (self._offset(self.width / 2), self._offset(-self.width / 2))
        pieces = [(a, b) for side in sides for a, b in pairwise(side)]
        for number, ((x1, y1), (x2, y2)) in enumerate(pieces):
            body.add_geom(
                name=f"{self.name}_{number}",
                type=mjtGeom.mjGEOM_BOX,
                pos=[(x1 + x2) / 2, (y1 + y2) / 2, 0.002],
                quat=yaw_quaternion(math.atan2(y2 - y1, x2 - x1)),
                size=[math.dist((x1, y1), (x2, y2)) / 2, self.line / 2, 0.002],
                rgba=self.colour,
                contype=0,
                conaffinity=0,
            )

    def _offset(self, by: float) -> list[tuple[float, float]]:
        """Returns the line beside the middle one, at this distance from each of its pieces; at a corner it turns on the bisector."""
        headings = self._headings()
        line: list[tuple[float, float]] = []
        for (x, y), before, after in zip(self.points, [headings[0], *headings], [*headings, headings[-1]], strict=True):
            half = wrapped(after - before) / 2
            heading, away = before + half, by / math.cos(half)
            line.append((x - math.sin(heading) * away, y + math.cos(heading) * away))
        return line

    def _headings(self) -> list[float]:
        """Returns the direction of each piece of the middle line [rad]."""
        return [math.atan2(y2 - y1, x2 - x1) for (x1, y1), (x2, y2) in pairwise(self.points)]


@dataclass(frozen=True, kw_only=True)
class SimpleObject(Configuration):
    """An object of a simple shape that can be pushed and falls; or a fixed one."""

    name: Name
    """Its name in the scene."""

    shape: Literal["box", "sphere", "ellipsoid", "cylinder", "capsule"] = "box"
    """Its shape."""

    size: tuple[Length, ...] = (0.3, 0.3, 0.3)
    """Full sizes [m]: box (length, width, height); cylinder and capsule (radius, height); sphere (radius,); ellipsoid three radii."""

    position: tuple[float, float, float] = (2.0, 0.0, 0.5)
    """Its centre at the start, (x, y, z) [m]."""

    heading: Heading = 0.0
    """Its rotation about the vertical at the start [rad]."""

    mass: Positive | None = 1.0
    """[kg]; None fixes it in its place."""

    colour: Colour = (0.55, 0.62, 0.72, 1.0)
    """Red, green, blue, alpha in 0 to 1."""

    def __post_init__(self) -> None:
        """Checks the fields.

        Raises:
            ConfigurationError: If a field is wrong, the number of sizes is wrong for the shape, or a size or the mass is too small.
        """
        super().__post_init__()
        _, sizes, meaning = SHAPES[self.shape]
        if len(self.size) != sizes:
            raise ConfigurationError(f"SimpleObject '{self.name}'.size: a {self.shape} takes {meaning} (got {self.size!r})")
        if min(self.size) < LEAST_SIZE:
            raise ConfigurationError(f"SimpleObject '{self.name}'.size: must be >= {LEAST_SIZE:g} m (got {self.size!r})")
        if self.mass is not None and self.mass < LEAST_MASS:
            raise ConfigurationError(f"SimpleObject '{self.name}'.mass: must be >= {LEAST_MASS:g} kg (got {self.mass!r})")

    def add_to(self, mj_spec: MjSpec) -> None:
        """Adds a body with one geom, and a free joint unless it is fixed: then only a user can move it."""
        fixed = self.mass is None
        body = mj_spec.worldbody.add_body(name=self.name, pos=self.position, quat=yaw_quaternion(self.heading), mocap=fixed)
        if not fixed:
            body.add_freejoint(name=self.name)
        kind, _, _ = SHAPES[self.shape]
        body.add_geom(name=self.name, type=kind, size=half_sizes(self.shape, self.size), rgba=self.colour, mass=self.mass or 0)


def half_sizes(shape: str, size: tuple[float, ...]) -> list[float]:
    """Returns MuJoCo's sizes (3,) of a shape [m], which are half lengths, from full ones."""
    match shape:
        case "box":
            halves = [length / 2 for length in size]
        case "cylinder" | "capsule":
            halves = [size[0], size[1] / 2]
        case _:
            halves = list(size)
    return halves + [0.0] * (3 - len(halves))
