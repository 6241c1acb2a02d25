"""What the description of a body says of it beyond what the compiled model shows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Protocol, runtime_checkable

from annotated_types import Gt

from actr3d.configuration import Configuration
from actr3d.world.scene import Part


@dataclass(frozen=True, kw_only=True)
class Steering(Configuration):
    """How a driver acts on a car."""

    ratio: Annotated[float, Gt(0)]
    """Turns of the steering wheel for one turn of the road wheel."""

    rate: Annotated[float, Gt(0)]
    """How fast the steering wheel turns [rad/s]."""

    drive: Annotated[float, Gt(0)]
    """What the engine pushes with at full throttle [N]."""

    brake: Annotated[float, Gt(0)]
    """What the brakes hold back with when fully pressed [N]."""


@dataclass(frozen=True, kw_only=True)
class NamedMovement(Configuration):
    """A movement that a body has a name for: some joints that turn together."""

    name: str
    """What it is called: `extend_shoulder`."""

    side: str | None = None
    """On which side, where there is one movement of that name on each."""

    joints: tuple[tuple[str, float], ...]
    """The joints, and which way each of them turns: 1 where a positive angle of the movement is one of the joint, or -1."""

    to: float | None = None
    """To which angle it always brings them [rad]; None where whoever moves says to which."""


@dataclass(frozen=True, kw_only=True)
class Anatomy:
    """Names what a `Body` cannot find by looking at the compiled model. Names are those of MuJoCo's elements."""

    root: str
    """The MuJoCo body that carries all others."""

    prefix: str
    """What the names of its elements begin with; left out in the names that a `Body` gives them."""

    base: str = "base"
    """What the root segment is called."""

    eye: str | None = None
    """The site it sees from, which a camera of the same name shares; None has no eye."""

    skin: tuple[str, ...] | None = None
    """The geoms that feel; None for all that can touch something."""

    servos: tuple[str, ...] = ()
    """Actuators that hold a speed; their gains are fitted to the inertia they move."""

    hands: tuple[str, ...] = ()
    """Weld equalities, one a hand, that can hold an object."""

    fastest: tuple[float, float, float] | None = None
    """The fastest that it can be told to walk [m/s], to turn [rad/s] and to turn a joint [rad/s]; None has no limits."""

    push: tuple[str, str, str] | None = None
    """The servos that walk forward, to the left and turn; None cannot walk."""

    movements: tuple[NamedMovement, ...] = ()
    """Movements that have names."""

    noise: tuple[tuple[str, float], ...] = ()
    """Of sensors that are never exact: the word and the standard deviation of every number it reads, in its unit."""

    steering: Steering | None = None
    """How it is driven; None cannot be driven."""


@runtime_checkable
class Embodied(Part, Protocol):
    """A part of a scene that is a body: a mind can live in it."""

    def anatomy(self) -> Anatomy:
        """Returns what a `Body` needs to know of it."""
        ...
