"""The command `actr3d experiment`: runs designs, continues them, and runs single trials again."""

from __future__ import annotations

import json
import math
import os
import signal
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, nullcontext
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.text import Text

from actr3d.errors import DesignError, ExperimentError, SettingError, reason_of
from actr3d.experiment.design import OWN_COLUMNS
from actr3d.experiment.plain_values import plain_text
from actr3d.experiment.specification import Experiment, Specification, library_designs, specify
from actr3d.experiment.store import LOCK, SPECIFICATION, Store, only_process, summary, write_whole
from actr3d.experiment.table import export
from actr3d.experiment.trial import PLAIN, record_trial
from actr3d.experiment.trial_measures import NOTHING_LEFT, check_measures, check_row, ended_early, try_measures
from actr3d.experiment.trial_process import TIME_LIMIT, TrialProcess
from actr3d.experiment.versions import experiment_versions
from actr3d.processors import processors
from actr3d.values import to_json

if TYPE_CHECKING:
    from actr3d.experiment.cluster import ExperimentProgress
    from actr3d.experiment.fit import FitResult
    from actr3d.experiment.target import Agreement

EVERY = 10.0
"""Time between two lines of progress where the output is not a terminal [s]."""
SHOWN = 3
"""The number of different failures that are shown."""


class Output:
    """The output of the command: text for people, or with `json` one JSON object a line for programs."""

    def __init__(self, *, json: bool) -> None:
        self.json = json
        self.console = Console(file=sys.stdout, soft_wrap=True)

    def line(self, *parts: str | tuple[str, str]) -> None:
        """Prints a line, unless the output is JSON: texts as they are, each alone or with the style in which it is printed."""
        if not self.json:
            self.console.print(Text.assemble(*parts))

    def event(self, name: str, data: Mapping[str, Any]) -> None:
        """Prints an object, if the output is JSON."""
        if self.json:
            sys.stdout.write(f"{to_json({'event': name, **data})}\n")
            sys.stdout.flush()


def list_designs(out: Output) -> int:
    """Prints the library's designs, the main one first."""
    out.line("Designs of the library; any file with a function marked by @design can be run, too:\n")
    for name in library_designs():
        experiment = specify(name)
        out.event("design", {"name": name, "trials": len(experiment.design), "description": experiment.description})
        first = " ".join(experiment.description.partition("\n\n")[0].split())
        out.line("  ", (f"{name:<24}", "bold"), f"{len(experiment.design):>8,} trials  {first}")
    return 0


def check(name: str, out: Output, *, values: Mapping[str, Any], participants: int | None = None, trials: int | None = None) -> int:
    """Checks a design, runs its first two trials, and prints what the experiment would be; returns the exit code.

    Raises:
        ExperimentError: If the design is not valid.
        Exception: Any error that the files of the design and of the model themselves raise.
    """
    experiment = specify(name, participants=participants, trials=trials, values=values)
    design, total = experiment.design, len(experiment.design)
    check_measures(experiment)
    facts = facts_of(experiment)
    out.event("facts", facts)
    process, text = TrialProcess(), experiment.specification.to_json()
    try:
        first = process.run(text, 0, design.limit)  # it also takes the time of what is loaded or compiled once
        check_row(first)
        second = process.run(text, min(1, total - 1), design.limit)
        check_row(second, checked=first["error"] is None)
        seconds = process.seconds
    finally:
        process.end()
    failed = [(number, row["error"]) for number, row in enumerate((first, second)[:total]) if row["error"] is not None]
    groups = {name: group.participants for name, group in design.groups.items()}
    about = {**facts, "seconds_a_trial": round(seconds, 3), "error": failed[0][1] if failed else None}
    out.event("check", about)
    people = ", ".join(f"{count} {name}" for name, count in groups.items())
    out.line((str(about["name"]), "bold"), f": {_trials(total)} of '{about['model']}' by participants: {people}")
    for factor, levels in design.factors.items():
        out.line(f"  {factor}: {', '.join(map(_shown, levels))}")
    for group, own in design.groups.items():
        for name, value in own.parameters.items():
            out.line(f"  {name} of {group}: {_shown(value)}")
    for name, value in design.settings.items():
        out.line(f"  {name}: {_shown(value)}")
    out.line(f"a trial takes {seconds:.2f} s on one processor; all take about {seconds * total / processors():,.0f} s on this computer")
    if ended_early((first["end"], second["end"])):
        out.line("its first trials ", (NOTHING_LEFT, "bold"))
    for number, error in failed:
        out.line(f"trial {number} failed: {error}")
    return 1 if failed else 0


