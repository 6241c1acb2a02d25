"""The command `actr3d experiment`: runs designs, continues them, and runs single trials again."""

from __future__ import annotations

import os
import re
import signal
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Generator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import FrameType
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from actr3d.errors import ExperimentError
from actr3d.experiment.cluster import Progress as State
from actr3d.experiment.cluster import existing_cluster, local_cluster, run_experiment
from actr3d.experiment.specification import Experiment, Specification, library_designs, specify
from actr3d.experiment.store import SPECIFICATION, Store
from actr3d.experiment.table import export
from actr3d.experiment.trial import record_trial
from actr3d.recording.schema import versions

EVERY = 10.0
"""Time between two lines of progress where the output is not a terminal [s]."""
SHOWN = 3
"""The number of different failures that are shown."""


def list_designs(console: Console) -> int:
    """Prints the library's designs."""
    console.print("Designs of the library; any file with a function marked by @design can be run, too:\n")
    for name in sorted(library_designs()):
        experiment = specify(name)
        first = " ".join(experiment.description.partition("\n\n")[0].split())
        console.print(f"  [bold]{name:<24}[/bold]{len(experiment.design):>8,} trials  {first}", highlight=False)
    return 0


def run(
    name: str,
    console: Console,
    *,
    values: Mapping[str, Any],
    participants: int | None = None,
    trials: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    out: str | None = None,
    resume: bool = False,
    any_version: bool = False,
) -> int:
    """Runs or continues an experiment, with progress; returns the exit code.

    Args:
        name: A design of the library, a file, `FILE:NAME`, or the folder of an experiment.
        console: Where to print.
        values: Values that replace those of the design.
        participants: The number of participants of each group; None for that of the design.
        trials: The number of trials of each combination of levels; None for that of the design.
        workers: The number of workers on this computer; None for one on each processor.
        scheduler: The address of an existing cluster; None for a cluster on this computer.
        out: The folder; None for one with the name of the design.
        resume: Whether to continue an experiment that is there.
        any_version: Whether to continue it with other versions of packages than those of its earlier trials.

    Raises:
        ExperimentError: If the experiment cannot be set up, run or continued.
        Exception: Any error that the files of the design and of the model themselves raise.
    """
    experiment, store = _opened(name, values, participants, trials, out, resume=resume, any_version=any_version)
    with store:
        total, begin, before = len(experiment.design), time.monotonic(), store.count
        console.print(
            f"[bold]{experiment.specification.name}[/bold]: {total:,} trials in '{store.folder}', {before:,} finished", highlight=False
        )
        if before < total:
            cluster = local_cluster(workers or os.cpu_count() or 1) if scheduler is None else existing_cluster(scheduler)
            with _stopping() as stop, cluster as client, _progress(console, total) as show:
                run_experiment(experiment, store, client, show=show, stop=stop)
            took, ran = time.monotonic() - begin, store.count - before
            console.print(f"{ran:,} trials in {took:,.0f} s ({ran / max(took, 1e-9):,.1f} a second)", highlight=False)
        files = export(store)
        console.print(f"table: {', '.join(str(path) for path in files)}", highlight=False)
        _show_failures(store, console)
        if store.count < total:
            console.print(f"stopped after {store.count:,} of {total:,} trials; continue with: actr3d experiment {store.folder} --resume")
            return 130
        return 1 if store.failures else 0


def show_state(folder: str, console: Console) -> int:
    """Prints how far an experiment is; returns the exit code."""
    with Store(folder) as store:
        experiment = Experiment(store.specification)
        total = len(experiment.design)
        console.print(f"{store.specification.name}: {store.count:,} of {total:,} trials have finished", highlight=False)
        _show_failures(store, console)
        if store.count < total:
            console.print(f"continue with: actr3d experiment {folder} --resume")
    return 0


def run_again(folder: str, number: int, recording: str, console: Console) -> int:
    """Runs a trial of an experiment again and records it; returns the exit code.

    Raises:
        ExperimentError: If there is no such trial.
        RecordingError: If the recording cannot be written.
        Exception: Any error that the model raises.
    """
    with Store(folder) as store, store.specification.sealed() as helpers:
        experiment = Experiment(store.specification, helpers)
        result = record_trial(experiment, experiment.design.trial(number), recording, helpers)
    if result is not None:
        console.print(str(result), highlight=False)
    console.print(f"trial {number} is recorded in '{recording}'", highlight=False)
    return 0


def is_folder(name: str) -> bool:
    """Returns whether a name is that of the folder of an experiment."""
    return (Path(name) / SPECIFICATION).is_file()


