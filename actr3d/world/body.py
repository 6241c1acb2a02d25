"""A body in a compiled world: what it consists of, what it senses, what it is told to do."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, cast

import numpy as np
from mujoco import mjtJoint
from numpy.typing import NDArray

from actr3d.errors import WorldError
from actr3d.world.actuators import ACTUATORS
from actr3d.world.anatomy import Anatomy, Embodied
from actr3d.world.base import Base
from actr3d.world.bounding_box import BoundingBox, Extent
from actr3d.world.frames import frame_of
from actr3d.world.grasp import Hand, Held
from actr3d.world.holding import Holding
from actr3d.world.joints import Joint
from actr3d.world.noise import Noise, Sd
from actr3d.world.running import Running
from actr3d.world.sensors import SENSORS
from actr3d.world.sensors.touch import Touch
from actr3d.world.servo import moved_by
from actr3d.world.words import known, number

if TYPE_CHECKING:
    from actr3d.world.world import World


@dataclass(frozen=True, kw_only=True)
class BodyState:
    """What a body needs to go on exactly, besides the physics: plain values, equal when the states are."""

    running: tuple[Any, ...]
    """Commands on their way, as `Running.state` gives them."""

    holding: tuple[Any, ...]
    """What it is told to keep, as `Holding.state` gives it."""

    noise: tuple[tuple[str, int, int], ...]
    """Sensors with noise: the word and where its random numbers are."""

    held: tuple[tuple[str, Held], ...]
    """What each hand holds and how."""

    touched: tuple[Touch, ...] | None
    """What the skin has felt in the last tick; None before anyone asks."""

    senses: tuple[tuple[Any, Any], ...]
    """What each sense that remembers something remembers."""


class Sense(Protocol):
    """A sense that remembers something from one reading to the next."""

    def state(self) -> Any:
        """Returns what it remembers: plain values."""
        ...

    def restore(self, state: Any) -> None:
        """Brings that back; None is what a new sense remembers."""
        ...


S = TypeVar("S", bound=Sense)
P = TypeVar("P")


class Body:
    """Senses and moves one body of a world. All is found in the compiled model; the description names the rest.

    Commands are given between physics steps only. A reading is of the present state; nothing in it changes later.

    Args:
        world: Where it is.
        description: What it was made from.

    Raises:
        WorldError: If its root is not in the compiled model.
    """

    def __init__(self, world: World, description: Embodied) -> None:
        self.world = world
        self.name = description.name
        self.anatomy: Anatomy = description.anatomy()
        self.root = self._id("body", self.anatomy.root)
        model = world.mj_model
        self.members = np.zeros(model.nbody, dtype=bool)
        """By MuJoCo body: whether it is part of this one."""
        for member in range(self.root, model.nbody):
            self.members[member] = member == self.root or self.members[model.body_parentid[member]]
        self.geoms: NDArray[np.intp] = np.flatnonzero(self.members[model.geom_bodyid])
        self.parts: tuple[str, ...] = tuple(self.part_name(int(member)) for member in np.flatnonzero(self.members))
        self._geom_names = {geom: self._geom_name(geom) for geom in self.geoms.tolist()}
        self.base = Base(world, self.root, self.anatomy)
        self.joints: dict[str, Joint] = {joint.name: joint for joint in self._joints()}
        self.controls: dict[str, slice] = self._controls()
        self.eye = self.anatomy.eye
        self.feeling: NDArray[np.intp] = self._feeling()
        """The geoms that feel contacts."""
        self.feels = frozenset(self.feeling.tolist())
        """The same, to look up."""
        self.skin: tuple[str, ...] = tuple(self.geom_name(geom) for geom in self.feeling.tolist())
        self.hands: dict[str, Hand] = {self.short(name).removesuffix("_hand"): Hand(world, name) for name in self.anatomy.hands}
        self.holding = Holding(self)
        self._servoed = [(joint, self.holding.row(joint.name)) for joint in self.joints.values() if joint.driven]
        self.running = Running(self)
        self.touched: tuple[Touch, ...] | None = None
        """What the skin has felt in the last tick; None before anyone asks."""
        self._senses: dict[Any, Sense] = {}
        """All that have been made."""
        self._used: list[Any] = []
        """The keys of those that the agent has used up to the present, in the order in which it first did."""
        self.noise = Noise(world.seed, self.name)
        self.extent = Extent(world.mj_model, world.mj_data, self.geoms)
        self.actuators: tuple[str, ...] = tuple(name for name, word in ACTUATORS.items() if word.fits(self))
        self.sensors: tuple[str, ...] = tuple(name for name, word in SENSORS.items() if word.fits(self))
        self._noise: Mapping[str, float] = dict(self.anatomy.noise)
        for word, sd in self._noise.items():
            known(word, self.sensors, self.name, "sensor")
            number(sd, f"{self.name}: noise of {word}", 0)

    def bounding_box(self, frame: str = "world") -> BoundingBox:
        """Returns the smallest box around all of the body and what it holds, exactly, in its present posture.

        Args:
            frame: `"world"`; `"body"`: at the base, along its heading, upright; or the name of one of its parts or
                sites, or of any site or body in the world.

        Raises:
            WorldError: If there is no such frame.
        """
        self.world.refresh()
        held = [geom for hand in self.hands.values() for geom in hand.geoms]
        return self.extent.box(*frame_of(self, frame), held)

    def moving(self) -> tuple[str, ...]:
        """Returns the joints that a command still moves, or tries to."""
        told = self.holding.told.tolist()
        return tuple([joint.name for joint, row in self._servoed if (joint.told(self) if row is None else told[row])])

    def set(self, word: str, *values: Any, **named: Any) -> None:
        """Gives a command, which holds at once and until another one replaces it.

        Args:
            word: One of `actuators`; see the functions in `actuators.py`.
            values: What it takes.
            named: The same, by name.

        Raises:
            WorldError: If this body has no such actuator or joint, or a value is not what it takes.
        """
        known(word, self.actuators, self.name, "actuator")
        ACTUATORS[word](self, *values, **named)

    def get(self, word: str, *values: Any, noise: Sd = None, **options: Any) -> Any:
        """Reads a sensor: plain numbers, tuples, dictionaries and frozen dataclasses.

        This is for minds. Who only looks on calls the functions of the `sensors` package (for contacts `touch.present`):
        they use up no random numbers and start no watch.

        Args:
            word: One of `sensors`; see the functions in the `sensors` package.
            values: What the sensor takes.
            noise: The standard deviation that is added to every number of the reading, in its unit, or by field; None is
                what the body's description says, if anything.
            options: The same, by name.

        Raises:
            WorldError: If there is no such sensor, or an option is not what it takes.
        """
        if word == "view" and word not in SENSORS:
            raise WorldError(f"{self.name}: the sensor 'view' is the camera's: import actr3d.camera before the world is made")
        known(word, self.sensors, self.name, "sensor")
        reading = SENSORS[word](self, *values, **options)
        sd = self._noise.get(word) if noise is None else noise
        return reading if sd is None else self.noise.added(word, reading, sd)

    def state(self) -> BodyState:
        """Returns what is not in the physics state: commands on their way, noise, what hands hold."""
        held = tuple((side, hand.held) for side, hand in self.hands.items() if hand.held is not None)
        senses = tuple((key, self._senses[key].state()) for key in self._used)
        return BodyState(
            running=self.running.state(),
            holding=self.holding.state(),
            noise=self.noise.state(),
            held=held,
            touched=self.touched,
            senses=senses,
        )

    def restore(self, state: BodyState) -> None:
        """Brings back a state of its own, after the physics state."""
        self.running.restore(state.running)
        self.holding.restore(state.holding)
        self.noise.restore(state.noise)
        self.touched = state.touched
        remembered = dict(state.senses)
        for make, parameters in remembered:
            self.sense(make, parameters)
        self._used = list(remembered)
        for key, sense in self._senses.items():
            sense.restore(remembered.get(key))
        held = dict(state.held)
        for side, hand in self.hands.items():
            hand.restore(held.get(side))

    @property
    def senses(self) -> tuple[Sense, ...]:
        """The senses that the agent has used up to the present and that remember something, in the order in which it first did."""
        return tuple(self._senses[key] for key in self._used)

    def sense(self, make: Callable[[Body, P], S], parameters: P) -> S:
        """Returns the one sense of its kind and parameters, for the agent's own use.

        Args:
            make: Makes it, of the body and the parameters.
            parameters: What distinguishes senses of one kind; hashable.
        """
        if (make, parameters) not in self._used:
            self._used.append((make, parameters))
        return self.unused_sense(make, parameters)

    def unused_sense(self, make: Callable[[Body, P], S], parameters: P) -> S:
        """Returns the same sense for an observer, who leaves it as it is: the agent does not count as having used it."""
        key = make, parameters
        if key not in self._senses:
            self._senses[key] = make(self, parameters)
        return cast("S", self._senses[key])

    def joint(self, name: str) -> Joint:
        """Returns a joint by name.

        Raises:
            WorldError: If it has no such joint.
        """
        return self.joints[known(name, self.joints, self.name, "joint")]

    def control(self, name: str) -> slice:
        """Returns where the controls of one of its actuators are in MuJoCo's `ctrl`; most have one.

        Raises:
            WorldError: If it has no such actuator.
        """
        return self.controls[known(name, self.controls, self.name, "control")]

    def free(self) -> bool:
        """Returns whether neither it nor what it holds touches anything else, at the present positions."""
        self.world.refresh()
        data = self.world.mj_data
        if data.ncon == 0:
            return True
        ours = self.sides(self.own())
        return not np.any(ours[:, 0] != ours[:, 1])

    def sides(self, own: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Returns for each contact which of its two sides (n, 2) are its own, given which geoms are; soft things have none."""
        geoms = self.world.mj_data.contact.geom
        soft = self.members[self.world.soft][self.world.mj_data.contact.flex] if len(self.world.soft) else False
        return np.where(geoms >= 0, own[geoms], soft)

    def own(self) -> NDArray[np.bool_]:
        """Returns for each geom of the world whether it is part of the body or held by it."""
        own: NDArray[np.bool_] = self.members[self.world.mj_model.geom_bodyid]
        for hand in self.hands.values():
            own[list(hand.geoms)] = True
        return own

    def short(self, name: str) -> str:
        """Returns a MuJoCo element's name as this body calls it."""
        return name.removeprefix(self.anatomy.prefix)

    def part_name(self, body: int) -> str:
        """Returns what one of its MuJoCo bodies is called."""
        return self.anatomy.base if body == self.root else self.short(self.world.mj_model.body(body).name or f"part_{body - self.root}")

    def part_number(self, part: str) -> int:
        """Returns the MuJoCo body of one of its parts."""
        return int(np.flatnonzero(self.members)[self.parts.index(part)])

    def geom_name(self, geom: int) -> str:
        """Returns what one of its geoms is called: its own name, else that of its part."""
        return self._geom_names[geom]

    def _geom_name(self, geom: int) -> str:
        model = self.world.mj_model
        return self.short(model.geom(geom).name) or self.part_name(int(model.geom_bodyid[geom]))

    def _feeling(self) -> NDArray[np.intp]:
        model = self.world.mj_model
        if self.anatomy.skin is not None:
            return np.array([self._id("geom", name) for name in self.anatomy.skin], dtype=np.intp)
        return self.geoms[(model.geom_contype[self.geoms] | model.geom_conaffinity[self.geoms]) != 0]

    def _joints(self) -> list[Joint]:
        model = self.world.mj_model
        kinds = (int(mjtJoint.mjJNT_HINGE), int(mjtJoint.mjJNT_SLIDE))
        numbers = [n for n in range(model.njnt) if self.members[model.jnt_bodyid[n]] and model.jnt_type[n] in kinds]
        return [Joint(self.world, n, self.short(model.joint(n).name) or f"joint_{n}") for n in numbers if n not in self.base.joints]

    def _controls(self) -> dict[str, slice]:
        """Returns where the controls are of the actuators that move it; a name alone may be that of `arm` or of `arm_2`."""
        model: Any = self.world.mj_model
        own = [n for n in range(model.nactuator) if self.members[moved_by(model, n)].any()]
        first, count = model.actuator_ctrladr, model.actuator_ctrlnum
        return {self.short(str(model.actuator(n).name)): slice(int(first[n]), int(first[n] + count[n])) for n in own}

    def _id(self, kind: str, name: str) -> int:
        try:
            return int(getattr(self.world.mj_model, kind)(name).id)
        except KeyError as error:
            raise WorldError(f"body '{self.name}': the compiled model has no {kind} '{name}'") from error
