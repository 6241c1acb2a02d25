"""Changes by hand in the runs of a program, recorded, and repeated at the same moments of another run.

They are made between two events of an agent without a body, and between two ticks of a simulation.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from itertools import takewhile
from typing import TYPE_CHECKING, Any

from actr3d.actr.changes import AgentChange, Parts
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.kernel.tree import top_of
from actr3d.change import CHANGES
from actr3d.errors import SimulationError, alternatives
from actr3d.recording.reader import RecordedCommand
from actr3d.trace import renumbered, top_path

if TYPE_CHECKING:
    from actr3d.actr.kernel.scheduler import Scheduler
    from actr3d.simulation import Simulation

USER = "user"
"""The value of `by` in the data of a user's command: a program can give commands to its simulations itself, which it repeats itself."""


class ProgramChanges:
    """Makes the changes of a user in the runs of one program, whose time advances in `RunLimits.passing` and `RunLimits.ticked`.

    All that a change of an agent without a body causes at its moment happens before the next one, so that a repeated run is the same.

    Args:
        limits: The limits of the program; its trace and recorder receive the changes.
        known: The changes of an earlier run, which this one repeats.
    """

    def __init__(self, limits: RunLimits, known: Iterable[RecordedCommand] = ()) -> None:
        self._limits = limits
        self.known = list(known)
        """All changes, in order."""
        self.made = 0
        """How many of them have been made."""
        self._ticks: Counter[int] = Counter()
        """How many ticks each simulation has run, by the number of its run."""

    # -- agents without bodies

    def due(self, sch: Scheduler, end: int) -> int | None:
        """Returns when the next known change is due in a run [us], if that is before a time [us]; None if it is not."""
        if self.made >= len(self.known):
            return None
        run, time, _ = self.known[self.made]
        return time if run == self._number(sch) and sch.now_us <= time < end else None

    def up_to(self, sch: Scheduler, time: int) -> int:
        """Returns the number of known changes up to a time of a run [us], those that are yet to be repeated at that time included."""
        return self._up_to(self._number(sch), time)

    def _up_to(self, run: int, time: int) -> int:
        ahead = takewhile(lambda one: one.run == run and one.tick <= time, self.known[self.made :])
        return self.made + sum(1 for _ in ahead)

    def repeat(self, sch: Scheduler, end: int) -> bool:
        """Makes the next known change if it is due before a time [us]; returns whether it was. A function for `RunLimits.passing`.

        Raises:
            Actr3dError: If it cannot be made.
        """
        time = self.due(sch, end)
        if time is None:
            return False
        _, _, data = self.known[self.made]
        self._carry_out(sch, time, data)
        self.made += 1
        return True

    def make(self, sch: Scheduler, time: int, word: str, values: Sequence[Any], named: Mapping[str, Any]) -> None:
        """Makes a new change; known ones that lie ahead are forgotten.

        Args:
            sch: The scheduler of the run.
            time: When [us]: from its present time on, before its next event.
            word: The word of the change.
            values: Its arguments.
            named: The same, by name.

        Raises:
            Actr3dError: If it cannot be made; then nothing has changed.
        """
        self.check(word)
        data = {"command": word, "data": {"values": list(values), "named": dict(named), "body": None}, "by": USER}
        self._carry_out(sch, time, data)
        self._add(RecordedCommand(self._number(sch), time, data))

    def _add(self, command: RecordedCommand) -> None:
        """Adds a change that has been made; known ones that lie ahead are forgotten."""
        self.known[self.made :] = [command]
        self.made += 1

    @staticmethod
    def check(word: str) -> None:
        """Checks that there is a change of agents of this word.

        Raises:
            SimulationError: If there is none.
        """
        if word not in CHANGES or not issubclass(CHANGES[word], AgentChange):
            known = [name for name, one in CHANGES.items() if issubclass(one, AgentChange)]
            raise SimulationError(f"no change '{word}' for the agents of a program{alternatives(word, known)}")

    def _carry_out(self, sch: Scheduler, time: int, data: dict[str, Any]) -> None:
        given = data["data"]
        change = CHANGES[data["command"]].of_arguments(given["values"], given["named"])
        before, total = sch.now_us, sch.queue.sum
        sch.catch_up(time)
        try:
            runs = () if self._limits.trace is None else self._limits.trace.runs
            change.carry_out(Parts(dict.fromkeys(top_of(run.model) for run in runs if _is_of(run.model, sch))))
        except BaseException:
            sch.now_us, sch.queue.sum = before, total
            raise
        number, limits = self._number(sch), self._limits
        if limits.trace is not None and limits.trace.production:
            limits.trace.emit(time, top_path(number), "command", data)
        if limits.recorder is not None:
            limits.recorder.command(number, time, data)

    def _number(self, sch: Scheduler) -> int:
        """Returns the number of a run in the trace."""
        runs = () if self._limits.trace is None else self._limits.trace.runs
        return max((number for number, run in enumerate(runs, start=1) if _is_of(run.model, sch)), default=1)

    # -- simulations

    def ticked(self, simulation: Simulation, passed: int) -> None:
        """Counts a tick, and makes the known changes of this moment. A function for `RunLimits.ticked`.

        Args:
            simulation: The simulation.
            passed: The time that has passed [us]; 0 before the first tick.

        Raises:
            Exception: If a change cannot be made.
        """
        self.count(simulation, passed)
        self.repeat_in(simulation)

    def count(self, simulation: Simulation, passed: int) -> None:
        """Counts a tick of a simulation, if time has passed [us]."""
        self._ticks[_number_of(simulation)] += passed > 0

    def repeat_in(self, simulation: Simulation) -> None:
        """Makes the known changes of the present moment of a simulation.

        Raises:
            Exception: If one of them cannot be made.
        """
        here = _number_of(simulation), simulation.ticks
        while self._is_at_new_tick(simulation) and self.made < len(self.known) and self.known[self.made][:2] == here:
            data = self.known[self.made].data
            given = data["data"]
            simulation.carry_out(data["command"], given["values"], given["named"], given["body"], by=USER)
            self.made += 1

    def up_to_now(self, simulation: Simulation) -> int:
        """Returns the number of known changes up to the present moment of a simulation, those that are yet to be repeated included."""
        return self._up_to(_number_of(simulation), simulation.ticks) if self._is_at_new_tick(simulation) else self.made

    def make_in(self, simulation: Simulation, word: str, values: Sequence[Any], named: Mapping[str, Any], body: str | None) -> None:
        """Makes a new change at the present moment of a simulation; known ones that lie ahead are forgotten.

        Args:
            simulation: The simulation.
            word: The word of the change, or a command of a body.
            values: Its arguments; parts of agents have their names in the trace of the program.
            named: The same, by name.
            body: The body that carries it out; None for a change, or for the only body.

        Raises:
            SimulationError: If the part belongs to another run, or the moment cannot be found again.
            Exception: What the world, a body or an agent raises; then nothing has changed.
        """
        if not self._is_at_new_tick(simulation):
            raise SimulationError(
                f"'{word}' cannot be done: the program has taken this simulation back to an earlier time itself, so that the change could "
                "not be repeated at the same moment"
            )
        change, number = CHANGES.get(word), _number_of(simulation)
        if body is None and change is not None and issubclass(change, AgentChange):
            change.of_arguments(values, named)
            values, named = change.renamed(values, named, lambda path: _own_path(path, number))
        simulation.carry_out(word, values, named, body, by=USER)
        made = simulation.timeline.commands[-1]
        self._add(RecordedCommand(number, made.tick, made.to_data()))

    def _is_at_new_tick(self, simulation: Simulation) -> bool:
        """Returns whether the number of a simulation's tick shows its present moment: a program can go back, and pass a tick twice."""
        return self._ticks[_number_of(simulation)] == simulation.ticks


def of_user(commands: Iterable[RecordedCommand]) -> list[RecordedCommand]:
    """Returns the commands that a user has given, without those that a program gives its simulations itself."""
    return [command for command in commands if command.data.get("by") == USER]


def _is_of(model: Any, sch: Scheduler) -> bool:
    return model is not None and model.__dict__.get("sch") is sch


def _number_of(simulation: Simulation) -> int:
    """Returns the number of a simulation among the runs of its program."""
    return simulation.event_log.number or 1


def _own_path(path: str, number: int) -> str:
    """Returns the path of a part in its simulation, given its path in the program and the number of the simulation's run.

    Raises:
        SimulationError: If the path is that of another run.
    """
    own = renumbered(path, 1)
    if renumbered(own, number) != path:
        raise SimulationError(
            f"'{path}' is not in the simulation that runs at this moment, '{top_path(number)}'; only parts of its agents can be changed now"
        )
    return own
