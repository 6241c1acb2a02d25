"""Changes by hand in the runs of a program: made between two events, recorded, and repeated at the same moments of another run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import takewhile
from typing import TYPE_CHECKING, Any

from actr3d.actr.changes import AgentChange, Parts
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.kernel.tree import top_of
from actr3d.change import CHANGES
from actr3d.errors import SimulationError, alternatives
from actr3d.recording.reader import RecordedCommand
from actr3d.trace import top_path

if TYPE_CHECKING:
    from actr3d.actr.kernel.model import Model
    from actr3d.actr.kernel.scheduler import Scheduler

USER = "user"
"""The value of `by` in the data of a user's command: a program can give commands to its simulations itself, which it repeats itself."""


class ProgramChanges:
    """Makes the changes of a user in the runs of one program, whose time advances in `RunLimits.passing`.

    All that a change causes at its moment happens before the next one, so that a repeated run is the same.

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

    def due(self, sch: Scheduler, end: int) -> int | None:
        """Returns when the next known change is due in a run [us], if that is before a time [us]; None if it is not."""
        if self.made >= len(self.known):
            return None
        run, time, _ = self.known[self.made]
        return time if run == self._number(sch) and sch.now_us <= time < end else None

    def up_to(self, sch: Scheduler, time: int) -> int:
        """Returns the number of known changes up to a time of a run [us], those that are yet to be repeated at that time included."""
        ahead = takewhile(lambda one: one.run == self._number(sch) and one.tick <= time, self.known[self.made :])
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
        self.known[self.made :] = [RecordedCommand(self._number(sch), time, data)]
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
            change.carry_out(Parts(self._tops(sch)))
        except BaseException:
            sch.now_us, sch.queue.sum = before, total
            raise
        number, limits = self._number(sch), self._limits
        if limits.trace is not None and limits.trace.production:
            limits.trace.emit(time, top_path(number), "command", {"command": data["command"], "data": given})
        if limits.recorder is not None:
            limits.recorder.command(number, time, data)

    def _tops(self, sch: Scheduler) -> list[Model]:
        runs = () if self._limits.trace is None else self._limits.trace.runs
        return list(dict.fromkeys(top_of(run.model) for run in runs if _is_of(run.model, sch)))

    def _number(self, sch: Scheduler) -> int:
        """Returns the number of a run in the trace."""
        runs = () if self._limits.trace is None else self._limits.trace.runs
        return max((number for number, run in enumerate(runs, start=1) if _is_of(run.model, sch)), default=1)


def of_user(commands: Iterable[RecordedCommand]) -> list[RecordedCommand]:
    """Returns the commands that a user has given, without those that a program gives its simulations itself."""
    return [command for command in commands if command.data.get("by") == USER]


def _is_of(model: Any, sch: Scheduler) -> bool:
    return model is not None and model.__dict__.get("sch") is sch
