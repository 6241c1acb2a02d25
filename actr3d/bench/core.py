"""`actr3d bench core`: compares the cognitive core with python_actr, in one run on one machine."""

from __future__ import annotations

import atexit
import importlib
import importlib.util
import sys
import tempfile
import warnings
from collections.abc import Callable, Generator
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from pathlib import Path
from statistics import median
from types import ModuleType
from typing import Any

from actr3d.actr import ACTR, Buffer, Memory
from actr3d.actr.loading import load_text
from actr3d.benchmark import Measurement, benchmark, ratio, seconds_of
from actr3d.errors import SettingError

THREE = """
from python_actr import *
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('step:a count:0')
    def one(goal='step:a count:?n'):
        goal.modify(step='b')
    def two(goal='step:b count:?n'):
        goal.modify(step='c')
    def three(goal='step:c count:?n'):
        goal.modify(step='a')
"""
"""Three productions that fire in turn, forever."""

HUNDREDS = "\n".join(
    [
        "from python_actr import *",
        "class Agent(ACTR):",
        "    goal = Buffer()",
        "    def init():",
        "        goal.set('step:0 count:0')",
        *(f"    def p{i}(goal='step:{i} count:?n'):\n        goal.modify(step='{(i + 1) % 300}')" for i in range(300)),
    ]
)
"""Three hundred productions, one of which matches at any time."""

COUNTING = """
from python_actr import *
class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    def init():
        for i in range(SIZE):
            memory.add(f'count {i} {i + 1}')
        goal.set('counting 0')
        memory.request('count 0 ?next')
    def count_on(goal='counting ?now', retrieval='count ?now ?next'):
        goal.set('counting ?next')
        memory.request('count ?next ?after')
"""
"""Counts up through SIZE chunks."""


Loader = Callable[[str, str], ModuleType]
"""Returns the module of a model, from its source and its name."""


@contextmanager
def _peer() -> Generator[Loader]:
    """Provides a function that loads models for the original python_actr: from files, because it reads their source.

    Raises:
        SettingError: If python_actr is not installed.
    """
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings(), redirect_stdout(StringIO()):
        warnings.simplefilter("ignore")
        try:
            logger = importlib.import_module("python_actr.logger")
        except ModuleNotFoundError as error:
            raise SettingError(f"compares with another library ({error}); install: pip install python_actr") from None
        atexit.unregister(logger.finished)  # it would print a last line when the program ends, in the middle of the bench's output

        def load(source: str, name: str) -> ModuleType:
            path = Path(folder) / f"{name}.py"
            path.write_text(source, encoding="utf-8")
            spec = importlib.util.spec_from_file_location(f"peer_{name}", path)
            assert spec is not None
            assert spec.loader is not None
            module = importlib.util.module_from_spec(spec)
            sys.modules[module.__name__] = module
            spec.loader.exec_module(module)
            return module

        yield load


def _cost(module: ModuleType, before: float, length: float) -> float:
    """Returns the cost of running a new agent, after its first moments [s of real time per s of simulated time]."""
    agent: Any = module.Agent()
    agent.run(before)
    return seconds_of(lambda: agent.run(length)) / length


def _against_peer(load: Loader, source: str, name: str, before: float, own_time: float, peer_time: float) -> float:
    """Returns the time that python_actr takes for the same simulated time, relative to this library."""
    own, other = load_text(source, f"{name}.py"), load(source, name)
    return ratio(lambda: _cost(other, before, peer_time), lambda: _cost(own, before, own_time))


def _counting(load: Loader) -> tuple[float, float]:
    """Returns python_actr's relative time to learn 2,000 facts and count to 200, and for the counting alone."""
    source = COUNTING.replace("SIZE", "2000")
    own, other = load_text(source, "many.py"), load(source, "many")

    def cost(module: ModuleType) -> tuple[float, float]:
        agent: Any = module.Agent()
        return seconds_of(lambda: agent.run(0.101)), seconds_of(lambda: agent.run(20))

    peer_costs: list[tuple[float, float]] = []
    own_costs: list[tuple[float, float]] = []
    for _ in range(3):
        peer_costs.append(cost(other))
        own_costs += [cost(own) for _ in range(5)]  # one is short, and a single interruption would distort it
    whole = median(map(sum, peer_costs)) / median(map(sum, own_costs))
    return whole, median(counting for _, counting in peer_costs) / median(counting for _, counting in own_costs)


def _request_cost(size: int) -> Callable[[], float]:
    """Returns a function that measures one selective request among `size` chunks [s]."""
    retrieval = Buffer()
    memory = Memory(retrieval)
    agent = ACTR()
    agent.retrieval = retrieval
    agent.memory = memory
    agent.run(0.001)
    for i in range(size):
        memory.add({"kind": "fact", "number": str(i), "group": str(i % 7)})
    requests = 2000

    def ask() -> None:
        for i in range(requests):
            memory.request(f"kind:fact number:{i * 37 % size}")
            agent.run(0.05)

    ask()
    return lambda: seconds_of(ask) / requests


def _idle_tick() -> float:
    """Returns the cost of a 10 ms tick with nothing to do, minus an empty loop [us]."""
    agent = load_text(THREE.replace("step:a count:0", "nothing"), "idle.py").Agent()
    agent.run(1)
    ticks = 100_000

    def run() -> None:
        for _ in range(ticks):
            agent.run(0.01)

    def nothing() -> None:
        for _ in range(ticks):
            pass

    return min(seconds_of(run) - seconds_of(nothing) for _ in range(5)) / ticks * 1e6


def _traced_ratio() -> float:
    """Returns the run time of the counting model with full tracing, relative to the run without."""
    module = load_text(COUNTING.replace("SIZE", "1000"), "counting.py")

    def run(level: str | None) -> float:
        agent: Any = module.Agent()
        agent.run(0.001)
        if level is not None:
            agent.traced(level)
        return seconds_of(lambda: agent.run(80))

    run("all")
    return ratio(lambda: run("all"), lambda: run(None), rounds=9)


@benchmark("core")
def measure() -> list[Measurement]:
    """Compares the cognitive core with python_actr, in one run on one machine.

    Raises:
        SettingError: If python_actr is not installed.
    """
    with _peer() as load:
        three = _against_peer(load, THREE, "three", 1, 400, 400)
        hundreds = _against_peer(load, HUNDREDS, "hundreds", 16, 200, 20)
        counting, each_count = _counting(load)
    small, large = _request_cost(1_000), _request_cost(100_000)
    speed = "times python_actr's speed"
    return [
        Measurement(name="three productions", value=three, sense="at least", limit=1.5, what="times python_actr's cycles a second"),
        Measurement(name="300 productions", value=hundreds, sense="at least", limit=10, what="times python_actr's cycles a second"),
        Measurement(name="counting, 2,000 chunks", value=counting, sense="at least", limit=100, what=f"{speed}, from learning them on"),
        Measurement(name="a count among 2,000 chunks", value=each_count, sense="at least", limit=40, what=f"{speed}, once learned"),
        Measurement(name="request, 100,000 chunks", value=ratio(large, small), sense="at most", limit=2, what="times one among 1,000"),
        Measurement(name="idle tick", value=_idle_tick(), sense="at most", limit=3, what="us more than an empty loop"),
        Measurement(name="full tracing", value=_traced_ratio(), sense="at most", limit=2, what="times the untraced counting model"),
    ]
