"""Manages the experiments of a models folder: each is a folder, run by the command `actr3d experiment` in a process of its own."""

from __future__ import annotations

import asyncio
import json
import re
import time
from collections import OrderedDict, defaultdict, deque
from collections.abc import Generator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from actr3d.errors import Actr3dError
from workbench.design_files import CheckRequest, StartRequest, design_argument, stamp_of
from workbench.experiment_command import (
    AnyExperimentEvent,
    ExperimentCommand,
    ExperimentEvent,
    ExperimentFacts,
    ExperimentProgress,
    ExperimentRunError,
    TriedFacts,
)
from workbench.experiment_folder import ExperimentFolder, as_values
from workbench.file_names import NAME, STAMP, unique_suffix
from workbench.run_facts import exact_seed
from workbench.sessions import PermissionNeededError, Sessions
from workbench.trash import OWN, move_to_trash

E = TypeVar("E", bound=ExperimentEvent)
MAX_RUNNING = 2
"""Maximum number of experiments that run at once; each takes all processors."""
MAX_COMMANDS = 2
"""Maximum number of designs checked, and of trials recorded and reports made, at once; others wait."""
MAX_LISTED = 300
"""Maximum number of experiments in a list."""
START_TIME = 180.0
"""How long a design may take to load [s]."""
WORK_TIME = 1_800.0
"""How long a trial that is tried or recorded, or a report, may take [s]."""
END_TIME = 12.0
"""How long an experiment may take to end normally when the server ends [s]."""
STOP_TIME = 120.0
"""How long it may take when a user stops it [s]: at the end, its table is exported."""
WINDOW = 30.0
"""The time over which the rate is measured [s]."""
KEPT = 100
"""How many results of checks are kept."""
_STAMP = re.compile(f"{STAMP}$")


class NoSuchExperimentError(ExperimentRunError):
    """There is no experiment of that name."""

    status = 404

    def __init__(self) -> None:
        super().__init__("there is no such experiment")


class RefusedDesignError(ExperimentRunError):
    """A design cannot be run, or not with these values."""

    status = 422


class RunningExperiment:
    """An experiment that runs.

    Args:
        command: The command that runs it.
        facts: Its facts; None if they are not known yet.
        done: The number of trials that have finished before.
    """

    def __init__(self, command: ExperimentCommand, facts: ExperimentFacts | None, done: int) -> None:
        self.command = command
        self.facts = facts
        self.progress = ExperimentProgress(done=done, total=0, failures=0)
        self.ended = False
        """Whether the command has reported its end."""
        self.task: asyncio.Task[None]
        """Follows the command until it has ended."""
        self._begun: int | None = None
        """The number of trials that had finished before; None before the command has reported it."""
        self._seen: deque[tuple[float, int]] = deque()

    def take(self, event: AnyExperimentEvent) -> None:
        """Stores what the command reports."""
        if isinstance(event, ExperimentFacts):
            self.facts = event
        elif isinstance(event, ExperimentProgress):
            self.progress = event
            if self._begun is None:
                self._begun = event.done
            if event.done - self._begun < max(1, event.workers):
                return  # the first trial of each process takes longer: it loads the model
            now = time.monotonic()
            self._seen.append((now, event.done))
            while len(self._seen) > 2 and self._seen[1][0] < now - WINDOW:
                self._seen.popleft()
        else:
            self.ended = True

    def summary(self) -> dict[str, Any]:
        """Returns the state: trials, rate [1/s] and remaining time [s], None before each process has loaded the model."""
        rate = remaining = None
        progress = self.progress
        if len(self._seen) > 1:
            (since, before), (_, now) = self._seen[0], self._seen[-1]
            if now > before:
                rate = (now - before) / max(0.1, time.monotonic() - since)
                remaining = (progress.total - now) / rate
        state = "stopping" if self.command.interrupted else "running"
        trials = {"done": progress.done, "failures": progress.failures, "workers": progress.workers}
        return {"state": state, **trials, "rate": rate, "remaining": remaining}


