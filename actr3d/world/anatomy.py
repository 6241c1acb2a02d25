"""The description of a body beyond what the compiled model contains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Protocol, TypeVar, runtime_checkable

from annotated_types import Gt

from actr3d.configuration import Configuration
from actr3d.registry import Registry
from actr3d.world.gait import Gait, LegPlan
from actr3d.world.scene import Part
from actr3d.world.sensor_noise import Noise


@dataclass(frozen=True, kw_only=True)
class Steering(Configuration):
    """How a driver controls a car."""

    ratio: Annotated[float, Gt(0)]
    """Turns of the steering wheel for one turn of the road wheel."""

    rate: Annotated[float, Gt(0)]
    """Greatest speed of the steering wheel [rad/s]."""

    drive: Annotated[float, Gt(0)]
    """Force of the engine at full throttle [N]."""

    brake: Annotated[float, Gt(0)]
    """Force of the brakes when fully pressed [N]."""


@dataclass(frozen=True, kw_only=True)
class NamedMovement(Configuration):
    """A named movement of a body: some joints that turn together."""

    name: str
    """Its name: `extend_shoulder`."""

    side: str | None = None
    """Its side, if there is one movement of that name on each side."""

    joints: tuple[tuple[str, float], ...]
    """The joints and their directions: 1 if a positive angle of the movement is a positive angle of the joint, or -1."""

    to: float | None = None
    """Its fixed target angle [rad]; None if each command gives the angle."""


@dataclass(frozen=True, kw_only=True)
class Anatomy:
    """Describes what a `Body` cannot find in the compiled model. Names are those of MuJoCo's elements."""

    root: str
    """The MuJoCo body that carries all others."""

    prefix: str
    """The start of the names of its elements; a `Body` leaves it out in its own names."""

    base: str = "base"
    """The name of the root segment."""

    eye: str | None = None
    """The site of its eye, which a camera of the same name shares; None for no eye."""

    skin: tuple[str, ...] | None = None
    """The geoms that report touches; None for all geoms with contacts."""

    servos: tuple[str, ...] = ()
    """Velocity servos; their gains are fitted to the inertia they move."""

    hands: tuple[str, ...] = ()
    """Weld equalities, one for each hand, that can hold an object."""

    fastest: tuple[float, float, float] | None = None
    """The greatest speeds that it can be commanded to walk [m/s], to turn [rad/s] and to turn a joint [rad/s]; None without limits."""

    walking_servos: tuple[str, str, str] | None = None
    """The servos that walk forward, to the left and turn; None if it cannot walk."""

    movements: tuple[NamedMovement, ...] = ()
    """Its named movements."""

    noise: Noise = ()
    """Noise of sensors: the name, and the standard deviation of every number of the reading, in its unit, or by field."""

    steering: Steering | None = None
    """How it is driven; None if it is not a vehicle."""

    shoulders: float | None = None
    """Width across its shoulders [m]; None for a body without shoulders."""

    gait: tuple[Gait, LegPlan] | None = None
    """Its gait, and the sizes of its legs; None if it glides."""


@runtime_checkable
class Embodied(Part, Protocol):
    """A part of a scene that is a body, for an agent to control."""

    def anatomy(self) -> Anatomy:
        """Returns its description for a `Body`."""
        ...


K = TypeVar("K", bound=type[Embodied])

BODY_KINDS: Registry[type[Embodied]] = Registry("body")
"""The kinds of bodies by class name."""


def body_kind(kind: K) -> K:
    """Registers a class as a kind of body."""
    BODY_KINDS.add(kind.__name__, kind)
    return kind
