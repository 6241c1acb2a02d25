"""What a whole program of models is held to while it is being loaded and run: its seed, its end, its trace."""

from __future__ import annotations

import random
from collections.abc import Callable
from contextvars import ContextVar, Token
from dataclasses import dataclass, field
from types import TracebackType
from typing import Self

from actr3d.clock import microseconds
from actr3d.trace import Trace


class EndOfRun(BaseException):
    """Ends a program that goes on asking for time after its last moment has come.

    It is no `Exception`, so that a model's own `except Exception` does not keep the program alive.
    """


@dataclass
class RunLimits:
    """The seed, end and trace of every top model made inside a `with RunLimits(...)` block."""

    seed: int | str | None = None
    """What all random choices come from; None draws a seed for each block, which its runs record."""
    until: float | None = None
    """When each run ends at the latest [s of simulated time]; None for no end."""
    trace: Trace | None = None
    """Where events go; None for no trace."""
    clock: Callable[[], int] = field(default=lambda: 0, repr=False)
    """Tells the time of the latest run [us]."""
    _drawn: int = 0
    _models: int = 0
    _tokens: list[Token[RunLimits | None]] = field(default_factory=list[Token["RunLimits | None"]])

    @staticmethod
    def current() -> RunLimits | None:
        """Returns the limits in force, if any."""
        return _CURRENT.get()

    @property
    def program_seed(self) -> int | str:
        """The seed that was given, or drawn for this block."""
        return self._drawn if self.seed is None else self.seed

    def next_seed(self) -> int | str:
        """Returns the seed of the next top model: the program's own for the first, one made from it for each other."""
        self._models += 1
        return self.program_seed if self._models == 1 else f"{self.program_seed}/{self._models}"

    def clip(self, now_us: int) -> int | None:
        """Returns when a run that starts now must end [us].

        Raises:
            EndOfRun: If that moment has come already.
        """
        if self.until is None:
            return None
        end = microseconds(self.until, "until")
        if now_us >= end and now_us > 0:
            raise EndOfRun
        return end

    def __enter__(self) -> Self:
        if not self._tokens:  # the same limits may serve one program after another
            self._drawn = fresh_seed()
            self._models = 0
        self._tokens.append(_CURRENT.set(self))
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        _CURRENT.reset(self._tokens.pop())


def fresh_seed() -> int:
    """Draws a seed from the system's own randomness."""
    return random.SystemRandom().getrandbits(32)


_CURRENT: ContextVar[RunLimits | None] = ContextVar("actr3d_run_limits", default=None)
