"""The motor module: commands by name, movements in progress, and what is felt of the body."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from math import copysign, radians
from operator import attrgetter
from typing import Annotated, Any

from annotated_types import Ge, Gt, Lt

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.declarative.memory import Memory, collect
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.parameters import WithParameters, named_parameters
from actr3d.actr.modules.port import CallSite, Port, Request, note_request
from actr3d.clock import seconds
from actr3d.errors import SimulationError, WorldError
from actr3d.motor.checks import check_joints, check_patterns
from actr3d.motor.limbs import BASE_GROUP, FINEST, BodyPart, DegreeOfFreedom, Limbs
from actr3d.motor.movement import INFINITE, JointMovement, Movement, Order, Step, Turn, Walk, gait
from actr3d.motor.schema import SIZES, BodySchema
from actr3d.world.actuators.motion import MOST_TURNS
from actr3d.world.command_registry import checked_name, checked_number
from actr3d.world.sensors.anatomy import BodyPlan
from actr3d.world.sensors.proprioception import Proprioception, SizeInPosture

HUGE = 1e9
"""All parameters are less than this."""
Positive = Annotated[float, Gt(0), Lt(HUGE)]
"""A speed, distance or time > 0."""
FromZero = Annotated[float, Ge(0), Lt(HUGE)]
"""A time or the scale of noise, >= 0."""
Grid = Annotated[float, Ge(FINEST), Lt(HUGE)]
"""The step to which numbers are rounded."""

_sizes_of: Callable[[Proprioception], tuple[float, ...]] = attrgetter(*SIZES)

_NOTHING = object()


class Motor(WithParameters, Port):
    """Moves the agent's body, and learns the size of the body in each posture.

    It is for agents with a body in a physical world. `from actr3d.motor import Motor` after `from actr3d.actr import *` replaces the
    `Motor` of Python ACT-R, which presses keys.

    Commands begin a movement and return at once. A movement continues at a constant speed until it is done, until `stop`, until
    the joint's limit, or until an obstacle has blocked it for a while; `<group>_end` holds the reason: «done», «stopped»,
    «limit» or «blocked». There is one muscle group for each part with joints, and one for the legs; groups move in parallel.
    A group carries out one movement at a time; the legs walk and turn in parallel.

    Productions match `busy`, and `<group>_busy` of each muscle group; `error` after a refused command, and `refusal`,
    «busy» or «limit»; `walking` and `turning`; felt values, `<joint>_angle` [degrees], or `<joint>_position` [m] of a joint that
    slides, `width`, `depth` and `height` [m], and `middle`, how far the middle of that width is to the left of the base [m].
    Unknown names and invalid values raise errors.

    The module learns what the body consists of in the first tick; earlier commands begin after it. While
    something moves, it feels the body at the end of each tick, and a run without an end continues; at other times it does nothing.

    Angles are degrees and lengths metres in commands, attributes and posture chunks; radians in `body` and `joint()`. Numbers may be text.

    Args:
        buffer: Receives each stored posture; None for none.
        memory: The declarative memory that stores postures; None for none. (In the ACT-R 7 profile a memory also collects the chunks that
            leave buffers; there, `buffer` without `memory` is enough.)
        speed: Default speed of joints and of turns of the whole body [degrees/s].
            Source: the original ACT-R 3D's torso and clavicle (docs/human-data.md).
        angle_grid: Step to which felt angles are rounded [degrees]; this and the next three apply once the body is known.
        size_grid: Step to which felt lengths are rounded [m]. Source: chosen, fine enough to judge a doorway to a hundredth of the
            shoulder width.
        extreme_step: Distance beyond its former extreme at which a moving joint's posture is stored [degrees]; None for never. Source:
            chosen; it gives about ten postures to each side, as in the original.
        extreme_slide: The same for a joint that slides [m]. Source: chosen.
        angle_noise: The standard deviation of felt angles [degrees].
        size_noise: The standard deviation of felt width, depth, height and middle, and of the positions of slides [m].
        patience: Time without progress after which a movement ends as «blocked» [s]; None for never. Detection takes
            at most three times as long. Source: chosen.
        preparation: Preparation time of a command [s]. Source: 0 as in the original; ACT-R prepares 0.05 s for each feature
            that is new, 0.25 s for a whole hand movement (Byrne & Anderson, 1998). A change of speed is prepared too; `stop` is not.
        initiation: Time from the end of preparation to the start [s]. Source: 0 as in the original; 0.05 s in ACT-R.

    Raises:
        ParameterError: If a parameter is invalid.
    """

    _slots = frozenset({"posture", "end", "extreme", *SIZES})

    @named_parameters
    def __init__(
        self,
        buffer: Buffer | None = None,
        memory: Memory | None = None,
        speed: Positive = 120.0,
        angle_grid: Grid = 1.0,
        size_grid: Grid = 0.001,
        extreme_step: Positive | None = 10.0,
        extreme_slide: Positive | None = 0.02,
        angle_noise: FromZero = 0.0,
        size_noise: FromZero = 0.0,
        patience: Positive | None = 0.1,
        preparation: FromZero = 0.0,
        initiation: FromZero = 0.0,
    ) -> None:
        self._buffer = buffer
        self._memory = memory
        self._limbs: Limbs | None = None
        self._schema: BodySchema | None = None
        self._waiting: list[tuple[Callable[[CallSite | None], None], CallSite | None]] = []
        self._under_way: dict[str, Movement] = {}
        self._ended: list[tuple[Movement, str]] = []
        self._asked = False
        self._wanted: list[str] = []
        self._known: list[tuple[str, dict[str, float]]] = []
        self._further: Sequence[str] = ()
        self._positions: tuple[float, ...] = ()
        self._sizes: tuple[float, ...] = ()
        self._felt_us = 0
        self.busy = False
        self.error = False
        self.refusal: str | None = None
        self.walking = False
        self.turning = False
        self.width: float | None = None
        self.depth: float | None = None
        self.height: float | None = None
        self.middle: float | None = None
        self.speed = speed
        self.angle_grid = angle_grid
        self.size_grid = size_grid
        self.extreme_step = extreme_step
        self.extreme_slide = extreme_slide
        self.angle_noise = angle_noise
        self.size_noise = size_noise
        self.patience = patience
        self.preparation = preparation
        self.initiation = initiation

    # -- the known body

    @property
    def body(self) -> BodyPart:
        """The present knowledge of the body: its base, with the parts that it carries. Radians and metres.

        Raises:
            SimulationError: If the body is not known yet.
        """
        return self._felt().tree()

    def joint(self, name: str) -> DegreeOfFreedom:
        """Returns the present knowledge of a joint: its position, limits and extremes. Radians.

        Raises:
            SimulationError: If the body is not known yet.
            WorldError: If it has no such joint.
        """
        return self._felt().degree_of_freedom(name)

    def _felt(self) -> BodySchema:
        if self._schema is None:
            raise SimulationError(f"'{self._path}' does not know its body yet; it learns about it in the first tick of a Simulation")
        return self._schema

    # -- legs

    def walk(self, speed: Any) -> None:
        """Walks at a speed [m/s], backward if negative, until `stop`; while walking, it changes the speed.

        Raises:
            WorldError: If the speed is not a number, or the body cannot walk.
        """
        self._command(partial(self._walk, checked_number(speed, "walk: speed")), "walk", speed=speed)

    def turn(self, angle: Any = None, speed: Any = None) -> None:
        """Turns the whole body, also while it walks; while it turns without an end, it changes the speed.

        Args:
            angle: The angle [degrees, left is positive]; None until `stop`.
            speed: Speed [degrees/s]; without an angle, negative turns to the right, and 0 ends the turn.

        Raises:
            WorldError: If a value is not a number, or the body cannot walk.
        """
        by = None if angle is None else radians(checked_number(angle, "turn: angle", -360 * MOST_TURNS, 360 * MOST_TURNS))
        ends = by is None and speed is not None and checked_number(speed, "turn: speed") == 0
        rate = 0.0 if ends else radians(self._speed("turn", speed, by is not None))
        self._command(partial(self._turn, by, rate), "turn", angle=angle, speed=speed)

    def stop(self, *groups: Any) -> None:
        """Stops some muscle groups at once, or all of the body.

        Raises:
            WorldError: If there is no such muscle group.
        """
        self._command(partial(self._stop, groups), "stop", groups=list(groups))

    def _walk(self, speed: float, site: CallSite | None) -> None:
        self._need("walk")
        self._felt().limbs.check_speed("walk", speed, 0, 1.0)
        walk = self._under_way.get("walk")
        if speed == 0:
            self._accept()
            self._halt(["walk"] if walk else [], site)
        else:
            self._begin_or_change("walk", Walk(speed, site), change=walk is not None)

    def _turn(self, angle: float | None, rate: float, site: CallSite | None) -> None:
        self._need("walk")
        self._felt().limbs.check_speed("turn", rate, 1, radians(1))
        turn = self._under_way.get("turn")
        if rate == 0:
            self._accept()
            self._halt(["turn"] if turn else [], site)
            return
        endless = isinstance(turn, Turn) and turn.rest is None and angle is None
        self._begin_or_change("turn", Turn(angle, rate, site), change=endless)

    def _begin_or_change(self, key: str, movement: Movement, *, change: bool) -> None:
        """Begins a movement of the legs, or replaces the one in progress. If that one is still being prepared, it begins first."""
        if change:
            self._accept()
            self._after_preparation(self._change, key, movement)
        else:
            self._begin({key: movement})

    def _stop(self, groups: Sequence[Any], site: CallSite | None) -> None:
        limbs = self._felt().limbs
        plan = limbs.plan
        for group in groups:
            checked_name(group, limbs.groups, plan.name, "muscle group")
        self._accept()
        self._halt([key for key, movement in self._under_way.items() if not groups or movement.group in groups], site)
        if not groups and "stop" in plan.actuators:
            self._send_command("stop", site=site)

    def _need(self, command: str) -> None:
        """Checks that the body has a command.

        Raises:
            WorldError: If it does not.
        """
        plan = self._felt().limbs.plan
        if command not in plan.actuators:
            raise WorldError(f"{plan.name} cannot {command}; its commands are: {', '.join(plan.actuators) or 'none'}")

    # -- limbs

    def rotate(self, joint: Any, axis: Any = None, angle: Any = None, speed: Any = None) -> None:
        """Turns one joint.

        Args:
            joint: A joint, or a part and `axis`.
            axis: Of a part's joints, the one that turns about it: `yaw`, `pitch` or `roll`, or slides along `x`, `y` or `z`.
            angle: Target angle [degrees], or position of a slide [m]; None for its limit, or until `stop`.
            speed: Speed [degrees/s]; without an angle, negative turns towards smaller angles; for a slide [m/s], and required.

        Raises:
            WorldError: If there is no such joint, it has no muscles, or a value is invalid.
        """
        pace = self._speed("rotate", speed, angle is not None)
        to = None if angle is None else checked_number(angle, "rotate: angle")
        act = partial(self._rotate, joint, axis, to, pace, speed is None)
        self._command(act, "rotate", joint=joint, axis=axis, angle=angle, speed=speed)

    def move(self, movement: Any, side: Any = None, angle: Any = None, speed: Any = None) -> None:
        """Makes a named movement of the body.

        Args:
            movement: Its name.
            side: Its side, if there is one on each: `left` or `right`.
            angle: Target angle [degrees], or position of slides [m], in the movement's own direction; None for the limit, or until `stop`.
            speed: Speed [degrees/s]; without an angle, negative moves in the other direction; of slides [m/s], and required.

        Raises:
            WorldError: If the body has no such movement, or a value is invalid.
        """
        pace = self._speed(str(movement), speed, angle is not None)
        to = None if angle is None else checked_number(angle, f"{movement}: angle")
        act = partial(self._move, movement, side, to, pace, speed is None)
        self._command(act, "move", movement=movement, side=side, angle=angle, speed=speed)

    def rotate_torso(self, angle: Any = None, speed: Any = None) -> None:
        """Turns the torso to an angle [degrees, left is positive], or until its limit; see `move`."""
        self.move("rotate_torso", None, angle, speed)

    def extend_shoulder(self, side: Any, angle: Any = None, speed: Any = None) -> None:
        """Moves a shoulder forward, to an angle [degrees], or until its limit; see `move`."""
        self.move("extend_shoulder", side, angle, speed)

    def compress_shoulder(self, side: Any, angle: Any = None, speed: Any = None) -> None:
        """Moves a shoulder backward, to an angle [degrees], or until its limit; see `move`."""
        self.move("compress_shoulder", side, angle, speed)

    def lower_arms(self, speed: Any = None) -> None:
        """Lowers both arms until they hang; see `move`."""
        self.move("lower_arms", None, None, speed)

    def assume(self, posture: Any, speed: Any = None) -> None:
        """Moves joints to their angles in a posture, such as a retrieved one; other slots are ignored.

        Args:
            posture: A buffer that holds it, a chunk, a mapping, or text: joints with angles [degrees], or positions [m].
            speed: Speed of each joint [degrees/s], and of each slide [m/s]; required if there are slides.

        Raises:
            ChunkError: If it is not a posture.
            WorldError: If it names no joint of the body, or a value is invalid.
        """
        pace = self._speed("assume", speed, True)
        wanted = Chunk(posture, self.sch.bound)
        self._command(partial(self._assume, wanted, pace, speed is None), "assume", posture=wanted, speed=speed)

    def feel(self, name: str = "felt") -> None:
        """Feels the body at the end of this tick, and stores that posture under a name.

        Raises:
            WorldError: If the name is not text.
        """
        if not isinstance(name, str) or not name.strip():  # pyright: ignore[reportUnnecessaryIsInstance] # an agent's code may give anything
            raise WorldError(f"feel: name: must be a name for the posture (got {name!r})")
        self._command(partial(self._want, name), "feel", name=name)

    def know(self, movement: str, posture: Any) -> None:
        """Stores the size of the body in a posture, in the buffer and in declarative memory, as if it had felt it after a movement.

        Adults know their bodies before an experiment begins. So does an agent that calls this in `init`, without a movement: the size is
        computed from the body as it stands, with the noise of feeling it. `busy` is True until it is stored, at the end of the next tick.

        Args:
            movement: The name of the movement that could have led there.
            posture: Joints with angles [degrees], or positions [m], and nothing else. Other joints are as they are. The slot `extreme` says
                whether the first of them, in the order of the body, is at an extreme of all known postures.

        Raises:
            ChunkError: If it is not a posture.
            WorldError: If it names something else, or nothing, a value is invalid, a joint cannot be there, or a hand has grasped an
                object.
        """
        if not isinstance(movement, str) or not movement.strip():  # pyright: ignore[reportUnnecessaryIsInstance] # an agent's code may give anything
            raise WorldError(f"know: movement: must be the name of a movement (got {movement!r})")
        known = Chunk(posture, self.sch.bound)
        self._command(partial(self._compute_size, movement, known), "know", movement=movement, posture=known)

    def _compute_size(self, movement: str, posture: Chunk, site: CallSite | None) -> None:
        limbs = self._felt().limbs
        for slot in posture:
            checked_name(slot, limbs.joints, limbs.plan.name, "joint")
        positions = self._positions_of(posture, "know")
        for joint, at in positions.items():
            if not limbs.inside(joint, at):
                raise WorldError(f"know: {limbs.plan.name}: '{joint}' cannot be at {at / limbs.unit[joint]:g}")
        self._accept()
        self._known.append((movement, positions))
        self._show_busy()
        self._inquire("size_in", (positions,))

    def _store_known(self, size: SizeInPosture) -> None:
        """Stores a known posture with its size."""
        movement, positions = self._known.pop(0)
        schema = self._felt()
        self._keep(schema.known(movement, positions, {name: schema.size(self._with_noise(getattr(size, name))) for name in SIZES}))
        self._show_busy()

    def _want(self, name: str, site: CallSite | None) -> None:
        self._accept()
        self._wanted.append(name)
        self._ask()

    def _rotate(self, joint: Any, axis: Any, to: float | None, pace: float, usual: bool, site: CallSite | None) -> None:
        limbs = self._felt().limbs
        name = limbs.joint(joint, axis)
        target = limbs.limit(name, pace) if to is None else to * limbs.unit[name]
        self._turn_joints(name, {name: copysign(INFINITE, pace) if target is None else target}, pace, usual, to is None, site)

    def _move(self, movement: Any, side: Any, to: float | None, pace: float, usual: bool, site: CallSite | None) -> None:
        limbs = self._felt().limbs
        named = limbs.movement(movement, side)
        if named.to is not None and (to is not None or pace < 0):
            raise WorldError(f"{movement} always ends in the same posture: it takes no angle, and a speed > 0")
        targets: dict[str, float] = {}
        for joint, way in named.joints:
            limit = limbs.limit(joint, way * pace)
            end = copysign(INFINITE, way * pace) if limit is None else limit
            targets[joint] = way * named.to if named.to is not None else end if to is None else way * to * limbs.unit[joint]
        name = movement if named.side is None else f"{movement}_{named.side}"
        self._turn_joints(name, targets, pace, usual, to is None and named.to is None, site)

    def _assume(self, posture: Chunk, pace: float, usual: bool, site: CallSite | None) -> None:
        self._turn_joints("assume", self._positions_of(posture, "assume"), pace, usual, False, site)

    def _positions_of(self, posture: Chunk, call: str) -> dict[str, float]:
        """Returns the positions of the joints in a posture [rad] or [m], in the order of the body.

        Raises:
            WorldError: If it names no joint of the body, or a value is not a number.
        """
        limbs = self._felt().limbs
        given = [joint for joint in limbs.order if joint in posture]
        positions = {joint: checked_number(posture[joint], f"{call}: {joint}") * limbs.unit[joint] for joint in given}
        if not positions:
            raise WorldError(f"{call}: '{posture}' names no joint of {limbs.plan.name}; it has {', '.join(limbs.order) or 'none'}")
        return positions

    def _turn_joints(self, name: str, ways: Mapping[str, float], pace: float, usual: bool, to_limit: bool, site: CallSite | None) -> None:
        """Turns joints to positions [rad] or [m], together: one movement for each muscle group.

        Args:
            name: The movement.
            ways: By joint, its target.
            pace: The speed of each joint, in its unit in commands.
            usual: Whether that is the default speed, which slides do not have.
            to_limit: Whether the targets are limits.
            site: The line of the modeller's code that gives the command.
        """
        limbs = self._felt().limbs
        by_group: dict[str, dict[str, float]] = {}
        for joint, target in ways.items():
            if not limbs.joints[joint].driven:
                raise WorldError(f"{limbs.plan.name}: joint '{joint}' has no muscles that could move it")
            if usual and limbs.joints[joint].kind == "slide":
                raise WorldError(f"{limbs.plan.name}: joint '{joint}' slides; give its speed [m/s]: speed=…")
            limbs.check_speed(name, pace * limbs.unit[joint], 2, limbs.unit[joint])
            if abs(target) < INFINITE and not limbs.inside(joint, target):
                self._refuse(name, "limit")
                return
            by_group.setdefault(limbs.group_of[joint], {})[joint] = target
        movements: dict[str, Movement] = {}
        for group, targets in by_group.items():
            paces = {joint: abs(pace) * limbs.unit[joint] for joint in targets}
            movements[group] = JointMovement(name, group, paces, site, targets=targets, order=limbs.order, to_limit=to_limit)
        self._begin(movements)

    def _speed(self, call: str, speed: Any, bounded: bool) -> float:
        """Returns a given speed, in the units of commands, or the default.

        Raises:
            WorldError: If it is not a number, is 0, or is negative although there is a target angle.
        """
        given = self.speed if speed is None else checked_number(speed, f"{call}: speed")
        if given == 0 or (bounded and given < 0):
            raise WorldError(f"{call}: speed: must {'be > 0 to go to an angle' if bounded else 'not be 0'} (got {speed!r})")
        return given

    # -- knowing the body

    def start(self) -> None:
        """Asks the body what it consists of, when the agent starts."""
        self.sch.call_after(0, self._ask_body)

    def _ask_body(self) -> None:
        if self._find_embodiment() is not None:
            self._inquire("anatomy")
            self._wanted.append("start")
            self._ask()

    def _receive(self, request: Request, answer: Any) -> None:
        if request.word == "anatomy":
            self._know_parts(answer)
        elif request.word == "size_in":
            self._store_known(answer)
        else:
            self._asked = False
            self._feel(answer)

    def _know_parts(self, plan: BodyPlan) -> None:
        """Stores what the body consists of."""
        limbs = self._limbs = Limbs(plan)
        for group in limbs.groups:
            self._become(f"{group}_busy", False)
            self._become(f"{group}_end", "none")

    def _command(self, act: Callable[[CallSite | None], None], call: str, **given: Any) -> None:
        """Carries out a command, or delays it until the body is known."""
        self._joined(call)
        self._trace_request(call, **given)
        if self._schema is None:
            self._waiting.append((act, self._call_site()))
            self._become("busy", True)
        else:
            act(self._call_site())

    def _catch_up(self) -> None:
        """Carries out the commands that waited until the body was known."""
        waiting, self._waiting = self._waiting, []
        for act, site in waiting:
            try:
                act(site)
            except Exception as error:
                note_request(error, self, site)
                raise
        self._show_busy()

    # -- movements in progress

    def _begin(self, movements: dict[str, Movement]) -> None:
        """Begins movements, all or none of them. The keys are the resources that they occupy: a muscle group, walking, or turning."""
        for key, movement in movements.items():
            if key in self._under_way:
                self._refuse(movement.name, "busy")
                return
        self._accept()
        self._under_way |= movements
        self._show_busy()
        for key, movement in movements.items():
            self._become(f"{movement.group}_end", "none")
            self._after_preparation(self._launch, key, movement)

    def _after_preparation(self, act: Callable[[str, Movement], None], key: str, movement: Movement) -> None:
        delay = self.preparation + self.initiation
        if delay > 0:
            self.sch.call_after(delay, act, (key, movement))
        else:
            act(key, movement)

    def _change(self, key: str, movement: Movement) -> None:
        """Replaces a movement of the legs that is in progress, unless that has ended during preparation."""
        if key in self._under_way and self._under_way[key].begun:
            self._under_way[key] = movement
            self._launch(key, movement)

    def _launch(self, key: str, movement: Movement) -> None:
        """Commands the body to begin a movement, unless it was stopped during preparation."""
        if self._under_way.get(key) is not movement:
            return
        movement.begun = True
        self._send(movement.begin() if isinstance(movement, JointMovement) else self._gait(), movement.site)
        self.emit("move", **movement.trace_data())
        self._ask()

    def _accept(self) -> None:
        """Clears `error` and `refusal` of an earlier command."""
        self._become("error", False)
        self._become("refusal", None)

    def _refuse(self, call: str, why: str) -> None:
        """Refuses a command."""
        self._become("error", True)
        self._become("refusal", why)
        self.emit("refused", movement=call, why=why)

    def _halt(self, keys: Iterable[str], site: CallSite | None, end: str = "stopped") -> None:
        """Ends movements before they are done."""
        halted = [self._under_way.pop(key) for key in keys]
        for movement in halted:
            if movement.begun and isinstance(movement, JointMovement):
                self._send(movement.halt(), site)
        if any(movement.begun and not isinstance(movement, JointMovement) for movement in halted):
            self._send(self._gait(), site)
        self._end([(movement, end) for movement in halted])
        self._ended += [(movement, end) for movement in halted if movement.begun and isinstance(movement, JointMovement)]

    def _end(self, ended: Iterable[tuple[Movement, str]]) -> None:
        """Shows the end of movements to productions and in the trace."""
        for movement, end in ended:
            self._become(f"{movement.group}_end", end)
            self.emit("moved", movement=movement.name, group=movement.group, end=end)
        self._show_busy()

    def _gait(self) -> Iterable[Order]:
        walk, turn = (of if of is not None and of.begun else None for of in (self._under_way.get("walk"), self._under_way.get("turn")))
        assert walk is None or isinstance(walk, Walk)
        assert turn is None or isinstance(turn, Turn)
        return gait(walk, turn)

    def _send(self, orders: Iterable[Order], site: CallSite | None) -> None:
        for command, values, named in orders:
            self._send_command(command, *values, named=named, site=site)

    # -- feeling

    def _ask(self, *, by_itself: bool = False) -> None:
        """Requests one reading of the posture at the end of this tick; `by_itself` if no code of the modeller makes the request."""
        if not self._asked:
            self._asked = True
            self._inquire("proprioception", by_itself=by_itself)

    def _feel(self, reading: Proprioception) -> None:
        """Processes a reading: updates the felt body, ends movements that are over, and stores postures."""
        limbs = self._limbs
        assert limbs is not None
        before, self._positions = self._positions or reading.positions, reading.positions
        now = self.sch.now_us
        step = Step(seconds(now - self._felt_us), before, reading)
        self._felt_us = now
        if self._schema is None:
            check_joints(limbs.plan.name, limbs.joints)
            self._update(limbs, reading, before)
            check_patterns(self)
        elif before != reading.positions or self._resized(reading):
            self._update(limbs, reading, before)
        over: list[tuple[str, str]] = []
        for key, movement in self._under_way.items():
            end = movement.ended(step, self.patience) if movement.begun else None
            if end is not None:
                over.append((key, end))
        ended = [(self._under_way.pop(key), end) for key, end in over if end in ("done", "limit")]
        if over:
            self._end(ended)
            for key in [key for key, _ in over if key in self._under_way]:
                self._halt([key], self._under_way[key].site, dict(over)[key])
        if self._ended or ended or self._further or self._wanted or self._waiting:
            self._remember(limbs, ended)
        for movement in self._under_way.values():
            if movement.begun:
                self._ask(by_itself=True)
                break

    def _resized(self, reading: Proprioception) -> bool:
        """Returns whether the size of the body has changed since it was last felt, such as after a grasp."""
        return any(abs(now - before) > self.size_grid for now, before in zip(_sizes_of(reading), self._sizes, strict=True))

    def _update(self, limbs: Limbs, reading: Proprioception, before: Sequence[float]) -> None:
        """Updates the felt positions of the joints, which were at `before`, and the felt size of the body."""
        draw, schema = self.random.gauss, self._schema
        positions: Sequence[float] = reading.positions
        sizes: Sequence[float] = _sizes_of(reading)
        self._sizes = sizes
        if self.angle_noise or self.size_noise:
            noise = {"hinge": radians(self.angle_noise), "slide": self.size_noise}
            positions = []
            for joint, at, was in zip(limbs.order, reading.positions, before, strict=True):
                sd = noise[limbs.joints[joint].kind]
                if schema is not None and at == was:
                    positions.append(schema.felt(joint))  # what has not moved feels as it did
                else:
                    positions.append(at + draw(0, sd) if sd else at)
            sizes = [self._with_noise(size) for size in sizes]
        if schema is None:
            schema = self._schema = BodySchema(
                limbs,
                positions,
                sizes,
                angle_grid=self.angle_grid,
                size_grid=self.size_grid,
                step=self.extreme_step,
                slide=self.extreme_slide,
            )
            joints: Sequence[str] = limbs.order
            changed: Sequence[str] = SIZES
        else:
            joints, changed = schema.feel(positions, sizes)
        for joint in joints:
            self._become(limbs.shown_as[joint], schema.at[joint])
        for name in changed:
            self._become(name, schema.box[name])
        self._further = schema.extremes(joints)

    def _remember(self, limbs: Limbs, ended: list[tuple[Movement, str]]) -> None:
        """Stores the posture after movements have ended, at new extremes of joints, and on request."""
        if self._ended:
            ended, self._ended = [*self._ended, *ended], []
        moving = next((joint for joint in self._further if limbs.group_of[joint] in self._under_way), None)
        if moving is not None:  # it moves by a command; the other joints have stopped, or were pushed
            self._store(self._under_way[limbs.group_of[moving]].name, "passing", moving)
        for movement, end in ended:
            if isinstance(movement, JointMovement):
                self._store(movement.name, end, next(joint for joint in limbs.order if joint in movement.targets))
        if self._wanted:
            wanted, self._wanted = self._wanted, []
            for name in wanted:
                self._store(name, "felt", None)
        self._further = ()
        if self._waiting:
            self._catch_up()

    def _store(self, name: str, end: str, joint: str | None) -> None:
        """Puts the present posture into the buffer and into declarative memory."""
        schema = self._schema
        assert schema is not None
        posture = schema.posture(name, end, joint, {name: getattr(self, name) for name in SIZES})
        schema.note(self._further)
        self._keep(posture)

    def _keep(self, posture: dict[str, Any]) -> None:
        """Puts a posture into the buffer and into declarative memory."""
        if self._memory is not None:
            collect(self._memory, Chunk(posture))
        if self._buffer is not None:
            self._buffer.set(posture)

    def _with_noise(self, length: float) -> float:
        """Returns a length with the noise of felt sizes [m]."""
        return length + self.random.gauss(0, self.size_noise) if self.size_noise else length

    # -- attributes and trace

    def _show_busy(self) -> None:
        limbs = self._limbs
        if limbs is not None:
            groups = {movement.group for movement in self._under_way.values()}
            for group in limbs.groups:
                self._become(f"{group}_busy", group in groups)
            if BASE_GROUP in limbs.groups:
                self._become("walking", "walk" in self._under_way)
                self._become("turning", "turn" in self._under_way)
        self._become("busy", bool(self._under_way or self._waiting or self._known))

    def _become(self, name: str, value: Any) -> None:
        """Sets an attribute if its value changes."""
        if vars(self).get(name, _NOTHING) != value:  # without what the class has under this name
            Model.__setattr__(self, name, value)
