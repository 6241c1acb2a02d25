"""The limits of a program of models while it is loaded and run: its seed, its end, its trace."""

from __future__ import annotations

import random
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from contextvars import ContextVar, Token
from dataclasses import dataclass, field, replace
from types import TracebackType
from typing import Any, NoReturn, Protocol, Self
from weakref import WeakSet

from actr3d.clock import microseconds
from actr3d.errors import ParameterError
from actr3d.trace import Trace


class EndOfRun(BaseException):
    """Ends a program that keeps asking for time after its end.

    It is not an `Exception`, so that a model's own `except Exception` does not keep the program alive.
    """


MAX_REFUSALS = 100
"""The number of refused requests for time after which a program counts as one that catches every error and never ends by itself."""


Contacts = Mapping[tuple[str, str, str], float]
"""The contacts of a tick: by body, its part, and the other object, the greatest force [N]."""


class Recorder(Protocol):
    """Records what the simulations of a program do besides events; `run` is the number in the program's trace."""

    def fact(self, name: str, value: Any) -> None:
        """Records a fact of the program: plain values."""
        ...

    def state(self, run: int, tick: int, data: bytes, contacts: Contacts) -> None:
        """Records the physics state at the start of a run, or at the end of a tick, and the contacts in that tick."""
        ...

    def answer(self, run: int, tick: int, body: str, word: str, value: Any) -> None:
        """Records a body's answer at the end of a tick."""
        ...

    def command(self, run: int, tick: int, data: Mapping[str, Any]) -> None:
        """Records a user's command that was given after a tick."""
        ...


