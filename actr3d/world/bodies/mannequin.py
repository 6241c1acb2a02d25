"""The mannequin: a person's size and joints, which walks on stepping legs or glides."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import Annotated, Any, Literal

import mujoco
import numpy as np
from annotated_types import Gt, Le
from mujoco import MjSpec, mjtEq, mjtGeom, mjtJoint, mjtObj

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError
from actr3d.world.anatomy import Anatomy, NamedMovement, body_kind
from actr3d.world.bodies.load import Load
from actr3d.world.bodies.mannequin_limits import FASTEST_JOINT, FASTEST_TURN, FASTEST_WALK, limits_of, strength_of
from actr3d.world.bodies.planar_base import add_planar_base
from actr3d.world.gait import OWN, SIDES, Gait, LegPlan
from actr3d.world.scene_objects import WALL_SOLREF, Colour, Heading, Length, Name, Positive
from actr3d.world.sensor_noise import Noise
from actr3d.world.velocity_servo import add_servo

HINGES = ("yaw", "pitch", "roll")
HINGED = (
    *("pelvis", "torso", "head", "eye"),
    *(f"{side}_{part}" for part in ("shoulder", "upper_arm") for side in SIDES),
)
"""The segments with three hinges."""

LEG, FOOT, SHANK, HIPS = 0.161, 0.0145, 0.0465, 0.01
"""Masses of a leg with its foot, of the foot, of the shank, and of the part of a stepping leg that does not swing,
as fractions of the whole. Source of the last one: chosen."""

HIP, KNEE, ANKLE, FEET, HEEL = 0.53, 0.285, 0.039, 0.152, 0.04
"""Heights of the joints of a leg, length of the foot, and the part of it behind the ankle, as fractions of the height. Source of the last
one: chosen."""

CLEARANCE = 0.005
"""Gap between the legs and the floor [m], so that gliding meets no friction."""

BRISKNESS = 100.0
"""Acceleration of a joint by its full strength [rad/s^2]; its armature (inertia relative to the segment that carries it) follows
from it. With less armature, thin limbs on strong joints vibrate for ever after a push. Source: chosen for this library."""

SKIN = (0.78, 0.64, 0.53)
"""The colour of head and hands."""
SHADES = {"pelvis": 0.6, "leg": 0.6, "thigh": 0.6, "shank": 0.6, "foot": 0.35, "eye": 0.15}
"""How dark trousers, shoes and eye are, as a fraction of the shirt's colour."""
EYE_GAP = 0.002
"""Distance of the viewpoint in front of the eyeball [m], so that the eyeball does not block the view."""

TURN = 150.0
"""Greatest torque of the legs that turn the body [N m]. Source: chosen, of the order of a trunk's rotation."""

SHOULDER, UPPER_ARM = 0.818, 0.186 / 0.44
"""Height of the shoulder joints as a fraction of the height, and length of the upper arm as a fraction of the arm."""

Point = tuple[float, float, float]
_AXES = {"yaw": (0, 0, 1), "pitch": (0, 1, 0), "roll": (1, 0, 0), "sway": (0, 1, 0), "bob": (0, 0, 1)}

ARM = tuple(f"upper_arm_{hinge}" for hinge in HINGES)

MOVEMENTS = (
    NamedMovement(name="rotate_torso", joints=(("torso_yaw", 1),)),
    NamedMovement(name="extend_shoulder", side="left", joints=(("left_shoulder_yaw", -1),)),
    NamedMovement(name="extend_shoulder", side="right", joints=(("right_shoulder_yaw", 1),)),
    NamedMovement(name="compress_shoulder", side="left", joints=(("left_shoulder_yaw", 1),)),
    NamedMovement(name="compress_shoulder", side="right", joints=(("right_shoulder_yaw", -1),)),
    NamedMovement(name="lower_arms", joints=tuple((f"{side}_{joint}", 1) for side in SIDES for joint in ARM), to=0.0),
)
"""The named movements. The torso turns to the left. A shoulder extends forward and compresses backward from its rest position: a turn
to the left extends the right one and compresses the left one. Lowered arms hang, or hold the load, as at the start.
Source: the names are those of the original ACT-R 3D; their definition for shoulders was chosen for this library."""