def _opened(
    name: str,
    values: Mapping[str, Any],
    participants: int | None,
    trials: int | None,
    out: str | None,
    *,
    resume: bool,
    any_version: bool,
) -> tuple[Experiment, Store]:
    """Creates or opens the folder of an experiment."""
    if is_folder(name):
        if values or participants is not None or trials is not None or out is not None:
            raise ExperimentError(f"'{name}' is an experiment, whose design is fixed; name a design to run it with other values")
        if not resume:
            raise ExperimentError(f"'{name}' is an experiment; continue it with --resume")
        store = Store(name)
        _check_versions(store.specification, any_version=any_version)
        return Experiment(store.specification), store
    experiment = specify(name, participants=participants, trials=trials, values=values)
    folder = out or experiment.specification.name
    if not (resume and is_folder(folder)):
        return experiment, Store.create(folder, experiment.specification)
    store = Store(folder)
    _check_versions(store.specification, any_version=any_version)
    there, wanted = store.specification, replace(experiment.specification, versions=store.specification.versions)
    if there.to_json() != wanted.to_json():
        names = ("name", "design", "model", "participants", "trials", "values")
        different = [one for one in names if getattr(there, one) != getattr(wanted, one)]
        raise ExperimentError(f"'{folder}' is another experiment: {' and '.join(different)} differ; choose another --out")
    return Experiment(there), store


def _check_versions(there: Specification, *, any_version: bool) -> None:
    now = versions()
    different = [f"{name} {text} (now {now.get(name, 'none')})" for name, text in there.versions.items() if now.get(name) != text]
    if different and not any_version:
        raise ExperimentError(f"the trials so far were run with {', '.join(different)}; install these versions, or add --any-version")


def _show_failures(store: Store, console: Console) -> None:
    if not store.failures:
        return
    kinds = Counter(summary(row["error"]) for row in store.rows() if row["error"] is not None)
    console.print(f"[bold red]{store.failures:,} trials failed[/bold red] (columns `end` and `error` of the table):", highlight=False)
    for text, count in kinds.most_common(SHOWN):
        console.print(f"  {count:,}  {text}", highlight=False, markup=False)


def summary(error: str) -> str:
    """Returns the line of a traceback that names the error; notes may follow it."""
    lines = error.strip().splitlines()
    return next((line for line in reversed(lines) if re.match(r"[\w.]+: ", line)), lines[-1])


@contextmanager
def _stopping() -> Generator[threading.Event]:
    """Sets the event at the first Ctrl-C or SIGTERM inside the block; a second one ends the program."""
    stop = threading.Event()

    def handle(number: int, frame: FrameType | None) -> None:  # noqa: ARG001 - the arguments of a signal handler
        if stop.is_set():
            raise KeyboardInterrupt
        stop.set()

    if threading.current_thread() is not threading.main_thread():
        yield stop
        return
    before = {number: signal.signal(number, handle) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def _progress(console: Console, total: int) -> Generator[Callable[[State], None]]:
    """Shows the progress inside the block: a bar in a terminal, else a line from time to time."""
    if not console.is_terminal:
        yield _lines(console)
        return
    columns = (
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[failed]}"),
    )
    with Progress(*columns, console=console) as bar:
        task = bar.add_task("", total=total, rate="", failed="")
        begin: list[tuple[float, int]] = []

        def show(state: State) -> None:
            begin.append((time.monotonic(), state.done)) if not begin else None
            failed = f"[red]{state.failures:,} failed[/red]" if state.failures else ""
            bar.update(task, completed=state.done, rate=_rate(begin[0], state), failed=failed)

        yield show


def _lines(console: Console) -> Callable[[State], None]:
    begin: list[tuple[float, int]] = []
    last = [0.0]

    def show(state: State) -> None:
        now = time.monotonic()
        if not begin:
            begin.append((now, state.done))
        if now - last[0] >= EVERY:
            last[0] = now
            console.print(f"{state.done:,} of {state.total:,} trials, {state.failures:,} failed {_rate(begin[0], state)}", highlight=False)

    return show


def _rate(begin: tuple[float, int], state: State) -> str:
    took, done = time.monotonic() - begin[0], state.done - begin[1]
    if not done:
        return f"{state.workers} workers"
    left = (state.total - state.done) * took / done
    return f"{done / took:,.1f}/s, {state.workers} workers, {left:,.0f} s left"


def console() -> Console:
    """Returns the console of the command."""
    return Console(file=sys.stdout, soft_wrap=True)