@dataclass(eq=False)
class RunLimits:
    """The seed, end and trace of every top model made inside a `with RunLimits(...)` block, also by threads started in it."""

    seed: int | str | None = None
    """The seed of all random choices, a whole number >= 0 or a text; None draws a seed for each block, which its runs record."""
    until: float | None = None
    """The end of every run [s of its own simulated time]; the program ends with the first run that is cut short there. A run that ends
    by itself is never cut, so a program that makes one short run after another without end continues until it is interrupted.
    None for no end."""
    trace: Trace | None = None
    """The trace that receives the events; None for no trace."""
    recorder: Recorder | None = None
    """The recorder for what simulations do besides a trace of everything; None for none."""
    clock: Callable[[], int] = field(default=lambda: 0, repr=False)
    """Returns the time of the latest run [us]; `follow` sets it."""
    passing: Callable[[Any, int], object] | None = field(default=None, repr=False)
    """Called before the time of a run advances, after all events at that time: with the run's scheduler and the new time [us]. It may
    block the program, or end it with an `EndOfRun`. It returns True if a user has changed something: then the events up to the present
    time are run, and it is called again."""
    ticked: Callable[[Any, int], object] | None = field(default=None, repr=False)
    """Called with a simulation before its first tick and after each tock, and with the time passed [us]; replaces `passing`,
    which would be called within a tick. It may give the simulation commands."""
    last_resort: Callable[[], Any] | None = field(default=None, repr=False)
    """Ends a program that keeps asking for time although every further run raises `EndOfRun`: called after 100 requests."""
    _outer: RunLimits | None = field(default=None, init=False, repr=False)
    _ended: bool = field(default=False, init=False, repr=False)
    _refused: int = field(default=0, init=False, repr=False)
    _drawn: int = field(default=0, init=False, repr=False)
    _models: int = field(default=0, init=False, repr=False)
    _tokens: list[Token[RunLimits | None]] = field(default_factory=list[Token["RunLimits | None"]], init=False, repr=False)
    _threads: WeakSet[threading.Thread] = field(default_factory=WeakSet[threading.Thread], init=False, repr=False)

    def __post_init__(self) -> None:
        """Checks the seed.

        Raises:
            ParameterError: If it is negative: Python's random numbers would be those of the positive number.
        """
        if isinstance(self.seed, int) and self.seed < 0:
            raise ParameterError(f"RunLimits.seed: must be >= 0 (got {self.seed})")

    @staticmethod
    def current() -> RunLimits | None:
        """Returns the limits in force, if any."""
        return _CURRENT.get()

    def inner(self, seed: int | str | None) -> RunLimits:
        """Returns limits for a program that this program runs: the same ones, with a seed of their own."""
        return replace(self, seed=seed)

    def follow(self, clock: Callable[[], int]) -> None:
        """Sets what returns the time of the latest run [us], also for the limits outside these."""
        self.clock = clock
        if self._outer is not None:
            self._outer.follow(clock)

    @property
    def program_seed(self) -> int | str:
        """The seed that was given, or drawn for this block."""
        return self._drawn if self.seed is None else self.seed

    def next_seed(self) -> int | str:
        """Returns the seed of the next top model: the program's own for the first, and one derived from it for each other.

        If several threads make models at the same time, the assignment of seeds depends on their timing; it is
        reproducible only if they make models one after the other.
        """
        with _LOCK:
            self._models += 1
            number = self._models
        return self.program_seed if number == 1 else f"{self.program_seed}/{number}"

    # -- the end

    @property
    def _until_us(self) -> int:
        """The end [us], where there is one."""
        return microseconds(self.until or 0, "until")

    @property
    def ended(self) -> bool:
        """Whether the end has come, of these limits or of those outside them: no run gets any more time."""
        return self._ended or (self._outer is not None and self._outer.ended)

    def clip(self) -> int | None:
        """Returns the end of every run [us]; None if there is no end.

        Raises:
            EndOfRun: If a run was cut short before.
        """
        outer = self._outer.clip() if self._outer is not None else None
        if self.until is None:
            return outer
        if self._ended:
            self._refuse()
        last = self._until_us
        return last if outer is None else min(last, outer)

    def refuse(self, wanted_us: int) -> NoReturn:
        """Refuses a run the time until `wanted_us` [us].

        Raises:
            EndOfRun: Always.
        """
        self.cut(wanted_us)
        self._refuse()

    def _refuse(self) -> NoReturn:
        self._refused += 1
        if self._refused > MAX_REFUSALS and self.last_resort is not None:
            self.last_resort()
        raise EndOfRun

    def cut(self, wanted_us: int) -> None:
        """Stores that a run was cut short that needed to continue to `wanted_us` [us]: a limit before that gives no more time."""
        if self.until is not None and self._until_us < wanted_us:
            self._ended = True
        if self._outer is not None:
            self._outer.cut(wanted_us)

    # -- entering and leaving the block

    def __enter__(self) -> Self:
        if not self._tokens:  # the same limits may be used for one program after another
            self._drawn = fresh_seed()
            self._models = self._refused = 0
            self._ended = False
            self._outer = _CURRENT.get()
        self._tokens.append(_CURRENT.set(self))
        _follow_threads(1)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        _follow_threads(-1)
        _CURRENT.reset(self._tokens.pop())

    def adopt(self, thread: threading.Thread) -> None:
        """Applies these limits to a thread that is about to start."""
        run = thread.run

        def run_within() -> None:
            _CURRENT.set(self)
            with suppress(EndOfRun):
                run()

        thread.run = run_within
        self._threads.add(thread)

    def wait_for_threads(self) -> None:
        """Waits for the threads that were started under these limits, as Python itself does at the end of a program.

        Does not wait for daemon threads, nor for those of a thread pool, which end only with Python.
        """
        while waiting := [thread for thread in list(self._threads) if thread.is_alive() and not thread.daemon and not _of_pool(thread)]:
            for thread in waiting:
                thread.join()


def fresh_seed() -> int:
    """Returns a new seed from the system's random source."""
    return random.SystemRandom().getrandbits(32)


_CURRENT: ContextVar[RunLimits | None] = ContextVar("actr3d_run_limits", default=None)
_LOCK = threading.Lock()
_START = threading.Thread.start
_blocks = 0


def _start(self: threading.Thread) -> None:
    """Starts a thread with the limits of the thread that starts it (before Python 3.14, threads do not inherit them)."""
    limits = _CURRENT.get()
    if limits is not None:
        limits.adopt(self)
    _START(self)


def _follow_threads(more: int) -> None:
    """Replaces `Thread.start` by `_start` while any block is open."""
    global _blocks
    with _LOCK:
        _blocks += more
        if _blocks and threading.Thread.start is _START:
            threading.Thread.start = _start
        elif not _blocks and threading.Thread.start is _start:
            threading.Thread.start = _START


def _of_pool(thread: threading.Thread) -> bool:
    return getattr(getattr(thread, "_target", None), "__module__", "") == "concurrent.futures.thread"
