"""What is behind the motor module's commands: knows the body, lets movements begin and end, and feels them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.parameters import WithParameters
from actr3d.actr.modules.port import Port, Request, place_of_caller
from actr3d.clock import seconds
from actr3d.errors import Actr3dError
from actr3d.motor.checks import check_patterns
from actr3d.motor.limbs import BASE_GROUP, Limbs
from actr3d.motor.movement import JointMovement, Movement, Order, Step, Turn, Walk, gait
from actr3d.motor.schema import BodySchema
from actr3d.world.sensors.anatomy import BodyPlan
from actr3d.world.sensors.proprioception import Proprioception

FEELING = "the motor module's own feeling"
"""What stands where an error names the line that asked."""

_NOTHING = object()


class Muscles(WithParameters, Port):
    """Carries movements out, one at a time in each muscle group (in the legs, walking and turning), and feels the body
    each tick while any is under way.
    """

    angle_grid: float
    size_grid: float
    extreme_step: float | None
    angle_noise: float
    size_noise: float
    patience: float | None
    preparation: float
    initiation: float

    def __init__(self, buffer: Any, memory: Any) -> None:
        Model.__init__(self)
        self._buffer = buffer
        self._memory = memory
        self._limbs: Limbs | None = None
        self._schema: BodySchema | None = None
        self._waiting: list[tuple[Callable[[str], None], str]] = []
        self._under_way: dict[str, Movement] = {}
        self._ended: list[tuple[Movement, str]] = []
        self._asked = False
        self._wanted: list[str] = []
        self._further: str | None = None
        self._positions: tuple[float, ...] = ()
        self._felt_us = 0
        self.busy = False
        self.error = False
        self.refusal: str | None = None
        self.walking = False
        self.turning = False
        self.width: float | None = None
        self.depth: float | None = None
        self.height: float | None = None

    # -- knowing the body

    def start(self) -> None:
        """Asks the body what it is, when the mind begins to live."""
        self.sch.call_after(0, self._ask_body)

    def _ask_body(self) -> None:
        if self._find_embodiment() is not None:
            self._inquire("anatomy", place=FEELING)
            self._wanted.append("start")
            self._ask()

    def _receive(self, request: Request, answer: Any) -> None:
        if request.word == "anatomy":
            self._know(answer)
        else:
            self._asked = False
            self._feel(answer)

    def _know(self, plan: BodyPlan) -> None:
        """Learns what the body consists of."""
        limbs = self._limbs = Limbs(plan)
        for group in limbs.groups:
            self._become(f"{group}_busy", False)
            self._become(f"{group}_end", "none")

    def _command(self, act: Callable[[str], None], call: str, **given: Any) -> None:
        """Carries out a command, or keeps it until the body is known."""
        self._joined(call)
        self._trace_request(call, **given)
        if self._schema is None:
            self._waiting.append((act, place_of_caller()))
            self._become("busy", True)
        else:
            act(place_of_caller())

    def _catch_up(self) -> None:
        """Carries out what was commanded before the body was known."""
        waiting, self._waiting = self._waiting, []
        for act, place in waiting:
            try:
                act(place)
            except Actr3dError as error:
                error.add_note(f"  asked for by '{self._path}' in {place}")
                raise
        self._show_busy()

    # -- movements

    def _begin(self, movements: dict[str, Movement]) -> None:
        """Begins movements, all or none of them, by what each takes up: a muscle group, or walking, or turning."""
        for key, movement in movements.items():
            if key in self._under_way:
                self._refuse(movement.name, "busy")
                return
        self._become("error", False)
        self._become("refusal", None)
        self._under_way |= movements
        self._show_busy()
        delay = self.preparation + self.initiation
        for key, movement in movements.items():
            self._become(f"{movement.group}_end", "none")
            if delay > 0:
                self.sch.call_after(delay, self._launch, (key, movement))
            else:
                self._launch(key, movement)

    def _launch(self, key: str, movement: Movement) -> None:
        """Tells the body to begin a movement, unless that has been stopped while it was prepared."""
        if self._under_way.get(key) is not movement:
            return
        movement.begun = True
        self._obey(movement.begin() if isinstance(movement, JointMovement) else self._gait(), movement.place)
        self._emit("move", movement.told())
        self._ask()

    def _refuse(self, call: str, why: str) -> None:
        """Notes that a command is not carried out."""
        self._become("error", True)
        self._become("refusal", why)
        self._emit("refused", {"movement": call, "why": why})

    def _halt(self, keys: Iterable[str], place: str, end: str = "stopped") -> None:
        """Ends movements before they are done."""
        halted = [self._under_way.pop(key) for key in keys]
        for movement in halted:
            if movement.begun and isinstance(movement, JointMovement):
                self._obey(movement.halt(), place)
        if any(movement.base and movement.begun for movement in halted):
            self._obey(self._gait(), place)
        self._end([(movement, end) for movement in halted])
        self._ended += [(movement, end) for movement in halted if movement.begun and not movement.base]

    def _end(self, ended: Iterable[tuple[Movement, str]]) -> None:
        """Lets productions and the trace know of movements that are over."""
        for movement, end in ended:
            self._become(f"{movement.group}_end", end)
            self._emit("moved", {"movement": movement.name, "group": movement.group, "end": end})
        self._show_busy()

    def _gait(self) -> Iterable[Order]:
        walk, turn = (of if of is not None and of.begun else None for of in (self._under_way.get("walk"), self._under_way.get("turn")))
        assert walk is None or isinstance(walk, Walk)
        assert turn is None or isinstance(turn, Turn)
        return gait(walk, turn)

    def _obey(self, orders: Iterable[Order], place: str) -> None:
        for word, values, named in orders:
            self._tell(word, *values, named=named, place=place)

    # -- feeling

    def _ask(self) -> None:
        """Asks the body how it stands at the end of this tick, once."""
        if not self._asked:
            self._asked = True
            self._inquire("proprioception", place=FEELING)

    def _feel(self, reading: Proprioception) -> None:
        """Takes in how the body stands, which movements are over, and which postures are to be remembered."""
        limbs = self._limbs
        assert limbs is not None
        before, self._positions = self._positions or reading.positions, reading.positions
        now = self.sch.now_us
        step = Step(seconds(now - self._felt_us), before, reading)
        self._felt_us = now
        if self._schema is None:
            self._update(limbs, reading, limbs.order)
            check_patterns(self)
        elif before != reading.positions:
            gone = [joint for joint, was, at in zip(limbs.order, before, reading.positions, strict=True) if was != at]
            self._update(limbs, reading, gone)
        over: list[tuple[str, str]] = []
        for key, movement in self._under_way.items():
            end = movement.ended(step, self.patience) if movement.begun else None
            if end is not None:
                over.append((key, end))
        ended = [(self._under_way.pop(key), end) for key, end in over if end in ("done", "limit")]
        if over:
            self._end(ended)
            for key in [key for key, _ in over if key in self._under_way]:
                self._halt([key], self._under_way[key].place, dict(over)[key])
        self._remember(limbs, ended)
        if any(movement.begun for movement in self._under_way.values()):
            self._ask()

    def _update(self, limbs: Limbs, reading: Proprioception, joints: Sequence[str]) -> None:
        """Brings what is known of some joints, and of the body's size, into step with the body."""
        draw = self.random.gauss
        for joint in joints:
            noise = draw(0, self.angle_noise * limbs.unit[joint]) if self.angle_noise else 0.0
            limbs.feel(joint, reading.positions[limbs.number[joint]] + noise)
        schema = self._schema
        if schema is None:
            schema = self._schema = BodySchema(limbs, self.angle_grid, self.size_grid, self.extreme_step)
        for joint in joints:
            self._become(limbs.shown_as[joint], schema.shown(joint, limbs.felt[joint]))
        for name in ("width", "depth", "height"):
            noise = draw(0, self.size_noise) if self.size_noise else 0.0
            self._become(name, schema.size(getattr(reading, name) + noise))
        further = schema.extremes(joints)
        if further:
            schema.note(further)
            self._further = further[0]

    def _remember(self, limbs: Limbs, ended: list[tuple[Movement, str]]) -> None:
        """Stores the posture where movements have ended, where a joint has gone further than ever, and where it was asked for."""
        if self._ended:
            ended, self._ended = [*self._ended, *ended], []
        if self._further is not None:
            passing = self._under_way.get(limbs.group_of[self._further])
            if passing is not None:  # else it has just ended, or was pushed
                self._store(passing.name, "passing", self._further)
            self._further = None
        for movement, end in ended:
            if isinstance(movement, JointMovement):
                self._store(movement.name, end, next(joint for joint in limbs.order if joint in movement.ways))
        if self._wanted:
            wanted, self._wanted = self._wanted, []
            for name in wanted:
                self._store(name, "felt", None)
        if self._waiting:
            self._catch_up()

    def _store(self, name: str, end: str, joint: str | None) -> None:
        """Puts the present posture into the buffer and into declarative memory."""
        schema = self._schema
        assert schema is not None
        posture = schema.posture(name, end, joint, {"width": self.width, "depth": self.depth, "height": self.height})
        if self._memory is not None:
            self._memory._collect(Chunk(posture))
        if self._buffer is not None:
            self._buffer.set(posture)

    # -- telling

    def _show_busy(self) -> None:
        limbs = self._limbs
        if limbs is not None:
            groups = {movement.group for movement in self._under_way.values()}
            for group in limbs.groups:
                self._become(f"{group}_busy", group in groups)
            if BASE_GROUP in limbs.groups:
                self._become("walking", "walk" in self._under_way)
                self._become("turning", "turn" in self._under_way)
        self._become("busy", bool(self._under_way or self._waiting))

    def _become(self, name: str, value: Any) -> None:
        """Gives an attribute a value, where that is new."""
        if self.__dict__.get(name, _NOTHING) != value:
            Model.__setattr__(self, name, value)

    def _emit(self, kind: str, data: dict[str, Any]) -> None:
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, self._path, kind, data)