@body_kind
@dataclass(frozen=True, kw_only=True)
class Mannequin(Configuration):
    """A person: legs, pelvis, torso, shoulders, arms, head and eye. All but the legs have three hinges each (yaw, pitch, roll).

    It moves over the floor at the commanded speed and stops immediately; obstacles stop it, too. With a `gait` it steps and sways,
    otherwise its legs glide. It stands facing its heading with hanging arms, or holding its load. Its parts are `legs`, `pelvis`, `torso`,
    `left_shoulder`, `left_upper_arm` (with forearm and hand), the same on the right, `head`, `eye` and `load`; its joints `torso_yaw`,
    `torso_pitch` and so on.

    Source of proportions: Drillis & Contini (1966), as given by Winter (2009), in fractions of the height; of masses:
    Dempster (1955), as given there.
    """

    name: Name = "mannequin"
    """Its name in the scene; its elements are `<name>_torso` and so on."""

    position: tuple[float, float] = (0.0, 0.0)
    """Its position at the start, (x, y) [m]."""

    heading: Heading = 0.0
    """Its heading at the start [rad], 0 along x."""

    height: Length = 1.75
    """[m]. Source: about the mean of adult men, e.g. 1.756 m in ANSUR II (2012)."""

    shoulder_width: Length = 0.444
    """Across both shoulders at their widest [m], at most the height; the hips are no wider.
    Source: mean of the small (0.404) and large (0.484) groups of Warren & Whang (1987)."""

    depth: Length = 0.25
    """Of the trunk, front to back [m], at most the height; the head, 0.11 of the height, may be deeper.
    Source: chest depth of about 0.25 m in ANSUR II (2012)."""

    eye_height: Length | None = None
    """[m]; None is 0.936 of the height."""

    arm_length: Length | None = None
    """From the shoulder joint to the finger tips [m]; None is 0.44 of the height."""

    mass: Positive = 75.0
    """Without load [kg]. Source: chosen, a body mass index of 24.5 at the default height."""

    trunk: Literal["ellipsoid", "box"] = "ellipsoid"
    """Shape of pelvis, torso and shoulders. A box gets wider when it begins to turn; people do not."""

    sideways: bool = False
    """Whether hips and legs, with all that they carry, can turn relative to the walking direction, as in walking sideways: adds the
    joint `stance_yaw` of the part `stance`. Otherwise the legs face the walking direction."""

    gait: Gait | None = None
    """How it walks; None: its legs are stiff and glide. With a gait, the part `stance` carries the whole body above the base, and the legs
    are `left_thigh`, `left_shank` and `left_foot`, the same on the right; no command moves these."""

    load: Load | None = None
    """The load in both hands in front of it; None for hanging arms."""

    leg_force: Annotated[float, Gt(0), Le(2000)] = 300.0
    """Greatest force of the legs [N]. Source: chosen; pushing while walking, people reach 200 to 400 N."""

    noise: Noise = ()
    """Noise of its sensors: the name and the standard deviation, in the reading's unit, or one for each field, as in
    `(("pose", 0.01), ("view", (("d1", 0.1), ("d2", 0.1))))`. Sensors that are not named are exact."""

    colour: Colour = (0.35, 0.47, 0.62, 1.0)
    """Of the shirt: red, green, blue, alpha in 0 to 1. Trousers and shoes are darker shades of it."""

    def __post_init__(self) -> None:
        """Checks the fields.

        Raises:
            ConfigurationError: If a field is wrong, or sizes contradict each other.
        """
        super().__post_init__()
        if not 0.87 * self.height < self.height_of_eyes < 0.99 * self.height:
            low, high = 0.87 * self.height, 0.99 * self.height
            raise ConfigurationError(
                f"Mannequin.eye_height: must be in the head, here >= {low:.2f} and <= {high:.2f} m (got {self.height_of_eyes!r})"
            )
        if self.shoulder_width < 0.15 * self.height:
            raise ConfigurationError(f"Mannequin.shoulder_width: must be >= 0.15 of the height (got {self.shoulder_width!r})")
        for name in ("shoulder_width", "depth"):
            if getattr(self, name) > self.height:
                raise ConfigurationError(f"Mannequin.{name}: must be <= the height (got {getattr(self, name)!r})")
        if self.load is not None and self.load.height / 2 >= self.grip_height:
            most = 2 * self.grip_height
            raise ConfigurationError(f"Mannequin.load: would touch the floor; it can be {most:.2f} m high (got {self.load.height!r})")
        if self.length_of_arms > 0.75 * self.height:
            raise ConfigurationError(f"Mannequin.arm_length: hands would touch the floor (got {self.length_of_arms!r})")

    @property
    def height_of_eyes(self) -> float:
        """Height of the eyes [m]."""
        return 0.936 * self.height if self.eye_height is None else self.eye_height

    @property
    def length_of_arms(self) -> float:
        """Length of an arm from the shoulder joint to the finger tips [m]."""
        return 0.44 * self.height if self.arm_length is None else self.arm_length

    @property
    def grip_height(self) -> float:
        """Height of the hands that hold a load, with the elbows bent by 90 degrees [m]."""
        return SHOULDER * self.height - self.length_of_arms * UPPER_ARM

    @property
    def legs(self) -> LegPlan:
        """Sizes of its legs."""
        tall, r = self.height, ANKLE * self.height / 2
        heel, toe = HEEL * tall - r, (FEET - HEEL) * tall - r
        return LegPlan(thigh=(HIP - KNEE) * tall, shank=(KNEE - ANKLE) * tall, ankle=r, heel=heel, toe=toe, height=tall)

    @property
    def joints(self) -> tuple[tuple[str, str], ...]:
        """All joints: the segment and the hinge."""
        stance = (("stance", "yaw"),) if self.sideways else ()
        own = [joint.rpartition("_") for joint in OWN] if self.gait is not None else []
        return (*((segment, joint) for segment, _, joint in own), *stance, *((segment, hinge) for segment in HINGED for hinge in HINGES))

    def add_to(self, mj_spec: MjSpec) -> None:
        """Adds all segments, joints and servos, and the welds by which its hands hold objects."""
        _Builder(self, mj_spec).build()

    def anatomy(self) -> Anatomy:
        """Returns its description for a `Body`."""
        prefix = f"{self.name}_"
        walking = (f"{prefix}forward", f"{prefix}sideways", f"{prefix}turn")
        joints = tuple(f"{prefix}{segment}_{hinge}" for segment, hinge in self.joints)
        return Anatomy(
            root=self.name,
            prefix=prefix,
            base="legs",
            eye=f"{prefix}eye",
            noise=self.noise,
            fastest=(FASTEST_WALK, FASTEST_TURN, FASTEST_JOINT),
            walking_servos=walking,
            servos=walking + joints,
            movements=MOVEMENTS,
            hands=tuple(f"{prefix}{side}_hand" for side in SIDES),
            shoulders=self.shoulder_width,
            gait=None if self.gait is None else (self.gait, self.legs),
        )


