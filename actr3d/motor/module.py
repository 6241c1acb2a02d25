"""The motor module: commands by name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from math import copysign, radians
from typing import Any

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.declarative.memory import Memory
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.parameters import named_parameters
from actr3d.errors import ParameterError, SimulationError, WorldError
from actr3d.motor.limbs import FINEST, BodyPart, Freedom, Limbs
from actr3d.motor.movement import INFINITE, JointMovement, Movement, Turn, Walk
from actr3d.motor.muscles import Muscles
from actr3d.world.words import known, number

HUGE = 1e9
"""Every parameter is below this."""


class Motor(Muscles):
    """Moves the body of its agent, and learns what the body is like in each posture.

    Commands begin a movement and return at once. Each goes on at a constant speed until it is done, until `stop`, until
    the joint's limit, or until something in the way has held it for a while; `<group>_end` says which: «done», «stopped»,
    «limit» or «blocked». There is one muscle group for each part with joints, and one for the legs; groups move at once.

    Productions match `busy`, and `<group>_busy` of each muscle group; `error` after a command was refused, and `refusal`,
    «busy» or «limit»; `walking` and `turning`; what is felt, `<joint>_angle` [degrees], `width`, `depth` and `height` [m].
    Names that the body does not know, and values that are none, are errors.

    The body tells what it consists of in the first tick; what is commanded before begins 10 ms after the start. While
    something moves, the body is felt at the end of each tick, and a run that has no end goes on; else nothing costs time.

    Angles are degrees in commands, attributes and posture chunks, radians in `body` and `joint()`. Numbers may be text.

    Args:
        buffer: Where each posture goes that is stored; None for nowhere.
        memory: The declarative memory that keeps postures; None for none. (By the rules of ACT-R 7 a memory collects what leaves
            buffers; there a buffer alone is enough.)
        speed: How fast joints and the whole body turn unless told otherwise [degrees/s].
            Source: the original ACT-R 3D's torso and clavicle (human-data).
        angle_grid: What felt angles are rounded to [degrees]; this and the next two hold from when the body is known.
        size_grid: What felt lengths are rounded to [m]. Ours: fine enough for judging a doorway to a hundredth of the shoulders.
        extreme_step: How much further than ever a joint has to go for its posture to be stored on the way [degrees]; None
            for never. Source: ours; about the ten samples to each side that the original took.
        angle_noise: The standard deviation of felt angles [degrees].
        size_noise: The standard deviation of felt width, depth and height [m].
        patience: How long a movement may fail to advance before it ends as «blocked» [s]; None for ever. It is told after at
            most three times that. Ours.
        preparation: How long a command is prepared [s]. Source: 0 as in the original; ACT-R prepares 0.05 s for each feature
            that is new, 0.25 s for a whole hand movement (Byrne & Anderson, 1998).
        initiation: How long it takes to begin after that [s]. Source: 0 as in the original; 0.05 s in ACT-R.

    Raises:
        ParameterError: If a parameter is not what it should be.
    """

    @named_parameters
    def __init__(
        self,
        buffer: Any = None,
        memory: Any = None,
        speed: float = 120.0,
        angle_grid: float = 1.0,
        size_grid: float = 0.001,
        extreme_step: float | None = 10.0,
        angle_noise: float = 0.0,
        size_noise: float = 0.0,
        patience: float | None = 0.1,
        preparation: float = 0.0,
        initiation: float = 0.0,
    ) -> None:
        super().__init__(buffer, memory)
        for name, given, kind in (("buffer", buffer, Buffer), ("memory", memory, Memory)):
            if given is not None and not isinstance(given, kind):
                raise ParameterError(f"Motor.{name}: must be a {kind.__name__}, or None (got {given!r})")
        grids = {"angle_grid": angle_grid, "size_grid": size_grid}
        above = {"speed": speed, "extreme_step": extreme_step, "patience": patience, **grids}
        from_0 = {"angle_noise": angle_noise, "size_noise": size_noise, "preparation": preparation, "initiation": initiation}
        for name, value in {**above, **from_0}.items():
            if value is not None and not (0 <= value < HUGE and (value > 0 or name in from_0)):
                bounds = "at least 0" if name in from_0 else "above 0"
                raise ParameterError(f"Motor.{name}: must be {bounds}, and below {HUGE:g} (got {value!r})")
        for name, grid in grids.items():
            if grid < FINEST:
                raise ParameterError(f"Motor.{name}: must be at least {FINEST:g} (got {grid!r})")
        self.speed = speed
        self.angle_grid = angle_grid
        self.size_grid = size_grid
        self.extreme_step = extreme_step
        self.angle_noise = angle_noise
        self.size_noise = size_noise
        self.patience = patience
        self.preparation = preparation
        self.initiation = initiation

    # -- what is known of the body

    @property
    def body(self) -> BodyPart:
        """The body as it is known now: its base, with the parts that it carries. Radians and metres.

        Raises:
            SimulationError: If the body has not told what it is yet.
        """
        return self._known().tree()

    def joint(self, name: str) -> Freedom:
        """Returns a joint as it is known now: where it is, its limits, how far it has been. Radians.

        Raises:
            SimulationError: If the body has not told what it is yet.
            WorldError: If it has no such joint.
        """
        return self._known().freedom(name)

    def _known(self) -> Limbs:
        if self._limbs is None or self._schema is None:
            raise SimulationError(f"'{self._path}' does not know its body yet; that tells what it is in the first tick of a Simulation")
        return self._limbs

    # -- legs

    def walk(self, speed: Any) -> None:
        """Walks at a speed [m/s], backward where it is negative, until told to stop; while walking, at another speed from now on.

        Raises:
            WorldError: If the speed is no number, or the body cannot walk.
        """
        self._command(partial(self._walk, number(speed, "walk: speed")), "walk", speed=speed)

    def turn(self, angle: Any = None, speed: Any = None) -> None:
        """Turns the whole body, also while it walks.

        Args:
            angle: By how much [degrees, left is positive]; None until told to stop.
            speed: How fast [degrees/s]; negative for to the right where there is no angle.

        Raises:
            WorldError: If a value is no number, or the body cannot walk.
        """
        by = None if angle is None else radians(number(angle, "turn: angle"))
        rate = radians(self._speed("turn", speed, by is not None))
        self._command(partial(self._turn, by, rate), "turn", angle=angle, speed=speed)

    def stop(self, *groups: Any) -> None:
        """Stops what some muscle groups do, at once, or all of the body.

        Raises:
            WorldError: If there is no such muscle group.
        """
        self._command(partial(self._stop, groups), "stop", groups=list(groups))

    def _walk(self, speed: float, place: str) -> None:
        self._need("walk")
        self._known().possible("walk", speed, 0, 1.0)
        walk = self._under_way.get("walk")
        if speed == 0:
            self._halt(["walk"] if walk else [], place)
        elif isinstance(walk, Walk) and walk.begun:
            self._under_way["walk"] = Walk(speed, place)
            self._launch("walk", self._under_way["walk"])
        else:
            self._begin({"walk": Walk(speed, place)})

    def _turn(self, angle: float | None, rate: float, place: str) -> None:
        self._need("walk")
        self._known().possible("turn", rate, 1, radians(1))
        self._begin({"turn": Turn(angle, rate, place)})

    def _stop(self, groups: Sequence[Any], place: str) -> None:
        plan = self._known().plan
        for group in groups:
            known(group, self._known().groups, plan.name, "muscle group")
        self._halt([key for key, movement in self._under_way.items() if not groups or movement.group in groups], place)
        if not groups and "stop" in plan.actuators:
            self._tell("stop", place=place)

    def _need(self, word: str) -> None:
        """Checks that the body can do something.

        Raises:
            WorldError: If it cannot.
        """
        plan = self._known().plan
        if word not in plan.actuators:
            raise WorldError(f"{plan.name} cannot {word}; it can be told: {', '.join(plan.actuators) or 'nothing'}")

    # -- limbs

    def rotate(self, joint: Any, axis: Any = None, angle: Any = None, speed: Any = None) -> None:
        """Turns one joint.

        Args:
            joint: A joint, or a part and `axis`.
            axis: Of a part's joints, the one that turns about it: `yaw`, `pitch` or `roll`, or slides along `x`, `y` or `z`.
            angle: To which angle [degrees], or position of one that slides [m]; None until its limit, or until told to stop.
            speed: How fast [degrees/s], negative for towards smaller angles where there is no angle; [m/s] where it slides, and
                needed there.

        Raises:
            WorldError: If there is no such joint, it has no muscles, or a value is not what it should be.
        """
        pace = self._speed("rotate", speed, angle is not None)
        usual = speed is None
        to = None if angle is None else number(angle, "rotate: angle")
        self._command(partial(self._rotate, joint, axis, to, pace, usual), "rotate", joint=joint, axis=axis, angle=angle, speed=speed)

    def move(self, movement: Any, side: Any = None, angle: Any = None, speed: Any = None) -> None:
        """Makes a movement that the body has a name for.

        Args:
            movement: Which.
            side: Which side, where there is one on each: `left` or `right`.
            angle: To which angle [degrees], in the movement's own direction; None until the limit, or until told to stop.
            speed: How fast [degrees/s]; negative for the other direction where there is no angle.

        Raises:
            WorldError: If the body has no such movement, or a value is not what it should be.
        """
        pace = self._speed(str(movement), speed, angle is not None)
        to = None if angle is None else number(angle, f"{movement}: angle")
        self._command(partial(self._move, movement, side, to, pace), "move", movement=movement, side=side, angle=angle, speed=speed)

    def rotate_torso(self, angle: Any = None, speed: Any = None) -> None:
        """Turns the torso to an angle [degrees, left is positive], or until its limit; see `move`."""
        self.move("rotate_torso", None, angle, speed)

    def extend_shoulder(self, side: Any, angle: Any = None, speed: Any = None) -> None:
        """Brings a shoulder forward, to an angle [degrees], or until its limit; see `move`."""
        self.move("extend_shoulder", side, angle, speed)

    def compress_shoulder(self, side: Any, angle: Any = None, speed: Any = None) -> None:
        """Brings a shoulder backward, to an angle [degrees], or until its limit; see `move`."""
        self.move("compress_shoulder", side, angle, speed)

    def lower_arms(self, speed: Any = None) -> None:
        """Lowers both arms to where they hang; see `move`."""
        self.move("lower_arms", None, None, speed)

    def assume(self, posture: Any, speed: Any = None) -> None:
        """Brings joints to where they are in a posture, such as one that was retrieved; other slots do not matter.

        Args:
            posture: A buffer that holds it, a chunk, a mapping, or text: joints with angles [degrees], or positions [m].
            speed: How fast each joint moves [degrees/s] or [m/s].

        Raises:
            ChunkError: If it is no posture.
            WorldError: If it names no joint of the body, or a value is not what it should be.
        """
        pace = self._speed("assume", speed, True)
        wanted = Chunk(posture, self.sch.bound)
        self._command(partial(self._assume, wanted, pace), "assume", posture=wanted, speed=speed)

    def feel(self, name: str = "felt") -> None:
        """Feels the body at the end of this tick, and stores that posture under a name.

        Raises:
            WorldError: If the name is no text.
        """
        if not isinstance(name, str) or not name.strip():  # pyright: ignore[reportUnnecessaryIsInstance] # it may come from a mind
            raise WorldError(f"feel: name: must be what the posture is to be called (got {name!r})")
        self._command(partial(self._want, name), "feel", name=name)

    def _want(self, name: str, place: str) -> None:
        self._wanted.append(name)
        self._ask()

    def _rotate(self, joint: Any, axis: Any, to: float | None, pace: float, usual: bool, place: str) -> None:
        limbs = self._known()
        name = limbs.joint(joint, axis)
        if usual and limbs.joints[name].kind == "slide":
            raise WorldError(f"{limbs.plan.name}: joint '{name}' slides; say how fast [m/s]: rotate('{name}', speed=…)")
        target = limbs.limit(name, pace) if to is None else to * limbs.unit[name]
        self._turn_joints(name, {name: copysign(INFINITE, pace) if target is None else target}, pace, to is None, place)

    def _move(self, movement: Any, side: Any, to: float | None, pace: float, place: str) -> None:
        limbs = self._known()
        named = limbs.movement(movement, side)
        if named.to is not None and (to is not None or pace < 0):
            raise WorldError(f"{movement} always ends in the same posture: it takes no angle, and a speed above 0")
        ways: dict[str, float] = {}
        for joint, way in named.joints:
            limit = limbs.limit(joint, way * pace)
            end = copysign(INFINITE, way * pace) if limit is None else limit
            ways[joint] = way * named.to if named.to is not None else end if to is None else way * to * limbs.unit[joint]
        name = movement if named.side is None else f"{movement}_{named.side}"
        self._turn_joints(name, ways, pace, to is None and named.to is None, place)

    def _assume(self, posture: Chunk, pace: float, place: str) -> None:
        limbs = self._known()
        ways = {joint: number(posture[joint], f"assume: {joint}") * limbs.unit[joint] for joint in limbs.order if joint in posture}
        if not ways:
            raise WorldError(f"assume: '{posture}' names no joint of {limbs.plan.name}; it has {', '.join(limbs.order) or 'none'}")
        self._turn_joints("assume", ways, pace, False, place)

    def _turn_joints(self, name: str, ways: Mapping[str, float], pace: float, to_limit: bool, place: str) -> None:
        """Turns joints to positions [rad] or [m], together: one movement for each muscle group."""
        limbs = self._known()
        by_group: dict[str, dict[str, float]] = {}
        for joint, target in ways.items():
            if not limbs.joints[joint].driven:
                raise WorldError(f"{limbs.plan.name}: joint '{joint}' has no muscles that could move it")
            limbs.possible(name, pace * limbs.unit[joint], 2, limbs.unit[joint])
            if abs(target) < INFINITE and not limbs.inside(joint, target):
                self._refuse(name, "limit")
                return
            by_group.setdefault(limbs.group_of[joint], {})[joint] = target
        movements: dict[str, Movement] = {}
        for group, targets in by_group.items():
            speed = abs(pace) * limbs.unit[next(iter(targets))]
            movements[group] = JointMovement(name, group, speed, place, ways=targets, order=limbs.order, to_limit=to_limit)
        self._begin(movements)

    def _speed(self, call: str, speed: Any, bounded: bool) -> float:
        """Returns a speed as people give it, or the usual one.

        Raises:
            WorldError: If it is no number, 0, or negative where there is an angle to go to.
        """
        given = self.speed if speed is None else number(speed, f"{call}: speed")
        if given == 0 or (bounded and given < 0):
            raise WorldError(f"{call}: speed: must {'be above 0 to go to an angle' if bounded else 'not be 0'} (got {speed!r})")
        return given
