"""How a mannequin is put together from MuJoCo's elements."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from mujoco import MjSpec, mjtEq, mjtGeom, mjtJoint, mjtObj

from actr3d.world.bodies.base import add_base
from actr3d.world.bodies.limits import limits_of, strength_of
from actr3d.world.parts import WALL_SOLREF
from actr3d.world.servo import add_servo

if TYPE_CHECKING:
    from actr3d.world.bodies.mannequin import Mannequin

SIDES = ("left", "right")
HINGES = ("yaw", "pitch", "roll")
HINGED = (
    *("pelvis", "torso", "head", "eye"),
    *(f"{side}_{part}" for part in ("shoulder", "upper_arm") for side in SIDES),
)
"""The segments that hang on three hinges."""

LEG, FOOT = 0.161, 0.0145
"""The mass of a leg with its foot, and of the foot, as parts of the whole."""

CLEARANCE = 0.005
"""Between the legs and the floor [m], so that gliding meets no friction."""

BRISKNESS = 100.0
"""How fast its full strength can speed up a joint [rad/s^2], from which its armature follows: inertia against the segment that
carries it. With less of it, thin limbs on strong joints rattle for ever once a shove has set them off. Ours."""

AHEAD = 0.002
"""From the front of the eye to where it sees from [m], so that its own ball is not in the way."""

TURN = 150.0
"""The most the legs turn the body with [N m]. Ours, of the order of a trunk's rotation."""

SHOULDER, UPPER_ARM = 0.818, 0.186 / 0.44
"""How high the shoulder joints are, as a part of the height, and how long the upper arm is, as one of the arm."""

Point = tuple[float, float, float]
_AXES = {"yaw": (0, 0, 1), "pitch": (0, 1, 0), "roll": (1, 0, 0)}


