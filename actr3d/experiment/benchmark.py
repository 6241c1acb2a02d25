"""`actr3d bench experiment`: measures the cost of a trial relative to its physics, and how experiments scale with workers and rows;
`actr3d bench experiment-size` measures the latter with as many trials and rows as the largest experiments have.

The trials are those of the aperture model, except where the cost of an experiment itself is measured: there, they are a few
milliseconds long.
"""

from __future__ import annotations

import tempfile
import threading
import time
import tracemalloc
from collections.abc import Callable
from importlib import import_module
from itertools import islice
from pathlib import Path
from statistics import median
from typing import Any
from unittest.mock import patch

import mujoco

from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.benchmark import Measurement, benchmark, processor_time_of
from actr3d.experiment.specification import Experiment, specify
from actr3d.experiment.store import Store
from actr3d.experiment.trial import record_trial, run_trial
from actr3d.output import printing_nothing
from actr3d.processors import processors

DESIGN = "warren_whang_1987"
SAMPLE = 8
"""The number of trials whose cost is measured."""
ROWS, MOST_ROWS = 200_000, 1_000_000
"""The number of rows that are written."""
SMALL, MOST_SMALL = 4_000, 100_000
"""The number of small trials in which a change of the cost per trial would show."""
PROGRAM = '''
n = 3
from actr3d.actr import *


class Counter(ACTR):
    goal = Buffer()

    def init():
        goal.set("count 0")

    def count(goal="count ?k"):
        goal.set(f"count {int(k) + 1}" if int(k) < n else "done")


model = Counter()
model.run()
time = model.now()


from actr3d.experiment import Design, Group, design


@design
def counting():
    """Counts."""
    return Design(factors={"n": [1, 2, 3]}, groups={"all": Group(participants=10)}, trials=10_000, measures=["time"])
'''


def _aperture(folder: Path) -> list[Measurement]:
    """Returns the cost of trials of the aperture model as multiples of their physics, and of all trials of the paper's design."""
    plain, count = _Trials("descriptive"), iter(range(1_000_000))

    def recorded() -> None:
        with printing_nothing():
            for trial in plain.trials:
                record_trial(plain.experiment, trial, folder / f"{next(count)}.rec", plain.helpers)

    costs = [_cost(work) for work in (plain.run, recorded)]
    minutes = processor_time_of(plain.run) / SAMPLE * len(plain.experiment.design) / processors() / 60
    predictive = _Trials("predictive")
    return [
        Measurement(name="a trial", value=costs[0], sense="at most", limit=3, what="processor time of a trial / of mj_step in it"),
        Measurement(
            name="a recorded trial", value=costs[1], sense="at most", limit=3, what="processor time of a recorded trial / of mj_step in it"
        ),
        Measurement(
            name="a predictive trial",
            value=_cost(predictive.run),
            sense="at most",
            limit=4,
            what="processor time of a trial of the predictive variant / of mj_step in it",
        ),
        Measurement(name="the paper's design", value=minutes, sense="at most", limit=20, what="minutes for 9,600 trials on all processors"),
    ]


class _Trials:
    """Some trials of the paper's design, with a variant of the walker."""

    def __init__(self, variant: str) -> None:
        specification = specify(DESIGN, values={"variant": variant}).specification
        self.helpers = HelperTexts(specification.model.helpers)
        self.experiment = Experiment(specification, self.helpers)
        step = len(self.experiment.design) // SAMPLE
        self.trials = [self.experiment.design.trial(number * step) for number in range(SAMPLE)]
        self.run()  # what is loaded for the first of them is not measured

    def run(self) -> None:
        """Runs the trials."""
        for trial in self.trials:
            run_trial(self.experiment, trial, self.helpers)


def _cost(work: Callable[[], object]) -> float:
    """Returns the processor time of some work, divided by that of the physics steps in it: the median of three runs.

    The ratio depends neither on the speed of the machine nor on its other load.
    """
    step = mujoco.mj_step

    def once() -> float:
        whole, inside, steps = _clocked(work, step)
        # The clock takes time in and around each step: as much as for steps that do nothing.
        more, within, _ = _clocked(lambda: [mujoco.mj_step(None, None) for _ in range(steps)], lambda *_: None)  # pyright: ignore[reportArgumentType]
        return (whole - more) / (inside - within)

    return median(once() for _ in range(3))