def run(
    name: str,
    out: Output,
    *,
    values: Mapping[str, Any],
    participants: int | None = None,
    trials: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    folder: str | None = None,
    resume: bool = False,
    any_version: bool = False,
) -> int:
    """Runs or continues an experiment, with progress; returns the exit code.

    Args:
        name: A design of the library, a file, `FILE:NAME`, or the folder of an experiment.
        out: Where to print.
        values: Values that replace those of the design.
        participants: The number of participants of each group; None for that of the design.
        trials: The number of trials of each combination of levels; None for that of the design.
        workers: The number of workers on this computer; None for one on each processor.
        scheduler: The address of an existing cluster; None for a cluster on this computer.
        folder: The folder of the results; None for one with the name of the design.
        resume: Whether to continue an experiment that is there.
        any_version: Whether to continue it with other versions of packages than those of its earlier trials.

    Raises:
        ExperimentError: If the experiment cannot be set up, run or continued.
        Exception: Any error that the files of the design and of the model themselves raise.
    """
    from actr3d.experiment.cluster import existing_cluster, local_cluster, run_experiment  # Dask takes long to load

    with ExitStack() as opened:
        # Before the folder is made: a cluster may not answer.
        cluster = None if scheduler is None else opened.enter_context(existing_cluster(scheduler))
        experiment, store, checked = _opened(opened, name, values, participants, trials, folder, resume=resume, any_version=any_version)
        total, begin, before = len(experiment.design), time.monotonic(), store.count
        facts = facts_of(experiment)
        # Of a finished experiment, nothing need be written on a disk that can only be read.
        writes = before < total or os.access(store.folder, os.W_OK, effective_ids=True)
        if writes:
            store.write_facts({"event": "facts", **facts})
        out.event("facts", {**facts, "folder": str(store.folder)})
        out.line((experiment.specification.name, "bold"), f": {_trials(total)} in '{store.folder}', {before:,} finished")
        if before < total:
            with (
                _stopping() as stop,
                local_cluster(workers or processors()) if cluster is None else nullcontext(cluster) as client,
                _progress(out, "", total) as show,
            ):
                try:
                    run_experiment(experiment, store, client, show=show, stop=stop, checked=checked)
                except DesignError:
                    out.line(f"corrected files need another folder: delete '{store.folder}', or give another one with --out")
                    raise
            took, ran = time.monotonic() - begin, store.count - before
            out.line(f"{_trials(ran)} in {took:,.0f} s ({ran / max(took, 1e-9):,.1f} a second)")
        if writes:
            out.line(f"table: {', '.join(str(path) for path in export(store))}")
        _show_failures(store, out)
        out.event("end", {"done": store.count, "total": total, "failures": store.failures, "folder": str(store.folder)})
        if store.count < total:
            out.line(f"stopped after {store.count:,} of {total:,} trials; continue with: actr3d experiment {store.folder} --resume")
            return 130
        return 1 if store.failures else 0


