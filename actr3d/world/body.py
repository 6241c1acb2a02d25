"""A body in a compiled world: its parts, its sensors and its commands."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar, cast

import mujoco
import numpy as np
from mujoco import mjtJoint, mjtObj
from numpy.typing import NDArray

from actr3d.errors import Actr3dError, WorldError, alternatives
from actr3d.values import BASIC
from actr3d.world.actuated_dofs import ActuatedDofs
from actr3d.world.anatomy import Anatomy, Embodied
from actr3d.world.base import Base
from actr3d.world.bounding_box import BoundingBox, Bounds
from actr3d.world.command_registry import CommandRegistry, checked_function, checked_name, checked_number
from actr3d.world.contacts import BodyContacts, Touch
from actr3d.world.frames import WORLD_FRAME, Frame, upright_frame
from actr3d.world.gait import OWN, STANCE, GaitCycle, standing
from actr3d.world.grasp import Hand, Held
from actr3d.world.joints import Joint
from actr3d.world.motion_commands import MotionCommands
from actr3d.world.physics import Physics
from actr3d.world.posture_hold import PostureHold
from actr3d.world.reach import reaches
from actr3d.world.sensor_noise import SensorNoise, StandardDeviation
from actr3d.world.velocity_servo import moved_by


@dataclass(frozen=True, kw_only=True)
class BodyState:
    """What a body needs to continue exactly, besides the physics: plain values, equal when the states are."""

    motion: tuple[Any, ...]
    """Unfinished commands, from `MotionCommands.state`."""

    hold: tuple[Any, ...]
    """Commanded speeds and held places, from `PostureHold.state`."""

    noise: tuple[tuple[str, int, int], ...]
    """Sensors with noise: the name and the state of its random numbers."""

    held: tuple[tuple[str, Held], ...]
    """What each hand holds and how."""

    touched: tuple[Touch, ...] | None
    """What the skin has felt in the last tick; None before the first reading."""

    senses: tuple[tuple[Any, Any], ...]
    """The state of each sense that has one."""


class Sense(Protocol):
    """A sense with a state that lasts from one reading to the next."""

    def state(self) -> Any:
        """Returns the state: plain values."""
        ...

    def restore(self, state: Any) -> None:
        """Restores a state; None resets it."""
        ...


MAX_CONTROL = float(mujoco.mjMAXVAL)
"""Greatest control of an actuator, in its own unit: beyond it MuJoCo switches all actuators off."""

S = TypeVar("S", bound=Sense)
P = TypeVar("P")


class Body:
    """Senses and moves one body of a world. Its parts are found in the compiled model; the description gives the rest.

    Commands are given between physics steps only. A reading is of the present state; nothing in it changes later.

    This is a body in the physical world. The `Body` of Python ACT-R, in a map of cells, is `ccm.lib.grid.Body` in model files.

    Args:
        physics: The compiled scene and its state.
        description: The part of the scene that the body was made from.
        seed: The seed of sensor noise.

    Raises:
        WorldError: If its root, or a joint of a named movement, is not in the compiled model.
    """

    def __init__(self, physics: Physics, description: Embodied, seed: int) -> None:
        self.physics = physics
        self.name = description.name
        self.anatomy: Anatomy = description.anatomy()
        self.root = self._id("body", self.anatomy.root)
        model = physics.mj_model
        self.members = np.zeros(model.nbody, dtype=bool)
        """By MuJoCo body: whether it is part of this one."""
        for member in range(self.root, model.nbody):
            self.members[member] = member == self.root or self.members[model.body_parentid[member]]
        self.geoms: NDArray[np.intp] = np.flatnonzero(self.members[model.geom_bodyid])
        self.parts: tuple[str, ...] = tuple(self.part_name(int(member)) for member in np.flatnonzero(self.members))
        self._geom_names = {geom: self._geom_name(geom) for geom in self.geoms.tolist()}
        self.base = Base(physics, self.root, self.anatomy.prefix)
        gait = self.anatomy.gait
        stepping = () if gait is None else OWN
        every = self._joints()
        self._every = {joint.name: joint for joint in every}
        """All joints by name."""
        self.joints: dict[str, Joint] = {joint.name: joint for joint in every if joint.name not in stepping}
        """By name, the joints that the agent can feel and move: those that only gait moves are left out."""
        for movement in self.anatomy.movements:
            for joint, _ in movement.joints:
                checked_name(joint, self.joints, f"{self.name}: movement '{movement.name}'", "joint")
        self.controls: dict[str, slice] = self._controls()
        self.eye = self.anatomy.eye
        self.touch_geoms: NDArray[np.intp] = self._touch_geoms()
        """The geoms that feel contacts."""
        skin = {geom: self.geom_name(geom) for geom in self.touch_geoms.tolist()}
        self.skin: tuple[str, ...] = tuple(skin.values())
        """Their names."""
        self.hands: dict[str, Hand] = {self._short(name).removesuffix("_hand"): Hand(physics, name) for name in self.anatomy.hands}
        self.contacts = BodyContacts(physics, self.members, skin, tuple(self.hands.values()))
        self.reaches = reaches(model, self.members, self.touch_geoms)
        """By moving part and degree of freedom (n, nv): how far the part's farthest point moves at most per unit of the latter [m]."""
        dofs = ActuatedDofs(physics, self.anatomy, self.base, every, self.members)
        cycle = None if gait is None else GaitCycle(*gait, dofs.joints, (seed, *self.name.encode()))
        self.hold = PostureHold(physics, self.members, dofs, self.base, self.contacts, cycle)
        self._places = np.array([joint.q for joint in self.joints.values()], dtype=np.intp)
        driven = [joint for joint in self.joints.values() if joint.driven]
        self._driven = tuple(joint.name for joint in driven)
        self._alone = [joint for joint in driven if self.hold.row(joint.name) is None]
        """The driven joints that `hold` does not control."""
        rows = [len(dofs.q) + self._alone.index(joint) if joint in self._alone else self.hold.row(joint.name) for joint in driven]
        self._rows = np.array(rows, dtype=np.intp)
        """By driven joint: its place among the rows of `hold` and these."""
        steering = self.anatomy.steering
        self.motion = MotionCommands(physics, self.root, self.base, self.joints, self.hold, steering, self.controls.get("brake"))
        self.touched: tuple[Touch, ...] | None = None
        """What the skin has felt in the last tick; None before the first reading."""
        self._senses: dict[Any, Sense] = {}
        """All that have been made."""
        self._used: list[Any] = []
        """The keys of those that the agent has used up to the present, in the order of first use."""
        self.noise = SensorNoise(seed, self.name)
        self.bounds = Bounds(model, physics.mj_data, self.geoms)
        self._actuators = ACTUATORS.of(self)
        self._sensors = SENSORS.of(self)
        self._noise: dict[str, StandardDeviation] = {
            name: dict(sd) if isinstance(sd, tuple) else checked_number(sd, f"{self.name}: noise of {name}", 0)
            for name, sd in self.anatomy.noise
        }
        for name, sd in self._noise.items():
            self._check_noise(checked_name(name, self._sensors, self.name, "sensor"), sd)

    def _check_noise(self, sensor: str, sd: StandardDeviation) -> None:
        """Checks that noise can be added to the readings of a sensor.

        Raises:
            WorldError: If readings of the sensor take no such noise.
        """
        assert sd is not None
        with self._unchanged():
            try:
                reading = self._sensors[sensor](self)
            except Actr3dError:  # it needs values, or something that this computer does not have
                return
            self.noise.added(sensor, reading, sd)

    # -- commands and sensors

    @property
    def actuators(self) -> tuple[str, ...]:
        """The names of its commands. What they do stays the same for this body if the text of another model defines one of them later."""
        return tuple(self._actuators)

    @property
    def sensors(self) -> tuple[str, ...]:
        """The names of its sensors. What they sense stays the same for this body if the text of another model defines one of them later."""
        return tuple(self._sensors)

    def set(self, word: str, *values: Any, **named: Any) -> None:
        """Carries out a command. It takes effect immediately, and lasts until another command of its kind replaces it.

        Args:
            word: Its name, one of `actuators`; see the functions in `actr3d.world.actuators`.
            values: Its values.
            named: The same, by name.

        Raises:
            WorldError: If this body has no such actuator or joint, or a value is wrong, or an observer calls this.
        """
        if self.physics.observed:
            raise WorldError(f"{self.name}: an observer cannot give commands (given '{word}'); call simulation.command after the run")
        if isinstance(word, str) and word in ACTUATORS and word not in self._actuators:  # pyright: ignore[reportUnnecessaryIsInstance]
            self._actuators = ACTUATORS.of(self) | self._actuators  # the module that registers it may have been imported since
        checked_function(word, self._actuators, self.name, "actuator")(self, *values, **named)

    def get(self, word: str, *values: Any, noise: StandardDeviation = None, **options: Any) -> Any:
        """Returns a reading of a sensor: plain numbers, tuples, dictionaries and frozen dataclasses.

        A reading changes what the agent senses later: it draws noise, and it starts senses that have a state. A reading by an observer of
        the simulation, or by a condition of `Simulation.run`, changes nothing.

        Args:
            word: Its name, one of `sensors`; see the functions in the `sensors` package.
            values: Its values.
            noise: The standard deviation of noise on every number of the reading, in its unit, or by field; None uses that of
                the body's description, if any.
            options: The same values, by name.

        Raises:
            WorldError: If there is no such sensor, or an option is wrong.
        """
        if isinstance(word, str) and word not in self._sensors and word in SENSORS:  # pyright: ignore[reportUnnecessaryIsInstance]
            self._sensors = SENSORS.of(self) | self._sensors
        if self.physics.observed:
            with self._unchanged():
                return self._read(word, values, noise, options)
        return self._read(word, values, noise, options)

    def _read(self, word: str, values: tuple[Any, ...], noise: StandardDeviation, options: dict[str, Any]) -> Any:
        """Returns what `get` does; the reading may change what the agent senses later."""
        reading = _without_arrays(checked_function(word, self._sensors, self.name, "sensor")(self, *values, **options))
        sd = self._noise.get(word) if noise is None else noise
        return reading if sd is None else self.noise.added(word, reading, sd)

    @contextmanager
    def _unchanged(self) -> Generator[None]:
        """Restores after the block what later readings depend on."""
        noise, touched, senses = self.noise.state(), self.touched, self._state_of_senses()
        try:
            yield
        finally:
            self.noise.restore(noise)
            self.touched = touched
            self._restore_senses(senses)

    def positions(self) -> tuple[float, ...]:
        """Returns the positions of its joints, in their order [rad] or [m]."""
        return tuple(self.physics.mj_data.qpos[self._places].tolist())

    def moving(self) -> tuple[str, ...]:
        """Returns the joints whose commanded speed is not 0, whether they really move or not."""
        speeds = self.hold.commanded
        if self._alone:
            speeds = np.append(speeds, [joint.control for joint in self._alone])
        return tuple([self._driven[number] for number in speeds[self._rows].nonzero()[0].tolist()])

    def fastest(self) -> tuple[float, float, float]:
        """Returns the greatest speeds that it can be commanded to walk [m/s], to turn [rad/s] and to turn a joint [rad/s]."""
        return self.anatomy.fastest or (MAX_CONTROL, MAX_CONTROL, MAX_CONTROL)

    # -- senses with a state

    @property
    def senses(self) -> tuple[Sense, ...]:
        """The senses with a state that the agent has used up to the present, in the order of first use."""
        return tuple(self._senses[key] for key in self._used)

    def sense(self, make: Callable[[Body, P], S], parameters: P) -> S:
        """Returns the one sense of a kind with these parameters, for the agent's own use.

        Args:
            make: Makes it, from the body and the parameters.
            parameters: Distinguish senses of one kind; hashable.
        """
        if (make, parameters) not in self._used:
            self._used.append((make, parameters))
        return self.unused_sense(make, parameters)

    def unused_sense(self, make: Callable[[Body, P], S], parameters: P) -> S:
        """Returns the same sense for an observer, who must leave its state unchanged; it does not count as used by the agent."""
        key = make, parameters
        if key not in self._senses:
            self._senses[key] = make(self, parameters)
        return cast("S", self._senses[key])

    # -- the state

    def state(self) -> BodyState:
        """Returns what is not in the physics state: unfinished commands, noise, held objects, senses."""
        held = tuple((side, hand.held) for side, hand in self.hands.items() if hand.held is not None)
        return BodyState(
            motion=self.motion.state(),
            hold=self.hold.state(),
            noise=self.noise.state(),
            held=held,
            touched=self.touched,
            senses=self._state_of_senses(),
        )

    def restore(self, state: BodyState) -> None:
        """Restores a state of this body, after the physics state."""
        self.motion.restore(state.motion)
        self.hold.restore(state.hold)
        self.noise.restore(state.noise)
        self.touched = state.touched
        self._restore_senses(state.senses)
        held = dict(state.held)
        for side, hand in self.hands.items():
            hand.restore(held.get(side))

    def _state_of_senses(self) -> tuple[tuple[Any, Any], ...]:
        """Returns the state of each sense that the agent has used, by its key."""
        return tuple((key, self._senses[key].state()) for key in self._used)

    def _restore_senses(self, states: tuple[tuple[Any, Any], ...]) -> None:
        """Restores what `_state_of_senses` returned; all other senses count as unused."""
        remembered = dict(states)
        for make, parameters in remembered:
            self.sense(make, parameters)
        self._used = list(remembered)
        for key, sense in self._senses.items():
            sense.restore(remembered.get(key))

    # -- elements by name

    def joint(self, name: str) -> Joint:
        """Returns a joint by name.

        Raises:
            WorldError: If it has no such joint.
        """
        return self.joints[checked_name(name, self.joints, self.name, "joint")]

    def control(self, name: str) -> slice:
        """Returns where the controls of one of its actuators are in MuJoCo's `ctrl`; most have one.

        Raises:
            WorldError: If it has no such actuator.
        """
        return self.controls[checked_name(name, self.controls, self.name, "control")]

    def part_name(self, body: int) -> str:
        """Returns the name of one of its MuJoCo bodies."""
        return self.anatomy.base if body == self.root else self._short(self.physics.mj_model.body(body).name or f"part_{body - self.root}")

    def part_number(self, part: str | None) -> int:
        """Returns the MuJoCo body of one of its parts; None is the base.

        Raises:
            WorldError: If it has no such part.
        """
        if part is None or part == self.anatomy.base:
            return self.root
        return int(np.flatnonzero(self.members)[self.parts.index(checked_name(part, self.parts, self.name, "part"))])

    def geom_name(self, geom: int) -> str:
        """Returns the name of one of its geoms: its own name, else that of its part."""
        return self._geom_names[geom]

    # -- geometry

    def bounding_box(self, frame: str = "world", positions: Mapping[str, float] | None = None) -> BoundingBox:
        """Returns the smallest box around all of the body and what it holds, exactly, in its present posture or another one.

        Args:
            frame: `"world"`; `"body"`: at the base, along its heading, upright; or the name of one of its parts or
                sites, or of any site or body in the world.
            positions: By joint, its position in the other posture [rad] or [m]; the other joints are as they are, and it stands. Nothing
                moves in the world, and forces are left out: a `Load` goes with the part that carries it, and does not hold the arms back.

        Raises:
            WorldError: If there is no such frame or joint; or if the hands have grasped an object, whose place in another posture is not
                known.
        """
        if positions:
            with self._posed(positions):
                return self.bounding_box(frame)
        self.physics.refresh_positions()
        return self.bounds.box(*self.frame(frame), self.contacts.held())

    @contextmanager
    def _posed(self, positions: Mapping[str, float]) -> Generator[None]:
        """Sets joints to other positions [rad] or [m] during the block, and the legs as they are when it stands so."""
        if self.contacts.held():
            raise WorldError(f"{self.name}: its size in another posture is not known while it holds an object")
        names, added = self.hold.added_by_gait
        there = {name: self.joints[name].position - by for name, by in zip(names, added.tolist(), strict=True) if name in self.joints}
        there |= {name: at for name, at in positions.items() if self.joint(name)}
        if self.anatomy.gait is not None:
            there |= standing(there[STANCE] if STANCE in there else self._every[STANCE].position)
        qpos = self.physics.mj_data.qpos
        before = qpos.copy()
        qpos[[self._every[name].q for name in there]] = list(there.values())
        self.physics.changed()
        try:
            yield
        finally:
            qpos[:] = before
            self.physics.changed()

    def frame(self, name: str) -> Frame:
        """Returns a frame at the positions of the last refresh.

        Args:
            name: `"world"`, `"body"`, a part or site of the body, or any other site or body. `"body"` is at the base of the body with
                x along its heading and z up; the frame of the base itself tilts with it.

        Raises:
            WorldError: If there is no frame of this name.
        """
        if not isinstance(name, str):  # pyright: ignore[reportUnnecessaryIsInstance] # an agent's code may give anything
            raise WorldError(f"{self.name}: a frame is named by text (got {name!r})")
        data = self.physics.mj_data
        if name == "world":
            return WORLD_FRAME
        if name == "body":
            return upright_frame(data, self.root)
        if name == self.anatomy.base:
            return (data.xpos[self.root], data.xmat[self.root].reshape(3, 3))
        model: Any = self.physics.mj_model
        for called in (self.anatomy.prefix + name, name):
            site = mujoco.mj_name2id(model, mjtObj.mjOBJ_SITE, called)
            if site >= 0:
                return (data.site_xpos[site], data.site_xmat[site].reshape(3, 3))
            body = self.part_number(name) if name in self.parts else mujoco.mj_name2id(model, mjtObj.mjOBJ_BODY, called)
            if body >= 0:
                return (data.xpos[body], data.xmat[body].reshape(3, 3))
        names = ["world", "body", *self.parts]
        raise WorldError(f"{self.name}: no frame, part or site '{name}'{alternatives(name, names)}")

    # -- the compiled model

    def _short(self, name: str) -> str:
        """Returns a MuJoCo element's name without the body's prefix."""
        return name.removeprefix(self.anatomy.prefix)

    def _geom_name(self, geom: int) -> str:
        model = self.physics.mj_model
        return self._short(model.geom(geom).name) or self.part_name(int(model.geom_bodyid[geom]))

    def _touch_geoms(self) -> NDArray[np.intp]:
        if self.anatomy.skin is not None:
            return np.array([self._id("geom", name) for name in self.anatomy.skin], dtype=np.intp)
        return self.geoms[self.physics.solid[self.geoms]]

    def _joints(self) -> list[Joint]:
        model = self.physics.mj_model
        kinds = (int(mjtJoint.mjJNT_HINGE), int(mjtJoint.mjJNT_SLIDE))
        numbers = [n for n in range(model.njnt) if self.members[model.jnt_bodyid[n]] and model.jnt_type[n] in kinds]
        numbers = [n for n in numbers if n not in self.base.joints]
        names = _named("joint", [self._short(str(model.joint(n).name)) for n in numbers])
        return [Joint(self.physics, n, name) for n, name in zip(numbers, names, strict=True)]

    def _controls(self) -> dict[str, slice]:
        """Returns where the controls are of the actuators that move it.

        These are found by what they move, and not by the prefix of their names: `arm_` begins the names of a body `arm_2`, too.
        """
        model: Any = self.physics.mj_model
        own = [n for n in range(model.nactuator) if self.members[moved_by(model, n)].any()]
        first, count = model.actuator_ctrladr, model.actuator_ctrlnum
        names = _named("control", [self._short(str(model.actuator(n).name)) for n in own])
        return {name: slice(int(first[n]), int(first[n] + count[n])) for n, name in zip(own, names, strict=True)}

    def _id(self, kind: str, name: str) -> int:
        try:
            return int(getattr(self.physics.mj_model, kind)(name).id)
        except KeyError as error:
            raise WorldError(f"body '{self.name}': the compiled model has no {kind} '{name}'") from error