def _clocked(work: Callable[[], object], step: Callable[..., object]) -> tuple[float, float, int]:
    """Returns the processor time of some work and of the physics steps in it [s], and their number; `step` is called for `mj_step`."""
    now, inside, steps = time.thread_time, 0.0, 0

    def timed(*given: Any) -> None:
        nonlocal inside, steps
        begin = now()
        step(*given)
        inside += now() - begin
        steps += 1

    with patch.object(mujoco, "mj_step", timed):
        return processor_time_of(work), inside, steps


def _small(folder: Path, trials: int) -> list[Measurement]:
    """Returns how the cost of small trials changes over many of them, as a multiple of other work beside them: machines change speed."""
    path = folder / "counting.py"
    path.write_text(PROGRAM, encoding="utf-8")
    specification = specify(str(path)).specification
    with specification.sealed() as helpers:
        experiment = Experiment(specification, helpers)
        costs: list[float] = []
        for trial in islice(experiment.design.table(), trials):
            begin = time.process_time()
            run_trial(experiment, trial, helpers)
            end = time.process_time()
            _beside()
            costs.append((end - begin) / (time.process_time() - end))
    part = trials // 4
    change = median(costs[-part:]) / median(costs[:part])
    what = f"cost of the last {part:,} of {trials:,} trials / of the first {part:,}"
    return [Measurement(name="many trials", value=change, sense="at most", limit=1.1, what=what)]


def _beside() -> list[str]:
    """Does something that takes about half as long as a small trial, and always the same."""
    return [str(number) for number in range(5_000)]


def _rows(folder: Path, count: int) -> list[Measurement]:
    """Returns how fast rows are written and how the memory for them grows."""
    from actr3d.experiment.store import Finished

    peaks: list[int] = []
    with Store.create(folder / "rows", specify(str(folder / "counting.py")).specification) as store:

        def write(first: int, last: int) -> None:
            for begin in range(first, last, 200):
                rows = [
                    {
                        "trial": n,
                        "participant": "all 1",
                        "group": "all",
                        **{f"m{k}": n / (k + 1) for k in range(15)},
                        "end": "end",
                        "error": None,
                    }
                    for n in range(begin, begin + 200)
                ]
                store.add([Finished(row=row, wall_s=0.1, worker="0") for row in rows], "versions")

        begin = time.perf_counter()
        write(0, count)
        rate = count / (time.perf_counter() - begin)
        for part in (10, 1):
            tracemalloc.start()
            write(count * (11 - part), count * (11 - part) + count // part)
            sum(1 for _ in islice(store.rows(), count // part))
            peaks.append(tracemalloc.get_traced_memory()[1])
            tracemalloc.stop()
    return [
        Measurement(name="writing", value=rate, sense="at least", limit=5_000, what=f"rows a second, of {count}"),
        Measurement(
            name="memory", value=peaks[1] / peaks[0], sense="at most", limit=1.2, what=f"peak memory for {count} rows / for {count // 10}"
        ),
    ]


def _begin(experiment: Experiment, store: Store, client: Any) -> None:
    """Runs a few trials, so that the processes of all workers have loaded the model."""
    from actr3d.experiment.cluster import run_experiment

    enough = threading.Event()
    run_experiment(experiment, store, client, show=lambda now: now.done < 8 or enough.set(), stop=enough)


def _workers(folder: Path) -> list[Measurement]:
    """Returns the speed of two workers relative to one."""
    from actr3d.experiment.cluster import local_cluster, run_experiment

    experiment = specify(DESIGN, participants=2, trials=2)
    took: list[float] = []
    for workers in (1, 2):
        with local_cluster(workers) as client:
            with Store.create(folder / f"{workers} workers at first", experiment.specification) as store:
                _begin(experiment, store, client)
            with Store.create(folder / f"{workers} workers", experiment.specification) as store:
                begin = time.perf_counter()
                run_experiment(experiment, store, client)
                took.append(time.perf_counter() - begin)
    return [
        Measurement(
            name="two workers", value=took[0] / took[1], sense="at least", limit=1.9, what="trials a second / those with one worker"
        )
    ]


@benchmark("experiment")
def measure() -> list[Measurement]:
    """Measures the cost of a trial, relative to its physics, and how experiments scale with workers, trials and rows."""
    import_module("actr3d.experiment.cluster")  # where its packages are not installed, this is known before the measurements
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        return [*_aperture(folder), *_small(folder, SMALL), *_rows(folder, ROWS), *_workers(folder)]


@benchmark("experiment-size")
def measure_size() -> list[Measurement]:
    """Measures how experiments scale with 100,000 trials and 1,000,000 rows: takes about 25 minutes."""
    with tempfile.TemporaryDirectory() as name:
        return [*_small(Path(name), MOST_SMALL), *_rows(Path(name), MOST_ROWS)]
