"""Real time: lets a run go no faster than a clock on the wall, and measures how well it kept to it."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Literal

from actr3d.clock import seconds

Ending = Literal["seconds", "until", "stop", "done", "limits"]


@dataclass(frozen=True, kw_only=True)
class RunReport:
    """How a call of `run` went. Nothing of it enters the run's results."""

    ended_by: Ending
    """`seconds` have passed; `until` came true; an agent called `stop`; the agents were `done`, with nothing left to do; the
    `limits` of the program (`--until`) left no time for another tick."""
    ticks: int
    """How many ticks it went."""
    simulated: float
    """How much time passed in the simulation [s]."""
    wall: float
    """How much passed on the wall [s]."""
    late_ticks: int = 0
    """How many ticks ended later than real time asked for. None is skipped."""
    latest: float = 0.0
    """By how much the worst one was late [s]."""

    @property
    def factor(self) -> float:
        """How many times as fast as real time it went."""
        return self.simulated / self.wall if self.wall > 0 else float("inf")


class Pace:
    """Holds a run to real time, times a factor.

    A tick that ends late is counted and the next ones follow at once, until the run has caught up.

    Args:
        period: A tick [us].
        factor: How many times as fast as real time; None for as fast as possible.
    """

    def __init__(self, period: int, factor: float | None) -> None:
        self._period = period
        self._step = None if factor is None else seconds(period) / factor
        self._start = time.perf_counter()
        self.ticks = 0
        self.late_ticks = 0
        self.latest = 0.0

    def tick(self) -> None:
        """Notes the end of a tick, and waits until it is time for it."""
        self.ticks += 1
        if self._step is None:
            return
        early = self._start + self.ticks * self._step - time.perf_counter()
        if early > 0:
            time.sleep(early)
        elif early < 0:
            self.late_ticks += 1
            self.latest = max(self.latest, -early)

    def report(self, ended_by: Ending) -> RunReport:
        """Returns how the run went."""
        return RunReport(
            ended_by=ended_by,
            ticks=self.ticks,
            simulated=seconds(self.ticks * self._period),
            wall=time.perf_counter() - self._start,
            late_ticks=self.late_ticks,
            latest=self.latest,
        )
