"""Defines the session: one model, its current run in a worker, and the browsers that watch it and share control."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable, Coroutine
from contextlib import suppress
from pathlib import Path
from typing import Any

import msgspec

from actr3d.errors import Actr3dError, RecordingError
from workbench.client_feed import MAX_NOTICES, Broadcast, Feed, Raw
from workbench.event_log import LatestEvents
from workbench.overlays import ViewSettings
from workbench.pending_requests import PendingRequests
from workbench.recording_index import begun
from workbench.recordings import Recordings
from workbench.run_facts import exact_seed
from workbench.run_request import LaunchedRun, RunOptions, digest_of_file, is_there, start_of
from workbench.worker.messages import (
    ENDED,
    Branched,
    EventsRemoved,
    Facts,
    FromWorker,
    Loaded,
    NewEvents,
    Notice,
    Position,
    Reply,
    SetOverlays,
    Start,
    State,
    Unrecorded,
)
from workbench.worker.workers import Worker, Workers
from workbench.worker_monitor import LAST_WORDS, Receiver, WorkerMonitor

Watcher = Callable[[Facts | State | ViewSettings | None], None]


class Session(Broadcast, Receiver):
    """Runs one model, as often as users ask, and reports to all who watch it.

    Args:
        name: The name of the session.
        path: The model file.
        workers: The pool that starts workers.
        recordings: The folder of the recordings.
        shown_path: The model's path as pages show it.
        lists_changed: Called whenever lists of recordings must be read again because of a run of this session.
    """

    def __init__(
        self,
        name: str,
        path: Path,
        workers: Workers,
        recordings: Recordings,
        shown_path: str,
        lists_changed: Callable[[], None],
    ) -> None:
        super().__init__(name)
        self.path = path
        self.model = shown_path
        self.watchers: list[Watcher] = []
        """Called with the facts of each new run, each state, each change of the view settings, and None at the end."""
        self.look = ViewSettings()
        self.state: State | None = None
        self.facts: Facts | None = None
        self.breakpoints: tuple[str, ...] = ()
        self.born = time.time()
        """When the session began [s since 1970]: distinguishes it from a session of the same name of an earlier server."""
        self.branched: Branched | None = None
        """What was kept when a user last changed something in the past of the current run."""
        self.recording_changes: int = 0
        """Counts how often a recording began, ended, or was labelled or deleted: then pages list recordings again."""
        self._shown: LaunchedRun | None = None
        """The run on screen, even after its worker has ended."""
        self._loading: LaunchedRun | None = None
        """The run that is being built."""
        self._launching = False
        """Whether a worker is being started."""
        self._attempt = 0
        """The number of the latest attempt to start a run."""
        self._notice_number = 0
        self._cuts: deque[tuple[int, int]] = deque(maxlen=MAX_NOTICES)
        """Where the run was cut and continued differently: (number of the next notice, number of events kept).

        Earlier notices about later events belong to a past that no longer exists.
        """
        self._given: dict[Notice, None] = {}
        """The latest notices of the run on screen, in order. A run that repeats a part of its past repeats its notices."""
        self._controlled_by = ""
        self._ending = ""
        self._after_end = "the worker has ended"
        """What pages say once the worker has ended normally."""
        self.speed: float | None = None
        self.real_time = False
        """Whether runs with a body go in real time; until a user chooses a speed."""
        self.speed_chosen = False
        """Whether a user has chosen the speed."""
        self._workers = workers
        self._recordings = recordings
        self._lists_changed = lists_changed
        self._listed: tuple[Any, ...] = ()
        """What lists show of the run on screen."""
        self._beginning = asyncio.Lock()
        """Held while a new run is being given a worker."""
        self._not_kept: str | None = None
        """Why runs, or the rest of the run, are not recorded although they should be."""
        self._closed = False
        self._given_up = 0
        """Attempts up to this number are cancelled if they have no worker yet."""
        self._tasks: set[asyncio.Task[Any]] = set()
        self._waiting = PendingRequests()
        self._drawn: tuple[str, ...] = ()
        self._asked: set[Worker] = set()
        """The workers that were asked to end."""

    # -- its runs

    @property
    def _worker(self) -> Worker | None:
        """The worker of the run on screen; None once it has ended."""
        return None if self._shown is None or self._shown.over.is_set() else self._shown.worker

    @property
    def _newest(self) -> LaunchedRun | None:
        return self._loading or self._shown

    @property
    def _going(self) -> list[LaunchedRun]:
        """The runs whose workers have not ended: that on screen, and that being built."""
        return [one for one in (self._shown, self._loading) if one is not None and not one.over.is_set()]

    async def begin(self, options: RunOptions | None = None) -> None:
        """Starts a new run in a new worker; the old run stays on screen until the new one is built, so that an error does not remove it.

        Args:
            options: The options of the run; None for the defaults of the model.

        Raises:
            ModelFileError: If the file cannot be read.
            OSError: If no worker can be started.
            Actr3dError: If the session is closed.
        """
        async with self._beginning:
            if self._closed:
                raise Actr3dError("this session is closed, and begins no more runs: open the model again")
            options = options or RunOptions()
            before = self._not_kept
            record = self._new_recording() if options.record else None
            more: dict[str, Any] = {"record": record, "factor": self.speed, "real_time": self.real_time, "breakpoints": self.breakpoints}
            start = start_of(self.path, options, attempt=self._attempt + 1, **more)
            self._attempt = start.attempt
            if self._not_kept is not None and before is None:
                self.add_notice(Notice(level="error", text=self._not_kept), start)
            # Without a process ready to fork, this takes until everything that models need is loaded.
            self._launching = True
            self.changed(facts=True)
            try:
                launched = LaunchedRun(start, await self._workers.launch())
            finally:
                self._launching = False
                self.changed(facts=True)
            self.run_task(WorkerMonitor(launched.worker, start, self).serve())
            if start.attempt <= self._given_up:  # stopped in the meantime
                self._asked.add(launched.worker)
                launched.worker.kill()
                return
            if self._loading is not None:
                record = self._loading.start.record
                self._leave(self._loading.worker, None if record is None else Path(record))
            self._await(launched)

    def _new_recording(self) -> str | None:
        """Returns the path of a new recording; None if there can be none."""
        self._not_kept = None
        try:
            return str(self._recordings.new(self.path.stem))
        except RecordingError as error:
            advice = "To keep runs, copy the models to a folder that can be written, and start the workbench with it"
            self._not_kept = f"Runs are not kept: {error}. {advice}."
            return None

    def adopt(self, worker: Worker) -> None:
        """Shows a run that has been built elsewhere: in the process of a notebook."""
        self._attempt += 1
        self._after_end = "the notebook no longer has this simulation"
        self.real_time = True
        launched = LaunchedRun(Start(path=str(self.path), folder=str(self.path.parent), attempt=self._attempt, real_time=True), worker)
        self.run_task(WorkerMonitor(worker, launched.start, self).serve())
        self._await(launched)

    def _await(self, launched: LaunchedRun) -> None:
        """Awaits the facts of a run, to show it then."""
        self._loading = launched
        self._ending = ""
        self.changed(facts=True)

    def take(self, worker: Worker, start: Start, message: FromWorker) -> None:
        launched = self._run_of(worker)
        if launched is not None and launched.stuck is not None and isinstance(message, (Reply, State)):
            launched.stuck = None
            self.changed(facts=True)
        if isinstance(message, Reply):
            self._waiting.take(message)
        if launched is None or isinstance(message, Reply):
            return
        if isinstance(message, Facts) and launched is self._loading:
            self._swap(launched, message)
        shown = launched is self._shown
        match message:
            case Facts() if shown and message is not self.facts:
                self.facts = message
                self._notify_watchers(message)
                self.changed(facts=True)
            case State() if shown:
                self._take_state(message)
            case NewEvents() if shown:
                self.log.add(message.first, message.events)
            case EventsRemoved() if shown:
                self.epoch += 1
                self.log.cut(message.events)
                self._cuts.append((self._notice_number, message.events))
                self._given = {notice: None for notice in self._given if (notice.events or 0) <= message.events}
                self.changed(facts=True)
                for feed in self.feeds:
                    feed.cut(message.events)
            case Branched() if shown:
                self.branched = message
                self.changed(facts=True)
            case Unrecorded():
                self._not_kept = f"What follows is not recorded: {launched.unwritten}"
                launched.start = msgspec.structs.replace(launched.start, record=None)
                self._lists_changed()
                self.changed(facts=True)
            case Loaded():
                launched.add_helper(message)
                self.changed(facts=shown)
            case Notice() if not shown or not self._was_given(message):
                launched.unwritten = message.text if message.unwritten else launched.unwritten
                self.add_notice(message, start)
            case Position() if self.busy(worker):  # it may have ended meanwhile
                launched.stuck = {"file": self._shown_file(message.file, start), "line": message.line, "function": message.function}
                self.changed(facts=True)
            case _:
                pass
        self.changed()

    def _was_given(self, notice: Notice) -> bool:
        """Returns whether the run on screen repeats a notice in a part of its past; otherwise stores the notice."""
        before = notice.events is not None and (notice.events < self.log.next or notice.level == "error")  # a run fails only once
        if before and notice in self._given:
            return True
        self._given[notice] = None
        if len(self._given) > MAX_NOTICES:
            del self._given[next(iter(self._given))]
        return False

    def _take_state(self, state: State) -> None:
        self.state = state
        self.state_version += 1
        self._notify_watchers(state)

    def _run_of(self, worker: Worker) -> LaunchedRun | None:
        """Returns the run of a worker; None if a newer run has replaced it."""
        return next((one for one in (self._shown, self._loading) if one is not None and one.worker is worker), None)

    def _swap(self, launched: LaunchedRun, facts: Facts) -> None:
        """Shows a newly built run in place of the previous one."""
        worker, useless = self._worker, self._useless_recording
        self._shown, self._loading = launched, None
        if worker is not None:
            self._leave(worker, useless)
        elif useless is not None:
            self._recordings.discard(useless)
        self.run += 1
        self.epoch += 1
        self.log = LatestEvents()
        self.facts, self.state, self.branched, launched.stuck = facts, None, None, None
        self._cuts.clear()
        self._given.clear()
        if self._drawn:
            launched.worker.send(SetOverlays(kinds=self._drawn))
        self._notify_watchers(facts)
        self.changed(facts=True)

    def take_end(self, worker: Worker, ending: str) -> None:
        self._waiting.end(worker)
        asked = worker in self._asked
        self._asked.discard(worker)
        launched = self._run_of(worker)
        if launched is None or launched.over.is_set():
            return
        self._ending = "stopped" if asked else ending or launched.unwritten
        stuck, launched.stuck = launched.stuck, None
        where = f" at {stuck['file']}:{stuck['line']}" if stuck and stuck["file"] else ""
        if ending and not asked:
            self.add_notice(Notice(level="error", text=f"{self._ending}{where}"))
        elif asked and where:
            self.add_notice(Notice(level="warning", text=f"stopped while it was busy{where}"))
        launched.over.set()
        if launched is self._loading:
            self._loading = None
        else:
            if self.state is None:
                self.state_version += 1  # pages still show the state of the previous run, which is gone
            if self.state is not None and self.state.status not in ENDED:
                status_now = "failed" if self._ending != "stopped" else "ended"
                reason = self._ending or self._after_end
                ended = {"status": status_now, "reason": reason, "breakpoint": None, "measured": None, "target": None}
                self.state = msgspec.structs.replace(self.state, **ended)
                self.state_version += 1
        self.changed(facts=True)

    def changed(self, *, facts: bool = False) -> None:
        super().changed(facts=facts)
        listed = (self.run, self.alive, self.state is not None and self.state.status in ENDED, self.branched)
        if listed != self._listed:
            self._listed = listed
            self._lists_changed()

    @property
    def is_loading(self) -> bool:
        """Whether a run is being built, or its worker is being started."""
        return self._launching or self._loading is not None

    @property
    def is_over(self) -> bool:
        """Whether no run accepts commands and none is being built."""
        return not self.alive and not self.is_loading

    def halt(self, worker: Worker, name: str) -> None:
        launched = self._run_of(worker)
        if launched is None:
            return
        launched.stuck = {"file": None, "line": None, "function": "", "signal": name} if name else None
        if name:
            text = f"the model's process was stopped by {name}: SIGCONT to process {worker.pid} continues it, Stop ends it"
            self.add_notice(Notice(level="warning", text=text))
        self.changed(facts=True)

    def busy(self, worker: Worker) -> bool:
        loading = self._loading is not None and worker is self._loading.worker
        return loading or (worker is self._worker and (self.going_on or self._waiting.on(worker)))

    @property
    def going_on(self) -> bool:
        """Whether the current run is going on."""
        return self.state is not None and self.state.status == "running"

    def _leave(self, worker: Worker, useless: Path | None) -> None:
        """Ends a worker in the background; then deletes its recording if that is useless."""
        self._asked.add(worker)

        async def end() -> None:
            await worker.stop()
            if useless is not None:
                self._recordings.discard(useless)
            self._lists_changed()

        self.run_task(end())

    async def cancel_seek(self, command: object) -> bool:
        """Sends a command to a run whose seek is in progress; returns whether one was, and the run has answered soon."""
        if self.is_loading or self.state is None or self.state.target is None:
            return False
        with suppress(TimeoutError):
            async with asyncio.timeout(LAST_WORDS):
                return (await self.ask(command, of_shown_run=True)).error is None
        return False

    async def stop(self) -> None:
        """Ends the workers, whatever they are doing, and reads their last messages; after at most two seconds they are gone."""
        self._given_up = self._attempt  # including an attempt that has no worker yet
        ending = self._going
        self._asked.update(one.worker for one in ending)
        await asyncio.gather(*(one.worker.stop() for one in ending))
        with suppress(TimeoutError):
            async with asyncio.timeout(LAST_WORDS):
                for one in ending:
                    await one.over.wait()

    async def close(self) -> None:
        """Stops the workers, informs the watchers, and cancels all tasks; no run can be begun from now on."""
        self._closed = True
        useless = self._useless_recording
        await self.stop()
        if useless is not None:
            self._recordings.discard(useless)
        self._notify_watchers(None)
        tasks = list(self._tasks)
        if tasks:
            await asyncio.wait(tasks, timeout=1)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    # -- commands and questions

    def take_control(self, who: str) -> None:
        """Shows others that a user controls the session, as the sender of the latest command."""
        if who and who != self._controlled_by:
            self._controlled_by = who
            self.changed(facts=True)

    async def restart(
        self, settings: dict[str, Any] | None, seed: int | str | None, *, new_seed: bool = False, record: bool = True, run: bool = False
    ) -> None:
        """Starts a new run.

        Args:
            settings: Values of parameters that differ from the model's defaults; None for those of the newest run.
            seed: The seed; None for that of the newest run, or with `new_seed` for a random one.
            new_seed: Whether the seed differs from that of the newest run.
            record: Whether the run is recorded.
            run: Whether it starts going at once.
        """
        newest = self._newest
        if newest is not None:
            settings = newest.start.settings if settings is None else settings
            seed = newest.start.seed if seed is None and not new_seed else seed
        await self.begin(RunOptions(settings=settings or {}, seed=seed, record=record, run=run))

    def set_speed(self, factor: float | None) -> None:
        """Stores the speed for this and later runs, as a multiple of real time; None for as fast as possible."""
        self.speed, self.real_time, self.speed_chosen = factor, False, True
        self.changed(facts=True)

    def set_breakpoints(self, productions: tuple[str, ...]) -> None:
        """Stores the breakpoints for this and later runs."""
        self.breakpoints = productions
        self.changed(facts=True)

    def take_choices(self, other: Session) -> None:
        """Applies what users have chosen in another session: overlays and speed, and the breakpoints if it has the same model file."""
        self.look = other.look
        self._notify_watchers(self.look)
        if other.speed_chosen:
            self.set_speed(other.speed)
        if other.path == self.path:
            self.set_breakpoints(other.breakpoints)

    def show_overlay(self, name: str, shown: bool) -> None:
        """Shows or hides an overlay of the 3D view."""
        self.look = self.look.with_overlay(name, shown)
        self._notify_watchers(self.look)
        self.changed(facts=True)

    async def ask(self, command: object, *, of_shown_run: bool = False) -> Reply:
        """Sends a page command to a worker: that of the run on screen if the command is for that run, otherwise that of the newest run.

        After a user has started a new run, commands go to it, although the previous run is on screen until the new one is built. Before
        the first run is on screen, all commands go to it.
        """
        if not of_shown_run or self._shown is None:
            async with self._beginning:
                loading = self._loading
            if loading is not None:
                return await self._waiting.ask(loading.worker, command)
        return await self._waiting.ask(self._worker, command)

    async def apply_setting(self, command: object) -> Reply:
        """Sends the newest run a command that sets what the session also stores for later runs; does nothing if there is no run."""
        return Reply(id=0) if self.is_over else await self.ask(command)

    async def ask_all(self, command: object) -> Reply:
        """Sends a command to the worker of the run on screen, and to that of the run being built."""
        async with self._beginning:
            loading = self._loading
        if loading is None or self._worker is None:
            return await self.ask(command)
        self._waiting.send(loading.worker, command)
        return await self._waiting.ask(self._worker, command)

    def draw(self, kinds: tuple[str, ...]) -> None:
        """Sets for which kinds of overlays the states of this run and later runs contain data."""
        if kinds != self._drawn:
            self._drawn = kinds
            if self._worker is not None:
                self._worker.send(SetOverlays(kinds=kinds))

    def run_task(self, work: Coroutine[Any, Any, Any]) -> None:
        """Runs a coroutine in the background; it is cancelled when the session is closed."""
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    @property
    def start(self) -> Start | None:
        """What the current run was started with."""
        return None if self._shown is None else self._shown.start

    @property
    def recorded(self) -> Path | None:
        """The recording that identifies a run that was opened from one (the run on screen, or being built); None for a new run.

        It is the opened recording, until a user changes the run; from then on, it is the recording that the run itself writes.
        """
        start = self._shown.start if self._shown is not None else None if self._loading is None else self._loading.start
        if start is None or start.recorded is None:
            return None
        return Path(start.recorded if self.branched is None or start.record is None else start.record)

    @property
    def spare_recording(self) -> Path | None:
        """The recording of a run that only repeats an opened recording: it is not needed unless a user changes the run."""
        start = self.start
        if start is None or start.recorded is None or start.record is None or self.branched is not None:
            return None
        return Path(start.record)

    @property
    def _useless_recording(self) -> Path | None:
        """The recording of the run on screen if nobody needs it: the run never began, or only repeats an opened recording."""
        start = self.start
        if start is None or start.record is None:
            return None
        waits = self.state is None and not start.run  # it may not have sent its first state yet
        return Path(start.record) if waits or never_begun(self.state, self.log) else self.spare_recording

    @property
    def is_outdated(self) -> bool:
        """Whether the run on screen still waits at its start although its file has changed: it can be replaced without loss."""
        if self._shown is None or self.is_loading or not never_begun(self.state, self.log) or not is_there(self.path):
            return False
        return self._shown.is_stale(digest_of_file(self.path))

    @property
    def writing(self) -> list[Path]:
        """The recordings that runs are still writing: that on screen, and that being built, which is a program's from its first line."""
        return [Path(one.start.record) for one in self._going if one.start.record is not None and not one.unwritten]

    @property
    def alive(self) -> bool:
        """Whether the current run still accepts commands."""
        return self._shown is not None and not self._shown.over.is_set()

    def _shown_file(self, file: str | None, start: Start | None = None) -> str | None:
        """Returns the path of a file in the models folder as pages show it; for the model itself, its current name."""
        if file is None or file == str(self.path) or (start is not None and file == start.path):
            return file and self.model
        root = self.path.parents[self.model.count("/")]
        inside = self.path == root / self.model and Path(file).is_relative_to(root)
        return Path(file).relative_to(root).as_posix() if inside else file

    # -- what pages see of it

    def facts_json(self) -> bytes:
        facts, start, digest = self.facts, self.start, digest_of_file(self.path)
        facts_of_session: dict[str, Any] = {
            **self.summary(),
            "stuck": None if self._newest is None else self._newest.stuck,
            "branched": self._branched_json(),
            "recording_changes": self.recording_changes,
            **self.look.as_dict(),
            "breakpoints": self.breakpoints,
            "speed": self.speed,
            "real_time": self.real_time,
            "settings": start.settings if start is not None else {},
            "seed": None if facts is None else exact_seed(facts.seed),
            "stale": self._shown is not None and self._shown.is_stale(digest),
            "gone": not is_there(self.path),
            "digest": digest,
            "attempt": self._attempt,
            "shown_attempt": start.attempt if start is not None else None,
            "version": start.version if start is not None else None,
            "cuts": list(self._cuts),
            "born": self.born,
            "made": None if self.recorded is None or not is_there(self.recorded) else begun(self.recorded),
            "recording": self.recording,
            "not_kept": self._not_kept,
        }
        if facts is not None:
            facts_of_session |= {"kind": facts.kind, "period": facts.period, "parameters": Raw(facts.parameters)}
            facts_of_session |= {"world": Raw(facts.world), "initial_widths": Raw(facts.initial_widths)}
            facts_of_session |= {"changes": Raw(facts.changes), "live": Raw(facts.live)}
        return msgspec.json.encode(facts_of_session)

    def _branched_json(self) -> dict[str, Any] | None:
        """Returns what was kept when a user last changed the past; None if nothing was kept.

        `opened` says whether it is the recording that was opened, `kept` whether it is still there.
        """
        branched, start = self.branched, self.start
        written = None if start is None else start.record or start.recorded
        if branched is None or written is None:
            return None
        path = Path(written).with_name(f"{branched.recording}.sqlite")
        opened = start is not None and start.recorded is not None and Path(start.recorded) == path
        there = {"opened": opened, "made": begun(path), "kept": is_there(path)}
        return {"recording": branched.recording, "at": branched.at, "until": branched.until, **there}

    @property
    def recording(self) -> str | None:
        """The name of the recording of the run on screen, as lists show it; None if it is not recorded or not listed."""
        start = self.start
        return None if start is None or start.record is None or self.spare_recording is not None else Path(start.record).stem

    def summary(self) -> dict[str, Any]:
        """Returns the entry of this session in the list of sessions."""
        return {
            "recorded": None if self.recorded is None else self.recorded.stem,
            "recording": self.recording,
            "id": self.name,
            "model": self.model,
            "run": self.run,
            "alive": self.alive,
            "outdated": self.is_outdated,
            "loading": self.is_loading,
            "ending": self._ending,
            "status": None if self.state is None else self.state.status,
            "watching": list(dict.fromkeys(feed.name for feed in self.feeds)),
            "controlled_by": self._controlled_by,
        }

    def state_json(self) -> bytes:
        state = self.state
        if state is None:
            return b"null"
        values = {
            name: getattr(state, name)
            for name in ("status", "reason", "breakpoint", "tick", "time", "furthest", "target", "wanted", "measured", "events")
        }
        return msgspec.json.encode(
            {
                **values,
                "apertures": state.apertures,
                "parameters": Raw(state.parameters),
                "result": Raw(state.result),
                "parts": Raw(state.parts),
            }
        )

    @property
    def source(self) -> str | None:
        """The model text of the run on screen, or else of the one being built; None if there is neither."""
        launched = self._shown or self._loading
        return None if launched is None else launched.start.source

    # -- who watches

    def join(self, name: str) -> Feed:
        """Adds a browser that watches."""
        feed = Feed(self, name)
        self.feeds.append(feed)
        self.changed(facts=True)
        return feed

    def leave(self, feed: Feed) -> None:
        """Removes a browser that has left."""
        self.feeds.remove(feed)
        if feed.name == self._controlled_by and all(other.name != feed.name for other in self.feeds):
            self._controlled_by = ""
        self.changed(facts=True)

    def add_notice(self, notice: Notice, start: Start | None = None, *, of_run: bool = True) -> None:
        """Sends a notice to all who watch, with the number of its attempt and the version of the model's text at that time; one that is not
        of a run has neither, and is no part of its console."""
        shown: dict[str, Any] = {"number": self._notice_number, "level": notice.level, "text": notice.text, "detail": notice.detail}
        shown |= {"file": self._shown_file(notice.file, start), "line": notice.line}
        is_shown = self._shown is not None and (self._attempt if start is None else start.attempt) == self._shown.start.attempt
        now = self.log.next if self.state is None else self.state.events
        shown["events"] = notice.events if notice.events is not None else now if is_shown else 0
        if of_run:
            shown |= {"attempt": self._attempt if start is None else start.attempt, "version": start and start.version}
        self.notices.append((self._notice_number, msgspec.json.encode(shown)))
        self._notice_number += 1
        self.changed()

    def file_changed(self, path: Path) -> None:
        """Informs pages that a file may have changed: a run that was made from it is stale."""
        if path == self.path or (self._shown is not None and self._shown.has_helper(path)):
            self.changed(facts=True)

    def renamed(self, path: Path, model: str) -> None:
        """Records the new name of the model's file."""
        self.path, self.model = path, model
        self.changed(facts=True)

    def _notify_watchers(self, what: Facts | State | ViewSettings | None) -> None:
        for watcher in self.watchers:
            watcher(what)


def never_begun(state: State | None, log: LatestEvents) -> bool:
    """Returns whether a run has never left its start, printed nothing and received no command: its recording is useless. False if it has
    not sent a state yet."""
    if state is None or state.furthest > 0 or state.status != "paused":
        return False
    _, events = log.since(0)
    return not any(msgspec.json.decode(event)[2] in ("output", "command") for event in events)
