"""Runs the trials of an experiment on a Dask cluster, and stores each as soon as it has finished.

The tasks of the cluster are batches of trials. Each worker runs them in a process of its own (`TrialProcess`), so that a trial that
hangs or crashes ends neither the worker nor the other trials. This process alone writes to the store.
"""

from __future__ import annotations

import logging
import os
import threading
import time
from collections import deque
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import version
from itertools import islice
from queue import Empty, SimpleQueue
from typing import Any, NoReturn, cast

import dask.config
from distributed import Client, KilledWorker, LocalCluster, get_worker
from distributed.utils import silence_logging_cmgr

from actr3d.errors import ExperimentError
from actr3d.experiment.specification import Experiment
from actr3d.experiment.store import Finished, Store
from actr3d.experiment.trial import Row
from actr3d.experiment.trial_measures import check_row
from actr3d.experiment.trial_process import LEFT, TrialProcess
from actr3d.experiment.versions import experiment_versions

BATCH = 1.0
"""The intended duration of a batch of trials [s]: long enough to make the cost of a task small."""
LONGEST_BATCH = 2 * BATCH
"""The duration after which a batch begins no more trials [s]: its rows are not stored before it ends, and trials may take long."""
MAX_BATCH = 200
"""The maximum number of trials of a batch."""
AHEAD = 2
"""The number of batches for each worker that are submitted at a time."""
PATIENCE = 30.0
"""The maximum time to wait for a scheduler [s]. Workers may come, and go, at any time."""
KILLS = 3
"""The number of times that Dask gives up a trial that runs alone, each time after several workers ended while running it, until it counts
as failed."""
PACKAGES = ("dask", "distributed")
"""Packages whose versions the client and the workers must share; no row depends on them."""
SETTINGS: dict[str, Any] = {
    "distributed.scheduler.worker-saturation": AHEAD,
    "distributed.scheduler.worker-ttl": None,  # the workers here are threads of this process: they are late if all of it was suspended
    "distributed.comm.timeouts.connect": PATIENCE,
    "distributed.admin.log-length": 0,
    # Dask would measure itself many times a second, for a page that nobody opens.
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.scheduler.active-memory-manager.start": False,
}


@dataclass(frozen=True, kw_only=True)
class ExperimentProgress:
    """How far an experiment is."""

    done: int
    total: int
    failures: int
    workers: int


@dataclass(frozen=True, kw_only=True)
class Batch:
    """What a worker has done."""

    rows: list[tuple[int, Row, float]]
    """The number of each trial, its row, and its duration [s]. The row of a trial that did not answer has only `end` and `error`."""
    worker: str
    about: dict[str, dict[str, str | None]] = field(default_factory=dict[str, dict[str, "str | None"]])
    """Units and meanings of columns."""


@contextmanager
def local_cluster(workers: int) -> Generator[Any]:
    """Starts a scheduler and workers in threads of this process; each worker runs its trials in a process of its own, as everywhere."""
    local: Any = LocalCluster  # its types are incomplete
    options = {"threads_per_worker": 1, "processes": False, "dashboard_address": "127.0.0.1:0", "memory_limit": 0}
    with dask.config.set(SETTINGS), local(n_workers=workers, silence_logs=logging.CRITICAL, **options) as cluster:
        addresses = {worker.address for worker in cluster.workers.values()}
        try:
            with Client(cluster) as client:
                yield client
        finally:
            with _LOCK:
                own = [process for (address, _), process in _PROCESSES.items() if address in addresses]
            for process in own:
                process.close()  # a trial may run that nobody waits for any more


@contextmanager
def existing_cluster(address: str) -> Generator[Any]:
    """Connects to a scheduler.

    Args:
        address: Its address, such as `tcp://node1:8786`, or a scheduler file.

    Raises:
        ExperimentError: If there is no scheduler.
    """
    # Dask logs tracebacks of its own when a scheduler ends; what a user can do about it is in the errors here.
    with dask.config.set(SETTINGS), silence_logging_cmgr(logging.CRITICAL):
        try:
            client: Any = Client(scheduler_file=address, timeout=PATIENCE) if os.path.isfile(address) else Client(address, timeout=PATIENCE)  # noqa: PTH113
        except (OSError, TimeoutError, ValueError, ImportError, RuntimeError) as error:
            raise ExperimentError(f"--scheduler: no scheduler answers at '{address}' ({error or type(error).__name__})") from None
        with client:
            try:
                yield client
            finally:
                if client.status == "running":
                    with suppress(Exception):
                        client.run(end_processes, client.id, on_error="ignore")