def fit(
    name: str,
    out: Output,
    *,
    ranges: Sequence[str],
    target: str | None,
    measure: str | None,
    candidates: int,
    hold_out: Sequence[str],
    ablate: Sequence[str],
    recover: int,
    values: Mapping[str, Any],
    participants: int | None = None,
    trials: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    folder: str | None = None,
) -> int:
    """Fits parameters of a model to means, or continues a fit that is in the folder; returns the exit code.

    Raises:
        ExperimentError: If the fit cannot be set up or run.
        Exception: Any error that the files of the design and of the model themselves raise.
    """
    from actr3d.experiment.cluster import existing_cluster, local_cluster
    from actr3d.experiment.fit import Fit, HeldOut, Range
    from actr3d.experiment.target import TargetMean, check_measure, load_target, measures_of

    def means(experiment: Experiment, data: str | None, give: str, measure: str | None) -> tuple[TargetMean, ...]:
        data = data or experiment.design.human
        if data is None:
            raise ExperimentError(f"design '{experiment.specification.name}': names no human data; give {give}")
        found, kept = load_target(data, experiment, measure), experiment.design.kept
        if not check_measures(experiment):
            row = try_measures(experiment)
            if row is not None and not kept:
                check_measure(found[0].measure, [name for name in row if name not in OWN_COLUMNS], experiment)
        return found

    def loaded(design: str, data: str) -> HeldOut:
        try:
            experiment = specify(design)
            has = measures_of(experiment)
            target = means(experiment, data, f"--hold-out {design}=FILE", measure if not has or measure in has else None)
            return HeldOut(experiment=experiment, target=target)
        except DesignError:  # names the design
            raise
        except ExperimentError as error:
            raise ExperimentError(f"--hold-out {design}: {error}") from None

    fitted = specify(name, participants=participants, trials=trials, values=values)
    path = Path(folder or f"fit {fitted.specification.name}")
    check_folder_of_fit(path)
    wanted = means(fitted, target, "--target FILE", measure)
    named = [given.partition("=") for given in hold_out]
    if twice := [design for design, count in Counter(design for design, _, _ in named).items() if count > 1]:
        raise SettingError(f"--hold-out {twice[0]}: is given twice; give one")
    held_out = {design: loaded(design, data) for design, _, data in named}
    searched = [Range.from_text(text) for text in ranges]
    for one in searched:
        groups = fitted.design.groups.items()
        drawn = [f"{group}: {of.parameters[one.name]}" for group, of in groups if one.name in of.parameters]
        if drawn:
            out.line(f"{one.name} is fitted as one value for all participants, instead of those of the design ({'; '.join(drawn)})")

    @contextmanager
    def open_cluster() -> Generator[Any]:
        # First the cluster, which may not answer: then no folder is made.
        with (
            local_cluster(workers or processors()) if scheduler is None else existing_cluster(scheduler) as client,
            _folder_of_fit(path),
        ):
            yield client

    def evaluated(rmse: float) -> None:
        out.line(f"RMSE {rmse:.4g}" if math.isfinite(rmse) else "not all means of the target, or failed trials")

    progress = partial(_progress, out)
    running = Fit(name, fitted, searched, wanted, path, open_cluster, progress=progress, evaluated=evaluated)
    try:
        result = running.run(candidates, held_out=held_out, ablate=ablate, recover=recover)
    except KeyboardInterrupt:
        out.line("finished trials are kept: the same command continues the fit")
        raise
    write_whole(path / "fit.json", json.dumps(asdict(result), indent=1, ensure_ascii=False))
    out.event("fit", asdict(result))
    _show_fit(result, out)
    out.line(f"result: {path / 'fit.json'}")
    return 0


