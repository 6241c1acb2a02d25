"""The timer: an internal clock whose pulses get longer and longer."""

from __future__ import annotations

from collections.abc import Iterator

from actr3d.actr.kernel.events import Trigger
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.parameters import NotNegative, Positive, WithParameters, named_parameters
from actr3d.actr.modules.registry import module

SHORTEST = 1e-6
"""The shortest pulse [s]: the step of the clock."""


@module
class Timer(WithParameters, Model):
    """Counts pulses; pulse n + 1 lasts a t_n plus noise with standard deviation a b t_n.

    Args:
        startpulse: t_0 [s].
        a: The factor by which each pulse is longer than the one before.
        b: The relative noise of pulses.

    Source: Taatgen, van Rijn & Anderson (2007), Psychological Review 114; ACT-R's temporal module.
    """

    @named_parameters
    def __init__(self, startpulse: Positive = 0.011, a: Positive = 1.1, b: NotNegative = 0.015) -> None:
        self.startpulse = startpulse
        self.a = a
        self.b = b
        self.count = 0
        self.t = startpulse
        self._resets = 0
        self._restart = Trigger("timer reset")

    def reset(self) -> None:
        """Starts counting from 0."""
        self._resets += 1
        self.count = 0
        self.t = self.startpulse
        self.sch.trigger(self._restart)

    def start(self) -> Iterator[object]:
        """Counts pulses without end."""
        while True:
            before = self._resets
            yield max(SHORTEST, self.t), self._restart
            if self._resets == before:
                self.count += 1
                self.t = max(SHORTEST, self.random.gauss(self.a * self.t, self.a * self.t * self.b))
