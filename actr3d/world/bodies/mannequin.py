"""The mannequin: a person's size and joints, walking on legs that do not step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from annotated_types import Gt, Le
from mujoco import MjSpec

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError
from actr3d.world.anatomy import Anatomy
from actr3d.world.bodies.limbs import HINGED, HINGES, SHOULDER, SIDES, UPPER_ARM, Limbs
from actr3d.world.bodies.limits import FASTEST_JOINT, FASTEST_TURN, FASTEST_WALK
from actr3d.world.bodies.load import Load
from actr3d.world.bodies.movements import MOVEMENTS
from actr3d.world.parts import Colour, Length, Name


@dataclass(frozen=True, kw_only=True)
class Mannequin(Configuration):
    """A person: legs, pelvis, torso, shoulders, arms, head and eye, joined by three hinges each (yaw, pitch, roll).

    The legs glide over the floor at a set speed and stop dead; what is in the way stops them. It stands facing its heading
    with hanging arms, or holding its load. Its parts are `legs`, `pelvis`, `torso`, `left_shoulder`, `left_upper_arm` (with
    forearm and hand), the same on the right, `head`, `eye` and `load`; its joints `torso_yaw`, `torso_pitch` and so on.

    Source of proportions: Drillis & Contini (1966), as given by Winter (2009), in fractions of the height; of masses:
    Dempster (1955), as given there.
    """

    name: Name = "mannequin"
    """Its name in the scene; its elements are `<name>_torso` and so on."""

    position: tuple[float, float] = (0.0, 0.0)
    """Where it stands at the start, (x, y) [m]."""

    heading: float = 0.0
    """Where it faces at the start [rad], 0 along x."""

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

    mass: Length = 75.0
    """Without load [kg]. Source: ours, a body mass index of 24.5 at the default height."""

    trunk: Literal["ellipsoid", "box"] = "ellipsoid"
    """Shape of pelvis, torso and shoulders. A box gets wider when it begins to turn; people do not."""

    sideways: bool = False
    """Whether hips and legs can turn against the way it goes, with all that they carry, as those of who walks sideways: about one
    joint more, `stance_yaw` of the part `stance`. Else the legs face the way that they go."""

    load: Load | None = None
    """What it holds in front of it with both hands; None holds nothing and lets the arms hang."""

    push: Annotated[float, Gt(0), Le(2000)] = 300.0
    """The most the legs push with [N]. Source: ours; pushing while walking, people reach 200 to 400 N."""

    noise: tuple[tuple[str, float], ...] = ()
    """Of its sensors: the word and the standard deviation, in the reading's unit; what is not named is exact."""

    colour: Colour = (0.35, 0.47, 0.62, 1.0)
    """Of the clothes: red, green, blue, alpha in 0 to 1."""

    def __post_init__(self) -> None:
        """Checks the fields.

        Raises:
            ConfigurationError: If a field is wrong, or sizes do not go together.
        """
        super().__post_init__()
        if not 0.87 * self.height < self.eyes < 0.99 * self.height:
            low, high = 0.87 * self.height, 0.99 * self.height
            raise ConfigurationError(f"Mannequin.eye_height: must be in the head, {low:.2f} to {high:.2f} m here (got {self.eyes!r})")
        if self.shoulder_width < 0.15 * self.height:
            raise ConfigurationError(f"Mannequin.shoulder_width: must be at least 0.15 of the height (got {self.shoulder_width!r})")
        for name in ("shoulder_width", "depth"):
            if getattr(self, name) > self.height:
                raise ConfigurationError(f"Mannequin.{name}: must be at most the height (got {getattr(self, name)!r})")
        if self.load is not None and self.load.height / 2 >= self.grip_height:
            most = 2 * self.grip_height
            raise ConfigurationError(f"Mannequin.load: would touch the floor; it can be {most:.2f} m high (got {self.load.height!r})")
        if self.arms > 0.75 * self.height:
            raise ConfigurationError(f"Mannequin.arm_length: hands would touch the floor (got {self.arms!r})")

    @property
    def eyes(self) -> float:
        """Height of the eyes [m]."""
        return 0.936 * self.height if self.eye_height is None else self.eye_height

    @property
    def arms(self) -> float:
        """Length of an arm from the shoulder joint to the finger tips [m]."""
        return 0.44 * self.height if self.arm_length is None else self.arm_length

    @property
    def grip_height(self) -> float:
        """Height of the hands that hold a load, with square elbows [m]."""
        return SHOULDER * self.height - self.arms * UPPER_ARM

    @property
    def joints(self) -> tuple[tuple[str, str], ...]:
        """All joints: the segment and the hinge."""
        stance = (("stance", "yaw"),) if self.sideways else ()
        return (*stance, *((segment, hinge) for segment in HINGED for hinge in HINGES))

    def add_to(self, mj_spec: MjSpec) -> None:
        """Adds all segments, joints and servos, and what its hands can hold things with."""
        Limbs(self, mj_spec).build()

    def anatomy(self) -> Anatomy:
        """Returns what a `Body` needs to know of it."""
        prefix = f"{self.name}_"
        push = (f"{prefix}forward", f"{prefix}sideways", f"{prefix}turn")
        joints = tuple(f"{prefix}{segment}_{hinge}" for segment, hinge in self.joints)
        return Anatomy(
            root=self.name,
            prefix=prefix,
            base="legs",
            eye=f"{prefix}eye",
            noise=self.noise,
            fastest=(FASTEST_WALK, FASTEST_TURN, FASTEST_JOINT),
            push=push,
            servos=push + joints,
            movements=MOVEMENTS,
            hands=tuple(f"{prefix}{side}_hand" for side in SIDES),
        )