class Experiments:
    """Starts, continues, stops and lists experiments.

    Args:
        sessions: The sessions of the server: their folders of models and recordings, and their readers.
    """

    def __init__(self, sessions: Sessions) -> None:
        self._readers = sessions.readers
        self._models = sessions.folder
        self._recordings = sessions.recordings
        self._root = sessions.folder.root / OWN / "experiments"
        self._running: dict[str, RunningExperiment] = {}
        self._starting: set[str] = set()
        """The experiments whose commands are being started."""
        self._deleting: set[str] = set()
        """The experiments that are being moved to the trash folder: they do not exist any more."""
        self._work: defaultdict[str, list[str]] = defaultdict(list)
        """What is being made of each experiment: sentences such as "its report is being made"."""
        self._closed = False
        self._problems: dict[str, str] = {}
        """Why experiments ended early; their notes say it too, if these can be written."""
        self._counts: dict[str, tuple[Any, dict[str, Any]]] = {}
        """The numbers of finished and failed trials by name, and the stamps of the tables in which they were counted."""
        self._checked: OrderedDict[str, ExperimentFacts] = OrderedDict()
        self._recorded: dict[tuple[str, int], str] = {}
        self._turns = asyncio.Semaphore(MAX_COMMANDS)

    # -- listing

    def folder(self, name: str) -> ExperimentFolder:
        """Returns the folder of an experiment.

        Raises:
            NoSuchExperimentError: If there is no experiment of that name.
        """
        folder = ExperimentFolder(self._root / name)
        if NAME.fullmatch(name) is None or name in self._deleting or not folder.is_experiment:
            raise NoSuchExperimentError
        return folder

    async def listing(self) -> tuple[int, list[dict[str, Any]]]:
        """Returns the number of all experiments, and the summaries of the newest `MAX_LISTED`, newest first.

        Raises:
            OSError: If no worker can be started.
        """
        folders = await asyncio.to_thread(self._folders)
        return len(folders), await self._summaries(folders[:MAX_LISTED])

    async def one(self, name: str) -> dict[str, Any]:
        """Returns the summary of an experiment, with its facts.

        Raises:
            NoSuchExperimentError: If there is no experiment of that name.
            OSError: If no worker can be started.
        """
        folder = self.folder(name)
        (summary,) = await self._summaries([folder])
        return {**summary, "facts": as_values(await asyncio.to_thread(self._facts, folder))}

    def _folders(self) -> list[ExperimentFolder]:
        there = self._root.iterdir() if self._root.is_dir() else ()
        found = [folder for path in there if NAME.fullmatch(path.name) and (folder := ExperimentFolder(path)).is_experiment]
        return sorted(found, key=lambda folder: (folder.made, folder.path.name), reverse=True)

    async def _summaries(self, folders: Sequence[ExperimentFolder]) -> list[dict[str, Any]]:
        running = self._running.copy()  # one that ends in the meantime is still shown as it was
        # Of one that runs, the command reports the numbers, but not the columns.
        counted = (folder.path.name for folder in folders if self._counts.get(folder.path.name, (None, _NOTHING))[1]["columns"])
        await self._count([folder for folder in folders if folder.path.name not in {*running} & {*counted}])
        # In a thread, because it reads several files of each.
        return await asyncio.to_thread(lambda: [self._summary(folder, running.get(folder.path.name)) for folder in folders])

    def _summary(self, folder: ExperimentFolder, run: RunningExperiment | None) -> dict[str, Any]:
        name, notes, facts = folder.path.name, folder.notes, self._facts(folder)
        total = None if facts is None else facts.trials
        found: dict[str, Any] = {
            "id": name,
            "name": _STAMP.sub("", name) if facts is None else facts.name,
            "model": "" if facts is None else facts.model,
            "made": folder.made,
            "total": total,
            "changed": {} if facts is None else facts.changed,
            "report": folder.report_made,
            "processes": notes.workers,
            "work": [*self._work.get(name, ())],
            "problem": None,
        }
        _, counted = self._counts.get(name, (None, _NOTHING))
        if run is not None:
            return {**found, "columns": counted["columns"], **run.summary()}
        problem = counted["problem"] or self._problems.get(name) or notes.problem
        complete = total is not None and counted["done"] >= total
        state = "finished" if complete else "elsewhere" if folder.is_locked else "failed" if problem else "stopped"
        return {**found, **counted, "state": state, "problem": problem, "workers": 0, "rate": None, "remaining": None}

    async def _count(self, folders: Sequence[ExperimentFolder]) -> None:
        """Counts the trials of those experiments whose tables have changed."""
        stamps = await asyncio.to_thread(lambda: [(folder.path.name, folder.table_stamp, folder.table) for folder in folders])
        fresh: list[tuple[str, Any, Path]] = []
        for name, now, table in stamps:
            if table is None:
                self._counts[name] = None, _NOTHING
            elif self._counts.get(name, (None,))[0] != now:
                fresh.append((name, now, table))
        counted = await self._counted([table for _, _, table in fresh])
        for (name, now, _), found in zip(fresh, counted, strict=True):
            self._counts[name] = now, found

    async def _counted(self, tables: Sequence[Path]) -> list[dict[str, Any]]:
        """Returns the numbers of trials in tables, which a worker reads; if one table ends the worker, the others are still counted."""
        if not tables:
            return []
        try:
            with await self._readers.make("trial counts", *tables) as made:
                return json.loads(made.read())
        except Actr3dError as error:
            if len(tables) == 1:
                return [{**_NOTHING, "problem": f"its table cannot be read: {error}"}]
            return [found for table in tables for found in await self._counted([table])]

    def _facts(self, folder: ExperimentFolder) -> ExperimentFacts | None:
        run = self._running.get(folder.path.name)
        return self._shown(folder.facts if run is None or run.facts is None else run.facts)

    def _shown(self, facts: ExperimentFacts | None) -> ExperimentFacts | None:
        """Returns facts with the model file and the seed as pages show them."""
        if facts is None:
            return None
        changed = facts.changed | ({"seed": exact_seed(facts.changed["seed"])} if "seed" in facts.changed else {})
        return msgspec.structs.replace(facts, model=self._models.shown(facts.model), seed=exact_seed(facts.seed), changed=changed)

    # -- checking

    async def check(self, wanted: CheckRequest) -> dict[str, Any]:
        """Checks a design, and returns its facts.

        Raises:
            Actr3dError: If there is no such design.
            RefusedDesignError: If the design is not valid.
            OSError: If no process can be started.
        """
        argument = design_argument(self._models, wanted.design)
        arguments = ["experiment", argument, "--check", "--json", *wanted.options()]
        key = json.dumps([arguments, wanted.trial, await asyncio.to_thread(stamp_of, self._models)])
        if key not in self._checked:
            async with self._turns:
                kind, patience = (TriedFacts, WORK_TIME) if wanted.trial else (ExperimentFacts, START_TIME)
                self._checked[key] = await self._first(arguments, kind, patience)
        self._checked.move_to_end(key)
        while len(self._checked) > KEPT:
            self._checked.popitem(last=False)
        return as_values(self._shown(self._checked[key]))

    async def _first(self, arguments: Sequence[str], kind: type[E], patience: float) -> E:
        """Runs a command until it sends a message of a kind; returns that message.

        Raises:
            RefusedDesignError: If the command ends without it, or takes too long.
        """
        command = await ExperimentCommand.start(arguments, self._made_root())
        try:
            async with asyncio.timeout(patience):
                async for event in command.events():
                    if type(event) is kind:
                        return event
                await command.wait()
            raise RefusedDesignError(command.problem or "the design cannot be loaded")
        except TimeoutError:
            raise RefusedDesignError(f"the design takes longer than {patience:g} s") from None
        finally:
            await command.kill()

    # -- running

    async def start(self, wanted: StartRequest) -> str:
        """Starts a new experiment; returns its name once its design has been checked and its folder made.

        Raises:
            Actr3dError: If there is no such design.
            RefusedDesignError: If the design is not valid.
            ExperimentRunError: If too many experiments run, or the workbench is closing.
            OSError: If no process can be started.
        """
        argument = design_argument(self._models, wanted.design)
        name = f"{re.sub(r'[^A-Za-z0-9_]', '_', argument.rpartition(':')[2])[:60]}{unique_suffix()}"
        arguments = ["experiment", argument, "--json", "--out", str(self._made_root() / name), *wanted.options()]
        await self._begin(name, arguments, wanted.workers, new=True)
        return name

    async def resume(self, name: str, workers: int | None, *, trust: bool) -> None:
        """Continues an experiment.

        Args:
            name: The experiment.
            workers: The number of processes that run trials; None for that of its last run.
            trust: Whether its code may be run although this installation did not make it.

        Raises:
            NoSuchExperimentError: If there is no experiment of that name.
            PermissionNeededError: If its code may not be run.
            ExperimentRunError: If it is already running, cannot be continued, too many experiments run, or the workbench is
                closing.
            OSError: If no process can be started.
        """
        folder = self._trusted(name, trust=trust)
        if self._runs(folder):
            raise ExperimentRunError("this experiment is already running")
        arguments = ["experiment", str(folder.path), "--json", "--resume"]
        await self._begin(name, arguments, folder.notes.workers if workers is None else workers, new=False)

    def _runs(self, folder: ExperimentFolder) -> bool:
        """Returns whether an experiment runs or is about to, here or elsewhere."""
        name = folder.path.name
        return name in self._running or name in self._starting or folder.is_locked

    async def _begin(self, name: str, arguments: Sequence[str], workers: int | None, *, new: bool) -> None:
        """Starts a command that runs an experiment, and waits until it has checked the design.

        Args:
            name: The experiment.
            arguments: Those of the command, without the number of processes.
            workers: The number of processes that run trials; None for one on each processor.
            new: Whether the command makes the experiment; else it continues it.
        """
        if self._closed:
            raise ExperimentRunError("the workbench is closing")
        if len(self._running) + len(self._starting) >= MAX_RUNNING:
            raise ExperimentRunError(f"{MAX_RUNNING} experiments are already running: stop one, or wait for its end")
        folder = ExperimentFolder(self._root / name)
        facts = None if new else folder.facts
        self._starting.add(name)
        try:
            options = [] if workers is None else [f"--workers={workers}"]
            command = await ExperimentCommand.start([*arguments, *options], self._made_root())
        finally:
            self._starting.discard(name)
        if self._closed:
            await command.kill()
            raise ExperimentRunError("the workbench is closing")
        run = self._running[name] = RunningExperiment(command, facts, self._counts.get(name, (None, _NOTHING))[1]["done"])
        began: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        run.task = asyncio.create_task(self._follow(folder, run, began, workers, new=new))
        try:
            await asyncio.wait_for(asyncio.shield(began), START_TIME)
        except TimeoutError:
            run.task.cancel()
            raise RefusedDesignError(f"the design takes longer than {START_TIME:g} s") from None

    async def _follow(
        self, folder: ExperimentFolder, run: RunningExperiment, began: asyncio.Future[None], workers: int | None, *, new: bool
    ) -> None:
        """Reads what a command reports until it has ended."""
        problem = None
        try:
            async for event in run.command.events():
                run.take(event)
                if isinstance(event, ExperimentFacts) and not began.done():
                    self._problems.pop(folder.path.name, None)
                    folder.note(problem=None, workers=workers)
                    if new:
                        folder.seal()
                    began.set_result(None)
            await run.command.wait()
            if not run.ended and not run.command.interrupted:
                problem = run.command.problem or "its process has ended"
        finally:
            await run.command.kill()
            self._running.pop(folder.path.name, None)
            if not began.done():
                began.set_exception(RefusedDesignError(problem or "it was stopped before it began"))
                began.exception()  # nobody may wait for it any more
            elif problem is not None:
                self._problems[folder.path.name] = problem
                folder.note(problem=problem)

    def stop(self, name: str) -> None:
        """Asks an experiment to end; all its finished trials are kept.

        Raises:
            NoSuchExperimentError: If there is no experiment of that name.
            ExperimentRunError: If it is not running.
        """
        self.folder(name)
        run = self._running.get(name)
        if run is None:
            raise ExperimentRunError("this experiment is not running")
        if not run.command.interrupted:
            run.command.interrupt()
            asyncio.get_running_loop().call_later(STOP_TIME, run.task.cancel)

    async def close(self) -> None:
        """Ends all experiments normally; kills those that take too long."""
        self._closed = True
        tasks = [run.task for run in self._running.values()]
        for run in self._running.values():
            run.command.interrupt()
        if tasks:
            _, late = await asyncio.wait(tasks, timeout=END_TIME)
            for task in late:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    # -- one experiment

    async def record(self, name: str, number: int, *, trust: bool) -> str:
        """Runs a trial again and records it; returns the name of the recording.

        Raises:
            NoSuchExperimentError: If there is no experiment of that name.
            PermissionNeededError: If this installation did not make it, and `trust` is false.
            ExperimentRunError: If the trial cannot be recorded.
            OSError: If no process can be started.
        """
        folder = self._trusted(name, trust=trust)
        with self._working(name, f"its trial {number} is being recorded"):
            async with self._turns:
                known = self._recorded.get((name, number))
                if known is not None:
                    with suppress(Actr3dError):
                        return self._recordings.path(known).stem
                to = self._recordings.new(f"{_STAMP.sub('', name)}_trial_{number}")
                problem = await self._run_command(["experiment", str(folder.path), "--trial", str(number), "--record", str(to)])
                if not to.is_file():
                    raise ExperimentRunError(problem or "the trial was not recorded")
                self._recorded[name, number] = to.stem  # also for a trial that fails: the recording shows how far it came
                return to.stem

    async def make_report(self, name: str, *, trust: bool) -> None:
        """Makes the report of an experiment.

        Raises:
            NoSuchExperimentError: If there is no experiment of that name.
            PermissionNeededError: If this installation did not make it, and `trust` is false.
            ExperimentRunError: If it fails.
            OSError: If no process can be started.
        """
        folder = self._trusted(name, trust=trust)
        with self._working(name, "its report is being made"):
            async with self._turns:
                problem = await self._run_command(["report", str(folder.path), "--out", str(folder.report_folder)])
        if problem is not None:
            raise ExperimentRunError(problem)

    @contextmanager
    def _working(self, name: str, what: str) -> Generator[None]:
        """Keeps an experiment from being deleted inside the block; every page shows what is being made.

        Raises:
            ExperimentRunError: If the same is being made already.
        """
        if what in self._work[name]:
            raise ExperimentRunError(f"{what} already: wait for its end")
        self._work[name].append(what)
        try:
            yield
        finally:
            self._work[name].remove(what)

    async def _run_command(self, arguments: Sequence[str]) -> str | None:
        """Runs a command to its end; returns None, or its messages if it fails, with paths inside the models folder."""
        command = await ExperimentCommand.start(arguments, self._made_root())
        try:
            async with asyncio.timeout(WORK_TIME):
                code = await command.wait()
            if code == 0:
                return None
            return (command.problem or f"the command ended with exit code {code}").replace(f"{self._models.root}/", "")
        except TimeoutError:
            raise ExperimentRunError(f"it takes longer than {WORK_TIME:g} s") from None
        finally:
            await command.kill()

    async def delete(self, name: str) -> str:
        """Moves an experiment to the trash folder; returns its new path inside the models folder.

        Raises:
            NoSuchExperimentError: If there is no experiment of that name.
            ExperimentRunError: If it runs, or its report or the recording of a trial is being made.
            OSError: If it cannot be moved.
        """
        folder = self.folder(name)
        if self._runs(folder):
            raise ExperimentRunError("this experiment runs: stop it, then delete it")
        if work := self._work.get(name):
            raise ExperimentRunError(f"{' and '.join(work)}: wait for its end, then delete the experiment")
        reports = [folder.elsewhere] if folder.elsewhere.is_dir() else []
        self._deleting.add(name)
        try:
            return await asyncio.to_thread(move_to_trash, self._models.root, folder.path, *reports)
        finally:
            self._deleting.discard(name)

    def _trusted(self, name: str, *, trust: bool) -> ExperimentFolder:
        """Returns the folder of an experiment whose code may be run.

        Raises:
            PermissionNeededError: If this installation did not make it, and the user does not permit it.
        """
        folder = self.folder(name)
        if not folder.made_here:
            if not trust:
                raise PermissionNeededError("experiment")
            folder.seal()
        return folder

    def _made_root(self) -> Path:
        self._root.mkdir(parents=True, exist_ok=True)
        return self._root


_NOTHING: dict[str, Any] = {"done": 0, "failures": 0, "problem": None, "columns": []}