def run_experiment(
    experiment: Experiment,
    store: Store,
    client: Any,
    *,
    show: Callable[[ExperimentProgress], object] = lambda _: None,
    stop: threading.Event | None = None,
    checked: bool = True,
) -> None:
    """Runs all trials that have no row yet.

    Args:
        experiment: The experiment.
        store: Its folder.
        client: The `distributed.Client` of the cluster.
        show: Called after each batch of trials, and when the number of workers changes.
        stop: Ends the run after the batches that have finished, when it is set by another thread.
        checked: Whether the names of the measures were checked before; otherwise the run ends if the first trial lacks one.

    Raises:
        DesignError: If the first trial lacks a measure, or has one that cannot be a measure.
        ExperimentError: If the versions of a worker are not those of the specification, the experiment cannot be loaded there,
            the cluster is lost, or the rows cannot be written.
    """
    with store.only_writer():
        _Run(experiment, store, client, show, stop or threading.Event(), checked).all()


class _Run:
    """The state of a run that goes on."""

    def __init__(
        self,
        experiment: Experiment,
        store: Store,
        client: Any,
        show: Callable[[ExperimentProgress], object],
        stop: threading.Event,
        checked: bool,
    ) -> None:
        self._experiment, self._store, self._client, self._show, self._stop = experiment, store, client, show, stop
        self._total, self._done, self._failures = len(experiment.design), store.count, store.failures
        self._json = experiment.specification.to_json()
        self._versions = ", ".join(f"{name} {text}" for name, text in experiment_versions().items())
        self._seconds, self._checked = BATCH, checked
        self._waiting: dict[Any, list[int]] = {}
        self._suspects: deque[int] = deque()
        self._killed: dict[int, int] = {}
        self._shown: ExperimentProgress | None = None
        self._finished: SimpleQueue[Any] = SimpleQueue()

    def all(self) -> None:
        """Runs the trials that have no row yet, until there are none or the run is stopped."""
        numbers = self._store.missing(self._total)
        self._report()
        while not self._stop.is_set():
            for batch in self._next_batches(numbers):
                self._submit(batch)
            if not self._waiting:
                return
            with suppress(Empty):
                future = self._finished.get(timeout=0.2)
                self._take(future, self._waiting.pop(future))
            if self._client.status not in ("running", "connecting"):
                self._lost()
        for future in [one for one in self._waiting if one.done()]:
            self._take(future, self._waiting.pop(future))
        self._client.cancel(list(self._waiting))

    def _workers(self) -> int:
        workers = self._client.scheduler_info(n_workers=-1).get("workers")
        if workers is None:  # the client has just been closed
            self._lost()
        return len(workers)

    def _next_batches(self, numbers: Iterator[int]) -> Iterator[list[int]]:
        """Yields batches until each worker has enough of them; the last ones are small, so that all workers end at about the same time.

        Once all other trials have finished, yields the suspects, one at a time.
        """
        most = max(1, self._report().workers) * AHEAD
        usual = min(MAX_BATCH, round(BATCH / max(self._seconds, 1e-6)))
        for _ in range(most - len(self._waiting)):
            left = self._total - self._done - sum(map(len, self._waiting.values()))
            batch = list(islice(numbers, max(1, min(usual, left // most))))
            if not batch:
                break
            yield batch
        if self._suspects and not self._waiting:
            yield [self._suspects.popleft()]

    def _submit(self, batch: list[int]) -> None:
        try:
            given = self._json, batch, self._experiment.design.limit, cluster_versions(), self._client.id
            future = self._client.submit(run_batch, *given, pure=False, priority=-batch[0])
        except (RuntimeError, OSError):  # the client has just been closed
            self._lost()
        self._waiting[future] = batch
        future.add_done_callback(self._finished.put)

    def _take(self, future: Any, numbers: list[int]) -> None:
        """Stores the rows of a finished batch, and submits the trials that it did not run: all of them if a worker or scheduler ended."""
        try:
            batch = cast("Batch", future.result(timeout=PATIENCE))
        except KilledWorker:
            self._suspect(numbers)
            return
        except (CancelledError, TimeoutError, OSError):
            if self._client.status != "running":
                self._lost()
            self._submit(numbers)
            return
        if batch.rows[0][0] == 0:
            check_row(batch.rows[0][1], checked=self._checked)
        self._add(batch)
        if left := numbers[len(batch.rows) :]:
            self._submit(left)
        self._report()

    def _add(self, batch: Batch) -> None:
        """Stores rows; to the row of a trial that did not answer, adds the columns that are known before it runs."""
        columns_of = self._experiment.design.columns_of
        rows = [
            Finished(row=row if "trial" in row else {**columns_of(number), **row}, wall_s=round(wall, 4), worker=batch.worker)
            for number, row, wall in batch.rows
        ]
        self._done += self._store.add(rows, self._versions, self._experiment.about | batch.about)
        self._failures += sum(one.row["error"] is not None for one in rows)
        if batch.worker:
            self._seconds = sum(one.wall_s for one in rows) / len(rows)

    def _suspect(self, numbers: list[int]) -> None:
        """Adds the trials of a batch whose workers ended repeatedly to the suspects; stores a trial that ended them alone as failed.

        Dask also gives up a batch that only waited on these workers, or whose workers were ended from outside. So a suspect runs again
        after all other trials, alone, and only its ends from then on count.
        """
        for number in numbers:
            self._killed[number] = self._killed.get(number, -1) + 1
            if self._killed[number] < KILLS:
                self._suspects.append(number)
                continue
            row = {"end": "crash", "error": "the workers that ran this trial ended repeatedly; it may need more memory than a worker has"}
            self._add(Batch(rows=[(number, row, 0.0)], worker=""))
            self._report()

    def _report(self) -> ExperimentProgress:
        """Returns the progress, and shows it if it is not shown yet."""
        progress = ExperimentProgress(done=self._done, total=self._total, failures=self._failures, workers=self._workers())
        if progress != self._shown:
            self._shown = progress
            self._show(progress)
        return progress

    def _lost(self) -> NoReturn:
        raise ExperimentError(f"the scheduler is gone; {self._done} of {self._total} trials are kept; continue with --resume") from None


# -- on the workers


@cache
def cluster_versions() -> dict[str, str]:
    """Returns the versions that a client and its workers must share."""
    return {**experiment_versions(), **{package: version(package) for package in PACKAGES}}


_PROCESSES: dict[tuple[str, int], TrialProcess] = {}
"""The process of each thread of a worker, by the address of the worker, "" for none, and the thread. Several workers may be in this
process. A closed process stays in the table, so that a batch that arrives late does not start another one."""
_LOCK = threading.Lock()


def run_batch(specification: str, numbers: Sequence[int], limit: float, expected: Mapping[str, str], client: str = "") -> Batch:
    """Runs trials on a worker, at least one, as long as a batch may take.

    Args:
        specification: The experiment, as JSON.
        numbers: The numbers of the trials.
        limit: The maximum wall time of each [s].
        expected: The versions of the client.
        client: Its name.

    Raises:
        ExperimentError: If the worker has other versions, or the experiment cannot be loaded.
    """
    worker = _worker("name") or str(os.getpid())
    own = cluster_versions()
    different = [f"{name} {own.get(name, 'none')} (the client has {text})" for name, text in expected.items() if own.get(name) != text]
    if different:
        raise ExperimentError(f"worker {worker}: has other versions: {', '.join(different)}; install the same on both")
    with _LOCK:
        process = _PROCESSES.setdefault((_worker("address"), threading.get_ident()), TrialProcess())
        process.client = client
    rows: list[tuple[int, Row, float]] = []
    end = time.perf_counter() + LONGEST_BATCH
    for number in numbers:
        if rows and time.perf_counter() >= end:
            break
        row = process.run(specification, number, limit)
        rows.append((number, {**process.columns, **row}, process.seconds))
    return Batch(rows=rows, worker=worker, about=process.about)


def end_processes(client: str) -> None:
    """Ends the child processes that run trials for a client, and starts no more trials for it."""
    LEFT.add(client)
    with _LOCK:
        for process in _PROCESSES.values():
            if process.client == client:
                process.end()


def _worker(what: str) -> str:
    """Returns a fact of the worker that runs this thread; "" outside of a cluster."""
    try:
        return str(getattr(get_worker(), what))
    except ValueError:
        return ""