def _show_fit(result: FitResult, out: Output) -> None:
    """Prints the parameters, and how well the model agrees with each target."""
    out.line(("\nfitted", "bold"), f" to {result.fit.cells} means of {result.measure}, from {result.candidates} candidates")
    few = result.fit.cells <= len(result.parameters)
    none = "none: it needs more means than parameters" if few else "not determined" if result.is_confirmed else "none yet"
    for one in result.parameters:
        low, high = (none if bound is None else f"{bound:g}" for bound in (one.low, one.high))
        out.line(f"  {one.name} = {one.value:g}   95 % interval: {low if low == high else f'{low} to {high}'}")
    if result.predicted_worst is not None:
        near = ", ".join(f"{name} = {value:g}" for name, value in result.predicted_worst.items())
        out.line("These values are the best that were tried: the model is not predicted well enough between candidates; run more of them.")
        out.line(f"It is predicted worst near {near}. If its means jump there, fit in a range without the jump;")
        out.line("if they vary by chance, run more trials or participants.")
    for title, agreements in (("the fit", {"": result.fit}), ("held out", result.held_out), ("changed", result.ablated)):
        for what, found in agreements.items():
            r, r2 = ("none" if value is None else f"{value:.3f}" for value in (found.r, found.r2))
            says = found.failure or f"RMSE {found.rmse:.4g}, r {r}, r2 {r2}, {found.cells} means"
            out.line(f"{title} {what}".rstrip() + f": {says}", *_lost(found))
    for line in _effects(result.fit, result.ablated):
        out.line(line)
    if failing := [one for one in result.tried if one.failed]:
        counts = f"{sum(one.failed for one in failing):,} of {sum(one.trials for one in result.tried):,} trials"
        out.line(("warning", "bold red"), f": in {len(failing)} of {result.candidates} candidates, {counts} failed; see tried in fit.json")
    for number, one in enumerate(result.recovered, start=1):
        pairs = ", ".join(f"{each.name} {one[f'true {each.name}']:g} found as {one[each.name]:g}" for each in result.parameters)
        out.line(f"simulated data {number}: {pairs}")


def _effects(fit: Agreement, changed: Mapping[str, Agreement]) -> list[str]:
    """Returns lines that show the effect of each change of the model: for each mean the target, the fitted model, and the changed ones."""

    def means(of: Agreement) -> dict[str, dict[str, Any]]:
        return {
            ", ".join(f"{name} {plain_text(level)}" for name, level in row.items() if name not in ("target", "model")): row
            for row in of.rows
        }

    if not changed:
        return []
    models = {"fitted": means(fit), **{change: means(found) for change, found in changed.items()}}
    targets = {where: row["target"] for rows in models.values() for where, row in rows.items()}
    lines = [f"mean by condition: target, {', '.join(models)}"]
    for where, target in targets.items():
        found = [f"{rows[where]['model']:.4g}" if where in rows else "none" for rows in models.values()]
        lines.append(f"  {where or 'all'}: {', '.join([f'{target:.4g}', *found])}")
    return lines


def _lost(found: Agreement) -> list[tuple[str, str]]:
    """Returns a warning of trials that failed, and of means that are not compared, as parts of a line; none if there are none."""
    lost = [f"{found.failed:,} of {found.trials:,} trials failed"] if found.failed else []
    lost += [f"{found.missing} means of the target are not compared"] if found.missing else []
    return [(f"; {', '.join(lost)}", "bold red")] if lost else []


def facts_of(experiment: Experiment) -> dict[str, Any]:
    """Returns what programs show of an experiment: its size, factors, groups, and the parameters of its model."""
    design, specification = experiment.design, experiment.specification
    return {
        "name": specification.name,
        "description": experiment.description,
        "trials": len(design),
        "trials_a_cell": design.trials,
        "factors": {name: list(levels) for name, levels in design.factors.items()},
        "groups": {name: group.participants for name, group in design.groups.items()},
        "group_parameters": {
            name: {key: value if isinstance(value, PLAIN) else str(value) for key, value in group.parameters.items()}
            for name, group in design.groups.items()
        },
        "settings": {name: value if isinstance(value, PLAIN) else str(value) for name, value in design.settings.items()},
        "changed": experiment.changes,
        "measures": [asdict(one) for one in design.kept],
        "seed": design.seed,
        "model": specification.model.file,
        "parameters": [
            {
                "name": one.name,
                "help": one.help,
                "unit": one.unit,
                "default": one.default if one.known else None,
                "known": one.known and not one.required,
                "choices": one.choices,
            }
            for one in experiment.parameters
        ],
    }