class _Builder:
    """Builds one mannequin. Heights below are fractions of its height, from the source that `Mannequin` names."""

    def __init__(self, person: Mannequin, mj_spec: MjSpec) -> None:
        self.person = person
        self.mj_spec = mj_spec
        self.bodies: dict[str, tuple[Any, Point]] = {}
        tall = person.height
        self.deltoid = min(0.035 * tall, person.shoulder_width / 4)
        self.shoulder_y = person.shoulder_width / 2 - self.deltoid
        self.shoulder_z = SHOULDER * tall
        self.upper, self.fore, self.hand = (person.length_of_arms * part for part in (UPPER_ARM, 0.146 / 0.44, 0.108 / 0.44))

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
            # Parts of the body have no contacts with each other, except load and trunk: the trunk stops a load that is pushed back.
            if (one, other) not in (("pelvis", "load"), ("torso", "load")):
                self.mj_spec.add_exclude(bodyname1=self.bodies[one][0].name, bodyname2=self.bodies[other][0].name)
        self._servos()

    def _name(self, part: str) -> str:
        return f"{self.person.name}_{part}"

    def _colour_of(self, name: str) -> Colour:
        """Returns the colour of a geom: that of skin, or of clothes."""
        red, green, blue, alpha = self.person.colour
        kind = name.rpartition("_")[2]
        if kind in ("head", "neck", "hand"):
            return (*SKIN, alpha)
        shade = SHADES.get(kind, 1.0)
        return (shade * red, shade * green, shade * blue, alpha)

    def _base(self) -> None:
        """Adds the planar base, which carries all the rest."""
        person = self.person
        body = add_planar_base(self.mj_spec, person.name, person.position, person.heading)
        body.add_site(name=self._name("base"))
        self.bodies["legs"] = (body, (0, 0, 0))

    def _legs(self) -> str:
        """Adds the legs, and returns the part that has them: the base, or a part that turns on it."""
        person, tall = self.person, self.person.height
        part, mass = "legs", LEG
        if person.sideways or person.gait is not None:
            base, _ = self.bodies["legs"]
            feet = 2 * FOOT * person.mass
            base.explicitinertial, base.mass, base.inertia, base.ipos = True, feet, [feet * person.depth**2] * 3, [0, 0, 0]
            part, mass = "stance", LEG - FOOT
            self._segment(
                part, "legs", (0, 0, 0), (*(("sway", "bob") if person.gait is not None else ()), *(("yaw",) if person.sideways else ()))
            )
        thick = min(0.046 * tall, person.depth / 2)
        if person.gait is not None:
            hips, _ = self.bodies[part]
            weight = 2 * HIPS * person.mass
            hips.explicitinertial, hips.mass, hips.inertia, hips.ipos = True, weight, [weight * person.depth**2] * 3, [0, 0, HIP * tall]
        for side, sign in zip(SIDES, (1, -1), strict=True):
            y = sign * min(0.0955 * tall, person.shoulder_width / 2) - sign * thick
            if person.gait is not None:
                self._walking_leg(part, side, y, thick)
            else:
                self._capsule(part, f"{side}_leg", (0, y, CLEARANCE + thick), (0, y, 0.53 * tall), thick, mass)
        return part

    def _walking_leg(self, part: str, side: str, y: float, thick: float) -> None:
        """Adds a leg that steps: thigh, shank and foot. The foot touches obstacles, but not the ground: gait keeps it there."""
        tall = self.person.height
        hip, knee, ankle = ((0.0, y, CLEARANCE + height * tall) for height in (HIP, KNEE, ANKLE))
        thigh, shank, foot = (f"{side}_{name}" for name in ("thigh", "shank", "foot"))
        self._segment(thigh, part, hip, ("yaw", "pitch", "roll"))
        self._capsule(thigh, thigh, hip, knee, thick, LEG - HIPS - SHANK - FOOT)
        self._segment(shank, thigh, knee, ("pitch",))
        self._capsule(shank, shank, knee, ankle, 0.7 * thick, SHANK)
        self._segment(foot, shank, ankle, ("pitch",))
        legs = self.person.legs
        heel, toe = (-legs.heel, y, CLEARANCE + legs.ankle), (legs.toe, y, CLEARANCE + legs.ankle)
        self._capsule(foot, foot, heel, toe, legs.ankle, FOOT / 10)  # the rest of its mass is the base's
        for segment in (shank, foot):
            self.mj_spec.add_exclude(bodyname1="world", bodyname2=self._name(segment))

    def _segment(self, part: str, parent: str, joint: Point, hinges: tuple[str, ...] = HINGES) -> None:
        """Adds a body on joints at one point, given in the world's frame of a body at the origin that faces along x."""
        on, at = self.bodies[parent]
        body = on.add_body(name=self._name(part), pos=[a - b for a, b in zip(joint, at, strict=True)], gravcomp=1)
        for hinge in hinges:
            body.add_joint(
                name=self._name(f"{part}_{hinge}"),
                type=mjtJoint.mjJNT_HINGE if hinge in HINGES else mjtJoint.mjJNT_SLIDE,
                axis=_AXES[hinge],
                range=limits_of(part, hinge),
                limited=True,
                armature=strength_of(part) / BRISKNESS if hinge in HINGES else 0.0,
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
        """Adds the segment from the breastbone to the shoulder joint, and the ball of the joint."""
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
        """Adds upper arm, forearm and hand, straight down, or with a square elbow to the load."""
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
        """Returns the direction of the forearms: forward, inward and down (a unit vector)."""
        load = self.person.load
        if load is None:
            return (0.0, 0.0, 1.0)
        inward = max(0.0, self.shoulder_y - load.width / 2) / (self.fore + self.hand / 2)
        inward = min(inward, 0.9)
        return (math.sqrt(1 - inward**2), inward, 0.0)

    def grip(self, sign: int) -> Point:
        """Returns the middle of a hand that holds the load (frame as for `_segment`) [m]."""
        forward, inward, _ = self._reach()
        reach = self.fore + self.hand / 2
        return (forward * reach, sign * (self.shoulder_y - inward * reach), self.shoulder_z - self.upper)

    def _head(self) -> None:
        person, tall = self.person, self.person.height
        self._segment("head", "torso", (0, 0, 0.85 * tall))
        low, half = 0.87 * tall, (0.055 * tall, 0.044 * tall, 0.065 * tall)
        self._geom("head", "head", mjtGeom.mjGEOM_ELLIPSOID, (0, 0, low + half[2]), half, 0.075)
        self._capsule("head", "neck", (0, 0, 0.84 * tall), (0, 0, low + half[2]), 0.03 * tall, 0.0059)
        front = half[0] * math.sqrt(1 - ((person.height_of_eyes - low - half[2]) / half[2]) ** 2)
        r = min(0.012, front, tall - person.height_of_eyes)
        self._segment("eye", "head", (front - r, 0, person.height_of_eyes))
        self._geom("eye", "eye", mjtGeom.mjGEOM_SPHERE, (front - r, 0, person.height_of_eyes), (r, 0, 0), 0.0001, touches=False)
        body, _ = self.bodies["eye"]
        ahead = [r + EYE_GAP, 0, 0]
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
        """Adds the servos, and the welds by which hands hold objects."""
        base = self._name("base")
        for name, axis, force in (("forward", 0, self.person.leg_force), ("sideways", 1, self.person.leg_force), ("turn", 5, TURN)):
            gear = tuple(float(n == axis) for n in range(6))
            add_servo(self.mj_spec, self._name(name), base, force, gear)
        for segment, hinge in self.person.joints:
            joint = self._name(f"{segment}_{hinge}")
            add_servo(self.mj_spec, joint, joint, strength_of(segment) if hinge in HINGES else self.person.leg_force)
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
        """Adds a geom with a fraction of the mass; stiffness and friction of its contacts have priority over those of the other geom."""
        body, origin = self.bodies[part]
        return body.add_geom(
            name=self._name(name),
            type=kind,
            pos=[a - b for a, b in zip(at, origin, strict=True)],
            size=list(size),
            mass=mass * self.person.mass,
            rgba=colour or self._colour_of(name),
            solref=WALL_SOLREF,
            friction=[0.4, 0.005, 0.0001],
            priority=1,
            contype=int(touches),
            conaffinity=int(touches),
        )
