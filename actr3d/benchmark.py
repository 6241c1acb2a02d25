"""Measurements with the limits that they must meet, and the registry of the benchmarks that make them."""

from __future__ import annotations

import gc
import json
import time
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from statistics import median
from typing import Literal, TypeVar

from actr3d.registry import Registry


@dataclass(frozen=True, kw_only=True)
class Measurement:
    """One measured value, and the limit that it must meet."""

    name: str
    value: float
    sense: Literal["at least", "at most"]
    limit: float
    what: str
    """What is measured, with its unit."""

    @property
    def is_met(self) -> bool:
        """Whether the value meets its limit."""
        return self.value >= self.limit if self.sense == "at least" else self.value <= self.limit


Benchmark = Callable[[], list[Measurement]]
"""Returns measurements."""
B = TypeVar("B", bound=Benchmark)
BENCHMARKS: Registry[Benchmark] = Registry("benchmark")
"""All benchmarks by name."""


def benchmark(name: str) -> Callable[[B], B]:
    """Registers a benchmark under its name for `actr3d bench`.

    Raises:
        ValueError: If there is a benchmark of this name already.
    """

    def register(function: B) -> B:
        BENCHMARKS.add(name, function)
        return function

    return register


def seconds_of(work: Callable[[], object], clock: Callable[[], float] = time.perf_counter) -> float:
    """Returns the duration of a call by a clock [s], with the garbage collector off."""
    gc.collect()
    gc.disable()
    try:
        start = clock()
        work()
        return clock() - start
    finally:
        gc.enable()


@contextmanager
def little_garbage() -> Generator[None]:
    """Excludes existing objects from garbage collection inside the block: the collector runs before each measurement."""
    gc.collect()
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()


def processor_time_of(work: Callable[[], object]) -> float:
    """Returns the processor time of a call [s], of all threads of this process; other processes do not count."""
    return seconds_of(work, time.process_time)


def ratio(slow: Callable[[], float], fast: Callable[[], float], rounds: int = 5) -> float:
    """Returns the median ratio of two costs, measured in turn so that changes of the machine's speed affect both equally."""
    return median(slow() / fast() for _ in range(rounds))


def report(measurements: Sequence[Measurement], *, json_output: bool) -> int:
    """Prints measurements; returns 0 if all meet their limits, else 1."""
    if json_output:
        found = {
            one.name: {"value": round(one.value, 4), "limit": f"{one.sense} {one.limit:g}", "met": one.is_met, "what": one.what}
            for one in measurements
        }
        print(json.dumps(found))
    else:
        width = max(len(one.name) for one in measurements)
        for one in measurements:
            limit = f"({one.sense} {one.limit:g})"
            print(f"{'met   ' if one.is_met else 'MISSED'}  {one.name:<{width}}  {one.value:10.2f}  {limit}  {one.what}")
    return 0 if all(one.is_met for one in measurements) else 1