def show_state(folder: str, out: Output) -> int:
    """Prints how far an experiment is; returns the exit code."""
    with Store(folder) as store:
        experiment = Experiment(store.specification)
        total = len(experiment.design)
        state = {"done": store.count, "total": total, "failures": store.failures, "folder": str(store.folder)}
        out.event("state", {**state, "name": store.specification.name})
        out.line(f"{store.specification.name}: {store.count:,} of {total:,} trials have finished")
        _show_failures(store, out)
        if store.count < total:
            out.line(f"continue with: actr3d experiment {folder} --resume")
    return 0


def run_again(folder: str, number: int, recording: str, out: Output) -> int:
    """Runs a trial of an experiment again and records it; returns the exit code.

    Raises:
        ExperimentError: If there is no such trial.
        RecordingError: If the recording cannot be written.
        Exception: Any error that the model raises.
    """
    with Store(folder) as store, store.specification.sealed() as helpers:
        experiment, row = Experiment(store.specification, helpers), store.row(number)
        if row is not None and row["error"] is not None:
            out.line(f"in the experiment this trial failed: {summary(row['error'])}")
            if row["end"] == TIME_LIMIT:
                out.line("here it has no limit: Ctrl-C ends it, and what has happened until then is recorded")
        result = record_trial(experiment, experiment.design.trial(number), recording, helpers)
    if result is not None:
        out.line(str(result))
    out.line(f"trial {number} is recorded in '{recording}'")
    if different := _other_versions(experiment.specification):
        out.line(f"it may differ from its row: the experiment was begun with {', '.join(different)}")
    return 0


def is_folder(name: str) -> bool:
    """Returns whether a name is that of the folder of an experiment.

    Raises:
        ExperimentError: If that cannot be read, such as for a name that is too long.
    """
    try:
        return (Path(name) / SPECIFICATION).is_file()
    except OSError as error:
        raise ExperimentError(f"cannot read '{name}' ({reason_of(error)})") from None


def _opened(
    opened: ExitStack,
    name: str,
    values: Mapping[str, Any],
    participants: int | None,
    trials: int | None,
    folder: str | None,
    *,
    resume: bool,
    any_version: bool,
) -> tuple[Experiment, Store, bool]:
    """Creates or opens the folder of an experiment, which the stack `opened` closes; also returns `checked` for `run_experiment`."""
    changed = bool(values) or participants is not None or trials is not None or folder is not None
    # The folder of an experiment has the name of its design, unless it was given another one.
    if is_folder(name) and not (changed and name in library_designs()):
        if changed:
            raise ExperimentError(f"'{name}' is an experiment, whose design is fixed; name a design to run it with other values")
        if not resume:
            raise ExperimentError(f"'{name}' is an experiment; continue it with --resume")
        store = opened.enter_context(Store(name))
        _check_versions(store.specification, any_version=any_version)
        return Experiment(store.specification), store, True
    experiment = specify(name, participants=participants, trials=trials, values=values)
    folder = folder or experiment.specification.name
    if not (resume and is_folder(folder)):
        checked = check_measures(experiment) or try_measures(experiment) is not None
        return experiment, opened.enter_context(Store.create(folder, experiment.specification)), checked
    store = opened.enter_context(Store(folder))
    _check_versions(store.specification, any_version=any_version)
    there, now = store.specification, experiment.specification
    if different := experiment.differences_from(there):
        same = f"continue it unchanged: actr3d experiment {folder} --resume{' --any-version' * any_version}"
        same = f"choose another --out, delete the folder, or {same}"
        raise ExperimentError(f"'{folder}' is another experiment: {'; '.join(different)}; {same}")
    # The files may be at another place now, and other files that the model reads beside them.
    return Experiment(replace(there, design=now.design, model=now.model)), store, True


def check_folder_of_fit(path: Path) -> None:
    """Checks that the folder of a fit is new or empty, or holds an earlier fit.

    Raises:
        ExperimentError: If it holds an experiment, or something else and no fit.
    """
    holds = sorted(file.name for file in path.glob("*") if file.name != LOCK and not file.name.startswith("."))
    is_experiment = SPECIFICATION in holds
    if is_experiment or (holds and not any(name == "fit.json" or name.startswith("candidate ") for name in holds)):
        what = "holds an experiment" if is_experiment else f"holds '{holds[0]}' and no earlier fit"
        raise ExperimentError(f"--out: '{path}' {what}; name a new folder, or that of an earlier fit")