def _without_arrays(reading: Any) -> Any:
    """Returns a reading with tuples and numbers of Python instead of those of numpy: an array of MuJoCo changes with the next step."""
    kind = cast("type[Any]", type(reading))
    if issubclass(kind, (np.ndarray, np.generic)):
        return _tuples(reading.tolist())
    if kind is dict and not BASIC.issuperset(map(type, reading.values())):
        return {key: _without_arrays(item) for key, item in reading.items()}
    if kind in (tuple, list) and not BASIC.issuperset(map(type, reading)):
        return cast("Any", kind)(map(_without_arrays, reading))
    return reading


def _tuples(items: Any) -> Any:
    """Returns nested lists as tuples."""
    return tuple(map(_tuples, cast("list[Any]", items))) if isinstance(items, list) else items


def _named(kind: str, names: list[str]) -> list[str]:
    """Returns the names of elements of a body; those without one are called by their kind and number, or the next number that is free."""
    found, taken = list[str](), set(names)
    for at, name in enumerate(names):
        called = name or next(free for n in itertools.count(at) if (free := f"{kind}_{n}") not in taken)
        found.append(called)
        taken.add(called)
    return found


ACTUATORS = actuator = CommandRegistry[Body]("actuator")
"""The actuators of bodies by name; also the decorator `@actuator` that registers one. See `actr3d.world.actuators`."""

SENSORS = sensor = CommandRegistry[Body]("sensor")
"""The sensors of bodies by name; also the decorator `@sensor` that registers one. See `actr3d.world.sensors`."""
