"""A car to drive: the bicycle model, with the eye where the driver's is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

from annotated_types import Gt, Lt
from mujoco import MjSpec, mjtBias, mjtGain, mjtGeom, mjtJoint, mjtTrn

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError
from actr3d.world.anatomy import Anatomy, Steering, body_kind
from actr3d.world.bodies.planar_base import add_planar_base
from actr3d.world.scene_objects import WALL_SOLREF, Colour, Heading, Length, Name, Positive
from actr3d.world.sensor_noise import Noise
from actr3d.world.velocity_servo import add_servo

GRAVITY = 9.81
"""[m/s^2]; determines the load of the tyres."""

GROUND_CLEARANCE = 0.15
"""Below the car's floor [m]. Source: chosen for this library."""

WAIST = 0.62
"""Height at which the cabin begins, as a fraction of the height. Source: chosen for this library."""


@body_kind
@dataclass(frozen=True, kw_only=True)
class Car(Configuration):
    """A car that moves like a bicycle: its rear wheel rolls where it points, its front wheel where it is steered.

    The sideways force of both wheels is limited by the grip of their tyres; within it, the middle of the rear axle follows a circle of
    radius wheelbase / tan(road wheel angle). Throttle and brake act along the heading; drag is proportional to speed. Its position and
    heading are those of the rear axle's middle.

    Source of mass and axles: the vehicle of the driver model in docs/human-data.md (mass 1175, a 0.946, b 1.719).
    """

    name: Name = "car"
    """Its name in the scene."""

    position: tuple[float, float] = (0.0, 0.0)
    """Position of the rear axle's middle at the start, (x, y) [m]."""

    heading: Heading = 0.0
    """Its heading at the start [rad], 0 along x."""

    wheelbase: Length = 2.665
    """Between the axles [m]."""

    rear: Length = 1.719
    """From the rear axle to the centre of mass [m]."""

    size: tuple[Length, Length, Length] = (4.2, 1.7, 1.45)
    """Length, width and height [m]. Source: chosen, a compact car."""

    mass: Positive = 1175.0
    """[kg]"""

    ratio: Positive = 16.0
    """Turns of the steering wheel for one of the road wheels. Source: chosen, passenger cars have 12 to 20."""

    lock: Annotated[float, Gt(0), Lt(1.4)] = math.radians(35)
    """Greatest angle of the road wheels to each side [rad]. Source: chosen, usual."""

    steering_rate: Positive = 4 * math.pi
    """Greatest speed of the steering wheel [rad/s]. Source: 720 degrees a second, as in NHTSA's fishhook manoeuvre."""

    drive: Positive = 4000.0
    """Force of the engine at full throttle [N]. Source: chosen, 3.4 m/s^2."""

    top_speed: Positive = 50.0
    """Speed at which drag equals the drive [m/s]; drag is proportional to speed. Source: chosen, 180 km/h."""

    brakes: Positive = 9000.0
    """Force of the brakes when fully pressed [N]. Source: chosen, 0.78 of the weight, on dry asphalt."""

    grip: Positive = 0.9
    """Greatest sideways force of the tyres as a fraction of their load. Source: chosen, dry asphalt."""

    eye: tuple[float, float, float] = (1.2, 0.35, 1.2)
    """The driver's eye relative to the rear axle's middle on the ground: forward, left, up [m]. Source: chosen, a left-hand drive."""

    noise: Noise = ()
    """Noise of its sensors: the name and the standard deviation, in the reading's unit, or one for each field, as in
    `(("pose", 0.01), ("view", (("d1", 0.1), ("d2", 0.1))))`. Sensors that are not named are exact."""

    colour: Colour = (0.70, 0.25, 0.22, 1.0)
    """Red, green, blue, alpha in 0 to 1."""

    def __post_init__(self) -> None:
        """Checks the fields.

        Raises:
            ConfigurationError: If a field is wrong, the centre of mass is not between the axles, or the car is too low.
        """
        super().__post_init__()
        if self.rear >= self.wheelbase:
            raise ConfigurationError(f"Car.rear: must be < the wheelbase of {self.wheelbase:g} m (got {self.rear!r})")
        if WAIST * self.size[2] <= GROUND_CLEARANCE:
            raise ConfigurationError(f"Car.size: its height must be > {GROUND_CLEARANCE / WAIST:.2f} m (got {self.size!r})")

    def anatomy(self) -> Anatomy:
        """Returns its description for a `Body`."""
        prefix = f"{self.name}_"
        return Anatomy(
            root=self.name,
            prefix=prefix,
            base="chassis",
            eye=f"{prefix}eye",
            noise=self.noise,
            servos=(f"{prefix}rear", f"{prefix}front", f"{prefix}steer"),
            steering=Steering(ratio=self.ratio, rate=self.steering_rate, drive=self.drive, brake=self.brakes),
        )

    def add_to(self, mj_spec: MjSpec) -> None:
        """Adds chassis, wheels, steering and servos."""
        body = add_planar_base(mj_spec, self.name, self.position, self.heading)
        self._chassis(body)
        body.add_site(name=self._name("rear"))
        body.add_site(name=self._name("eye"), pos=self.eye)
        body.add_camera(name=self._name("eye"), pos=self.eye, xyaxes=[0, -1, 0, 0, 0, 1], fovy=60)
        front = body.add_body(name=self._name("front"), pos=[self.wheelbase, 0, 0], gravcomp=1)
        limits = {"range": [-self.lock, self.lock], "limited": True, "solref_limit": WALL_SOLREF}
        front.add_joint(name=self._name("steer"), type=mjtJoint.mjJNT_HINGE, axis=[0, 0, 1], armature=1.0, **limits)
        front.add_site(name=self._name("front"))
        self._wheel(front, "front_wheel", 0.0)
        self._actuators(mj_spec)

    def _name(self, part: str) -> str:
        return f"{self.name}_{part}"

    def _chassis(self, body: Any) -> None:
        """Adds the hull and the cabin, and the rear wheels. The hull has all the mass."""
        long, wide, high = self.size
        middle = self.wheelbase / 2
        waist = WAIST * high
        hull = {"solref": WALL_SOLREF, "friction": [0.4, 0.005, 0.0001], "priority": 1, "mass": 0}
        body.add_geom(
            name=self._name("hull"),
            type=mjtGeom.mjGEOM_BOX,
            pos=[middle, 0, (GROUND_CLEARANCE + waist) / 2],
            size=[long / 2, wide / 2, (waist - GROUND_CLEARANCE) / 2],
            rgba=self.colour,
            **hull,
        )
        body.add_geom(
            name=self._name("cabin"),
            type=mjtGeom.mjGEOM_BOX,
            pos=[0.45 * self.wheelbase, 0, (waist + high) / 2],
            size=[0.27 * long, 0.45 * wide, (high - waist) / 2],
            rgba=[0.75, 0.85, 0.9, 0.35],
            **hull,
        )
        for side, y in (("left", wide / 2 - 0.09), ("right", 0.09 - wide / 2)):
            self._wheel(body, f"{side}_rear_wheel", y)
        # The inertia of a plain box of the hull's outline, whose inertia about the vertical is near that of the source (2618 kg m^2).
        body.mass = self.mass
        body.ipos = [self.rear, 0, high / 3]
        about = self.mass / 12
        body.inertia = [about * (wide**2 + high**2), about * (long**2 + high**2), about * (long**2 + wide**2)]
        body.explicitinertial = True

    def _wheel(self, body: Any, name: str, y: float) -> None:
        """Adds a visible wheel without contacts: servos model the grip of the tyres."""
        body.add_geom(
            name=self._name(name),
            type=mjtGeom.mjGEOM_CYLINDER,
            pos=[0, y, 0.3],
            quat=[math.sqrt(0.5), math.sqrt(0.5), 0, 0],
            size=[0.3, 0.09, 0],
            rgba=[0.1, 0.1, 0.1, 1],
            contype=0,
            conaffinity=0,
            mass=1e-3,
        )

    def _actuators(self, mj_spec: MjSpec) -> None:
        """Adds tyres that hold sideways, the steering, the engine with its drag, and the brake."""
        on_front = self.rear / self.wheelbase
        for name, share in (("front", on_front), ("rear", 1 - on_front)):
            add_servo(mj_spec, self._name(name), self._name(name), self.grip * self.mass * GRAVITY * share, (0, 1, 0, 0, 0, 0))
        add_servo(mj_spec, self._name("steer"), self._name("steer"), 1000.0)
        for name, gain, drag in (("throttle", self.drive, self.drive / self.top_speed), ("brake", 1.0, 0.0)):
            engine: Any = mj_spec.add_actuator(name=self._name(name), target=self._name("rear"))
            engine.trntype = mjtTrn.mjTRN_SITE
            engine.gaintype, engine.biastype = mjtGain.mjGAIN_FIXED, mjtBias.mjBIAS_AFFINE
            engine.gainprm[0], engine.biasprm[2] = gain, -drag
            engine.gear = [1, 0, 0, 0, 0, 0]