class Limbs:
    """Builds one mannequin. Heights below are fractions of its height, from the source that `Mannequin` names."""

    def __init__(self, person: Mannequin, mj_spec: MjSpec) -> None:
        self.person = person
        self.mj_spec = mj_spec
        self.bodies: dict[str, tuple[Any, Point]] = {}
        tall = person.height
        self.deltoid = min(0.035 * tall, person.shoulder_width / 4)
        self.shoulder_y = person.shoulder_width / 2 - self.deltoid
        self.shoulder_z = SHOULDER * tall
        self.upper, self.fore, self.hand = (person.arms * part for part in (UPPER_ARM, 0.146 / 0.44, 0.108 / 0.44))

    def build(self) -> None:
        """Adds everything to the specification."""
        person, tall = self.person, self.person.height
        self._base()
        self._segment("pelvis", self._legs(), (0, 0, 0.53 * tall))
        self._trunk("pelvis", 0.50, 0.64, min(0.191 * tall, person.shoulder_width), 0.142)
        self._segment("torso", "pelvis", (0, 0, 0.60 * tall))
        width = 0.191 * tall if person.trunk == "ellipsoid" else 2 * self.shoulder_y
        self._trunk("torso", 0.58, 0.85, min(width, 2 * self.shoulder_y), 0.325)
        for side, sign in zip(SIDES, (1, -1), strict=True):
            self._shoulder(side, sign)
            self._arm(side, sign)
        self._head()
        if person.load is not None:
            self._load()
        for one, other in combinations(self.bodies, 2):
            # Its limbs are not in each other's way, but the trunk stops what presses the load back.
            if (one, other) not in (("pelvis", "load"), ("torso", "load")):
                self.mj_spec.add_exclude(bodyname1=self.bodies[one][0].name, bodyname2=self.bodies[other][0].name)
        self._servos()

    def _name(self, part: str) -> str:
        return f"{self.person.name}_{part}"

    def _base(self) -> None:
        """Adds what slides along the world's x and y and turns about the vertical, and is to carry all the rest."""
        person = self.person
        body = add_base(self.mj_spec, person.name, person.position, person.heading)
        body.add_site(name=self._name("base"))
        self.bodies["legs"] = (body, (0, 0, 0))

    def _legs(self) -> str:
        """Adds the legs, and returns the part that has them: the base, or one that turns on it, whose feet go ahead."""
        person, tall = self.person, self.person.height
        part, mass = "legs", LEG
        if person.sideways:
            base, _ = self.bodies["legs"]
            feet = 2 * FOOT * person.mass
            base.explicitinertial, base.mass, base.inertia = True, feet, [feet * person.depth**2] * 3
            part, mass = "stance", LEG - FOOT
            self._segment(part, "legs", (0, 0, 0), ("yaw",))
        thick = min(0.046 * tall, person.depth / 2)
        for side, sign in zip(SIDES, (1, -1), strict=True):
            y = sign * min(0.0955 * tall, person.shoulder_width / 2) - sign * thick
            self._capsule(part, f"{side}_leg", (0, y, CLEARANCE + thick), (0, y, 0.53 * tall), thick, mass)
        return part

    def _segment(self, part: str, parent: str, joint: Point, hinges: tuple[str, ...] = HINGES) -> None:
        """Adds a body on hinges at one point, given in the world's frame of a body at the origin that faces along x."""
        on, at = self.bodies[parent]
        body = on.add_body(name=self._name(part), pos=[a - b for a, b in zip(joint, at, strict=True)], gravcomp=1)
        for hinge, limits in zip(hinges, limits_of(part), strict=True):
            body.add_joint(
                name=self._name(f"{part}_{hinge}"),
                type=mjtJoint.mjJNT_HINGE,
                axis=_AXES[hinge],
                range=limits,
                limited=True,
                armature=strength_of(part) / BRISKNESS,
                solref_limit=WALL_SOLREF,
                solimp_limit=[0.999, 0.9999, 0.001, 0.5, 2],
            )
        self.bodies[part] = (body, joint)

    def _trunk(self, part: str, low: float, high: float, width: float, mass: float) -> None:
        tall = self.person.height
        half = (self.person.depth / 2, width / 2, (high - low) / 2 * tall)
        kind = mjtGeom.mjGEOM_BOX if self.person.trunk == "box" else mjtGeom.mjGEOM_ELLIPSOID
        self._geom(part, part, kind, (0, 0, (low + high) / 2 * tall), half, mass)

    def _shoulder(self, side: str, sign: int) -> None:
        """Adds the segment from the breastbone to the shoulder joint, and the round of the joint."""
        part, r = f"{side}_shoulder", self.deltoid
        outer = self.shoulder_y * sign
        self._segment(part, "torso", (0, 0, self.shoulder_z))
        if self.person.trunk == "box":
            y = (outer + sign * r) / 2
            half = (self.person.depth / 2, abs(y), r)
            self._geom(part, part, mjtGeom.mjGEOM_BOX, (0, y, self.shoulder_z), half, 0.01)
        else:
            self._capsule(part, part, (0, 0, self.shoulder_z), (0, outer, self.shoulder_z), 0.9 * r, 0.01)
        self._geom(part, f"{side}_shoulder_joint", mjtGeom.mjGEOM_SPHERE, (0, outer, self.shoulder_z), (r, 0, 0), 0.005)

    def _arm(self, side: str, sign: int) -> None:
        """Adds upper arm, forearm and hand, straight down, or with a square elbow to where the load is held."""
        part, r = f"{side}_upper_arm", 0.74 * self.deltoid
        y, z = self.shoulder_y * sign, self.shoulder_z
        self._segment(part, f"{side}_shoulder", (0, y, z))
        elbow = (0.0, y, z - self.upper)
        forward, inward, down = self._reach()
        ways = [(self.fore, 0.85 * r, "forearm", 0.016), (self.hand, 0.75 * r, "hand", 0.006)]
        self._capsule(part, part, (0, y, z), elbow, r, 0.028)
        start = elbow
        for length, thick, name, mass in ways:
            reach = length - thick if name == "hand" else length
            end = (start[0] + forward * reach, start[1] - sign * inward * reach, start[2] - down * reach)
            self._capsule(part, f"{side}_{name}", start, end, thick, mass)
            start = end

    def _reach(self) -> Point:
        """Returns the way forearms point: how much forward, inward and down (a unit vector)."""
        load = self.person.load
        if load is None:
            return (0.0, 0.0, 1.0)
        inward = max(0.0, self.shoulder_y - load.width / 2) / (self.fore + self.hand / 2)
        inward = min(inward, 0.9)
        return (math.sqrt(1 - inward**2), inward, 0.0)

    def grip(self, sign: int) -> Point:
        """Returns where the middle of a hand is, with the load held (frame as for `_segment`) [m]."""
        forward, inward, _ = self._reach()
        reach = self.fore + self.hand / 2
        return (forward * reach, sign * (self.shoulder_y - inward * reach), self.shoulder_z - self.upper)

    def _head(self) -> None:
        person, tall = self.person, self.person.height
        self._segment("head", "torso", (0, 0, 0.85 * tall))
        low, half = 0.87 * tall, (0.055 * tall, 0.044 * tall, 0.065 * tall)
        self._geom("head", "head", mjtGeom.mjGEOM_ELLIPSOID, (0, 0, low + half[2]), half, 0.075)
        self._capsule("head", "neck", (0, 0, 0.84 * tall), (0, 0, low + half[2]), 0.03 * tall, 0.0059)
        front = half[0] * math.sqrt(1 - ((person.eyes - low - half[2]) / half[2]) ** 2)
        r = min(0.012, front, tall - person.eyes)
        self._segment("eye", "head", (front - r, 0, person.eyes))
        self._geom("eye", "eye", mjtGeom.mjGEOM_SPHERE, (front - r, 0, person.eyes), (r, 0, 0), 0.0001, touches=False)
        body, _ = self.bodies["eye"]
        ahead = [r + AHEAD, 0, 0]
        body.add_site(name=self._name("eye"), pos=ahead)
        body.add_camera(name=self._name("eye"), pos=ahead, xyaxes=[0, -1, 0, 0, 0, 1], fovy=60)

    def _load(self) -> None:
        """Adds the load to the right hand, and ties it to the left one."""
        person, load = self.person, self.person.load
        assert load is not None
        left, right = self.grip(1), self.grip(-1)
        middle = (max(right[0], (person.depth + load.depth) / 2 + 0.01), 0.0, right[2])
        arm, shoulder = self.bodies["right_upper_arm"]
        at = [a - b for a, b in zip(middle, shoulder, strict=True)]
        body = arm.add_body(name=self._name("load"), pos=at, gravcomp=1)
        self.bodies["load"] = (body, middle)
        if load.shape == "box":
            self._geom("load", "load", mjtGeom.mjGEOM_BOX, middle, tuple(s / 2 for s in load.size), load.mass / person.mass, load.colour)
        else:
            r = load.size[1] / 2
            y = max(load.size[0] / 2 - r, 1e-4)
            self._capsule("load", "load", (middle[0], -y, middle[2]), (middle[0], y, middle[2]), r, load.mass / person.mass, load.colour)
        tie = self.mj_spec.add_equality(
            name=self._name("load"),
            type=mjtEq.mjEQ_CONNECT,
            objtype=mjtObj.mjOBJ_BODY,
            name1=self._name("left_upper_arm"),
            name2=self._name("load"),
            solref=WALL_SOLREF,
        )
        tie.data[:3] = [a - b for a, b in zip(left, self.bodies["left_upper_arm"][1], strict=True)]

    def _servos(self) -> None:
        """Adds what moves it, and the welds by which hands hold things."""
        base = self._name("base")
        for name, axis, force in (("forward", 0, self.person.push), ("sideways", 1, self.person.push), ("turn", 5, TURN)):
            gear = tuple(float(n == axis) for n in range(6))
            add_servo(self.mj_spec, self._name(name), base, force, gear)
        for segment, hinge in self.person.joints:
            joint = self._name(f"{segment}_{hinge}")
            add_servo(self.mj_spec, joint, joint, strength_of(segment))
        for side in SIDES:
            arm = self._name(f"{side}_upper_arm")
            hand = self.mj_spec.add_equality(name=self._name(f"{side}_hand"), type=mjtEq.mjEQ_WELD, objtype=mjtObj.mjOBJ_BODY, name1=arm)
            hand.active = False
            hand.solref = WALL_SOLREF

    def _capsule(self, part: str, name: str, start: Point, end: Point, r: float, mass: float, colour: Any = None) -> None:
        middle: Any = tuple((a + b) / 2 for a, b in zip(start, end, strict=True))
        geom = self._geom(part, name, mjtGeom.mjGEOM_CAPSULE, middle, (r, math.dist(start, end) / 2, 0), mass, colour)
        turn = np.zeros(4)
        mujoco.mju_quatZ2Vec(turn, np.subtract(end, start))
        geom.quat = turn

    def _geom(self, part: str, name: str, kind: Any, at: Point, size: Any, mass: float, colour: Any = None, touches: bool = True) -> Any:
        """Adds a geom of a share of the mass; its contacts are as stiff and as slippery as ours, whatever it meets."""
        body, origin = self.bodies[part]
        return body.add_geom(
            name=self._name(name),
            type=kind,
            pos=[a - b for a, b in zip(at, origin, strict=True)],
            size=list(size),
            mass=mass * self.person.mass,
            rgba=colour or self.person.colour,
            solref=WALL_SOLREF,
            friction=[0.4, 0.005, 0.0001],
            priority=1,
            contype=int(touches),
            conaffinity=int(touches),
        )