@contextmanager
def _folder_of_fit(path: Path) -> Generator[None]:
    """Makes the folder of a fit, in which no other process fits inside the block.

    Raises:
        ExperimentError: If it cannot be made or written, or another process fits there.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ExperimentError(f"--out: cannot make '{path}' ({reason_of(error)})") from None
    with only_process(path, "a fit there"):
        yield


def _other_versions(there: Specification) -> list[str]:
    """Returns the packages of an experiment that have other versions now, with both."""
    now = experiment_versions()
    return [f"{name} {text} (now {now.get(name, 'none')})" for name, text in there.versions.items() if now.get(name) != text]


def _check_versions(there: Specification, *, any_version: bool) -> None:
    different = _other_versions(there)
    if different and not any_version:
        raise ExperimentError(f"its trials until now were run with {', '.join(different)}; install these versions, or add --any-version")


def _shown(value: object) -> str:
    """Returns a value as text; in quotes if it could not be read otherwise."""
    text = str(value)
    plain = text.isprintable() and text.strip() == text != "" and "," not in text
    return text if plain or not isinstance(value, str) else repr(value)


def _trials(count: int) -> str:
    return "1 trial" if count == 1 else f"{count:,} trials"


def _show_failures(store: Store, out: Output) -> None:
    if not store.failures:
        return
    kinds = Counter(summary(row["error"]) for row in store.rows() if row["error"] is not None)
    out.line((f"{_trials(store.failures)} failed", "bold red"), " (columns `end` and `error` of the table):")
    for text, count in kinds.most_common(SHOWN):
        out.line(f"  {count:,}  {text}")


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
def _progress(out: Output, what: str, total: int) -> Generator[Callable[[ExperimentProgress], None]]:
    """Prints a heading, and shows the progress of an experiment inside the block: a bar in a terminal, otherwise lines.

    Args:
        out: Where to print.
        what: The heading; "" for none.
        total: The number of trials.
    """
    if what:
        out.line((what, "bold"))
    if out.json or not out.console.is_terminal:
        yield _lines(out, {"what": what} if what else {})
        return
    rate, failed = (TextColumn(f"{{task.fields[{name}]}}") for name in ("rate", "failed"))
    with Progress(BarColumn(), MofNCompleteColumn(), rate, TimeElapsedColumn(), failed, console=out.console) as bar:
        task = bar.add_task("", total=total, rate="", failed="")
        begin: list[tuple[float, int]] = []

        def show(state: ExperimentProgress) -> None:
            begin.append((time.monotonic(), state.done)) if not begin else None
            failed = f"[red]{state.failures:,} failed[/red]" if state.failures else ""
            bar.update(task, completed=state.done, rate=_rate(begin[0], state), failed=failed)

        yield show


def _lines(out: Output, about: Mapping[str, str]) -> Callable[[ExperimentProgress], None]:
    begin: list[tuple[float, int]] = []
    last = [0.0]

    def show(state: ExperimentProgress) -> None:
        now = time.monotonic()
        out.event("progress", {**about, **asdict(state)})
        if not begin:
            begin.append((now, state.done))
        if now - last[0] >= EVERY or not state.workers:
            last[0] = now
            out.line(f"{state.done:,} of {state.total:,} trials, {state.failures:,} failed, {_rate(begin[0], state)}")

    return show


def _rate(begin: tuple[float, int], state: ExperimentProgress) -> str:
    took, done = time.monotonic() - begin[0], state.done - begin[1]
    workers = {0: "no workers: waiting for one", 1: "1 worker"}.get(state.workers, f"{state.workers} workers")
    if not done or not state.workers:
        return workers
    left = (state.total - state.done) * took / done
    return f"{done / took:,.1f}/s, {workers}, {left:,.0f} s left"
