"""Real time: slows a run down to wall-clock time, and measures its delays."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Literal

from actr3d.clock import seconds

SimulationEnding = Literal["seconds", "until", "stop", "done", "limits"]
"""What ends a call of `run`; see `RunReport`."""


@dataclass(frozen=True, kw_only=True)
class RunReport:
    """Summary of a call of `run`. Results never depend on it; its text holds only what is the same whenever the run is repeated."""

    ended_by: SimulationEnding
    """`seconds` have passed; `until` came true; an agent called `stop`; the run was `done`, with nothing left to do; the
    `limits` of the program (`--until`) left no time for another tick."""
    ticks: int
    """Number of ticks."""
    simulated: float
    """Simulated time [s]."""
    wall: float = field(repr=False)
    """Wall-clock time [s]."""
    late_ticks: int = field(default=0, repr=False)
    """Number of ticks that ended later than real time requires. None is skipped."""
    latest: float = field(default=0.0, repr=False)
    """Greatest delay of a tick [s]."""

    @property
    def factor(self) -> float:
        """Speed as a multiple of real time."""
        return self.simulated / self.wall if self.wall > 0 else float("inf")


class RealTime:
    """Slows a run down to a multiple of real time.

    A tick that ends late is counted, and the next ones follow at once until the run has caught up.

    Args:
        period: A tick [us].
        factor: The multiple of real time; None for as fast as possible.
    """

    def __init__(self, period: int, factor: float | None) -> None:
        self._period = period
        self._step = None if factor is None else seconds(period) / factor
        self._start = time.perf_counter()
        self.ticks = 0
        self.late_ticks = 0
        self.latest = 0.0

    def tick(self) -> None:
        """Counts a tick, and waits for its wall-clock time."""
        self.ticks += 1
        if self._step is None:
            return
        early = self._start + self.ticks * self._step - time.perf_counter()
        if early > 0:
            time.sleep(early)
        elif early < 0:
            self.late_ticks += 1
            self.latest = max(self.latest, -early)

    def report(self, ended_by: SimulationEnding) -> RunReport:
        """Returns the summary of the run."""
        return RunReport(
            ended_by=ended_by,
            ticks=self.ticks,
            simulated=seconds(self.ticks * self._period),
            wall=time.perf_counter() - self._start,
            late_ticks=self.late_ticks,
            latest=self.latest,
        )
