"""A session: one model, its present run in a worker, and the browsers that watch it and share control."""

from __future__ import annotations

import asyncio
import hashlib
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec

from actr3d.actr.limits import fresh_seed
from actr3d.actr.reading import read_source
from actr3d.errors import Actr3dError, SimulationError
from workbench import protocol as say
from workbench.attendant import Attendant
from workbench.feed import MOST_NOTICES, EventLog, Feed
from workbench.files import ModelFolder
from workbench.keeping import erase, never_begun
from workbench.look import Look
from workbench.telling import Telling
from workbench.worker.messages import At, Cut, Do, Draw, Facts, FromWorker, News, Notice, Reply, Start, State
from workbench.worker.workers import Worker, Workers

MOST_WAITING = 200
"""So many commands and questions of one session may wait for their answers."""

Watcher = Callable[["Session", Facts | State | Look | None], None]


class Session(Telling):
    """Runs one model, again and again, and tells all who watch.

    Args:
        name: What it is called.
        path: The model file.
        workers: Who gives workers.
        recording: Returns a new file for a recording of a model of that name.
        shown_path: The model as pages call it.
    """

    def __init__(self, name: str, path: Path, workers: Workers, recording: Callable[[str], Path], shown_path: str) -> None:
        self.name = name
        self.path = path
        self.model = shown_path
        self.feeds: list[Feed] = []
        self.watchers: list[Watcher] = []
        """Are told of the facts of each new run, of each state, of another look, and by None of the end."""
        self.look = Look()
        self.run = self.epoch = self.state_version = self.facts_version = 0
        self.log = EventLog()
        self.notices: deque[tuple[int, bytes]] = deque(maxlen=MOST_NOTICES)
        self.state: State | None = None
        self.facts: Facts | None = None
        self.start: Start | None = None
        """What the present run began with."""
        self.speed: float | None = None
        self.breakpoints: tuple[str, ...] = ()
        self.has_scene = False
        """Whether there is a 3D view to look at."""
        self._workers = workers
        self._new_recording = recording
        self._worker: Worker | None = None
        self._tasks: set[asyncio.Task[Any]] = set()
        self._waiting: dict[int, tuple[Worker, asyncio.Future[Reply]]] = {}
        self._number = self._notice_number = self._attempt = 0
        self._drawn: tuple[str, ...] = ()
        self._controlled_by = ""
        self._ending = ""
        self._stuck: dict[str, Any] | None = None
        self._loading: Worker | None = None
        self._asked: set[Worker] = set()
        """The workers that were asked to end."""

    # -- its runs

    async def begin(
        self,
        settings: dict[str, Any] | None = None,
        *,
        seed: int | None = None,
        record: bool = True,
        run: bool = False,
        source: str | None = None,
        commands: list[tuple[int, dict[str, Any]]] | None = None,
        helpers: dict[str, tuple[str, str]] | None = None,
    ) -> None:
        """Begins a new run in a new worker; the old one stays until this one is built, so that an error leaves it on screen.

        Args:
            settings: Values of parameters; None for those of the present run.
            seed: None for a fresh one.
            record: Whether it is recorded.
            run: Whether it goes on at once.
            source: The model's text; None for what is in the file now.
            commands: What users did in an earlier run, to be done again.
            helpers: The helper modules of that run, as `actr3d.actr.helper_texts` keeps them.

        Raises:
            ModelFileError: If the file cannot be read.
            OSError: If no worker can be started.
        """
        text = read_source(self.path) if source is None else source
        before = self.start.settings if self.start is not None else {}
        self._attempt += 1
        start = Start(
            path=str(self.path),
            source=text,
            folder=str(self.path.parent),
            settings=before if settings is None else settings,
            seed=fresh_seed() if seed is None else seed,
            record=str(self._new_recording(self.path.stem)) if record else None,
            commands=commands or [],
            helpers=helpers or {},
            factor=self.speed,
            breakpoints=self.breakpoints,
            run=run,
            attempt=self._attempt,
            version=ModelFolder.version(self.path) if source is None else hashlib.sha256(text.encode()).hexdigest(),
        )
        worker = await self._workers.launch()
        if self._loading is not None:
            self._leave(self._loading)
        self._loading = worker
        self._ending = ""
        self._keep(Attendant(worker, start, self).serve())
        self._changed(facts=True)

    def take(self, worker: Worker, start: Start, message: FromWorker) -> None:
        """Takes what a worker says."""
        if isinstance(message, Reply):
            waiting = self._waiting.pop(message.id, None)
            if waiting is not None and not waiting[1].done():
                waiting[1].set_result(message)
            return
        if isinstance(message, Facts) and worker is self._loading:
            self._swap(worker, start, message)
        if worker not in (self._worker, self._loading):
            return
        match message:
            case State() if worker is self._worker:
                if self._stuck is not None:
                    self._stuck = None
                    self._changed(facts=True)
                self.state = message
                self.state_version += 1
                self._tell_watchers(message)
            case News() if worker is self._worker:
                self.log.add(message.first, message.events)
            case Cut() if worker is self._worker:
                self.epoch += 1
                self.log.cut(message.events)
                for feed in self.feeds:
                    feed.cut(message.events)
            case Notice():
                self.tell(message, start)
            case At():
                self._stuck = {"file": self._shown_file(message.file, start), "line": message.line, "function": message.function}
                self._changed(facts=True)
            case _:
                pass
        self._changed()

    def _swap(self, worker: Worker, start: Start, facts: Facts) -> None:
        """Shows the run of a worker that has been built, in place of the one before."""
        before, self._worker, self._loading = self._worker, worker, None
        useless = self.start.record if self.start is not None and never_begun(self.state, self.log) else None
        if before is not None:
            self._leave(before, useless)
        self.run += 1
        self.epoch += 1
        self.log = EventLog()
        self.start, self.facts, self.state, self._stuck = start, facts, None, None
        if self._drawn:
            worker.send(Draw(kinds=self._drawn))
        self._tell_watchers(facts)
        self._changed(facts=True)

    def take_end(self, worker: Worker, ending: str) -> None:
        """Takes how a worker ended, and tells it; nothing where it was in good order."""
        for number in [number for number, (asked, _) in self._waiting.items() if asked is worker]:
            _, waiting = self._waiting.pop(number)
            if not waiting.done():
                waiting.set_result(Reply(id=number, error="the run has ended"))
        asked = worker in self._asked
        self._asked.discard(worker)
        if worker not in (self._worker, self._loading):
            return
        self._ending = "stopped" if asked else ending
        if ending and not asked:
            where = f" at {self._stuck['file']}:{self._stuck['line']}" if self._stuck and self._stuck["file"] else ""
            self.tell(Notice(level="error", text=f"{self._ending}{where}"))
        if worker is self._loading:
            self._loading = None
        else:
            self._worker = None
            self._stuck = None
            if self.state is not None and self.state.status not in ("ended", "failed"):
                status_now = "failed" if self._ending != "stopped" else "ended"
                reason = self._ending or "the worker has ended"
                self.state = msgspec.structs.replace(self.state, status=status_now, reason=reason, measured=None)
                self.state_version += 1
        self._changed(facts=True)

    def busy(self, worker: Worker) -> bool:
        """Tells whether a worker is to be saying something."""
        return worker is self._loading or (worker is self._worker and (self.going_on or bool(self._waiting)))

    @property
    def going_on(self) -> bool:
        """Whether its run goes on."""
        return self.state is not None and self.state.status == "running"

    def _leave(self, worker: Worker, useless: str | None = None) -> None:
        """Ends a worker, without waiting for it, and then deletes a recording that is of no use."""
        self._asked.add(worker)

        async def end() -> None:
            await worker.stop()
            if useless is not None:
                erase(Path(useless))

        self._keep(end())

    async def stop(self) -> None:
        """Ends the workers, whatever they do; at the latest after two seconds they are gone."""
        workers = [worker for worker in (self._worker, self._loading) if worker is not None]
        self._asked.update(workers)
        await asyncio.gather(*(worker.stop() for worker in workers))

    async def close(self) -> None:
        """Ends everything."""
        await self.stop()
        for watcher in self.watchers:
            watcher(self, None)
        tasks = list(self._tasks)
        if tasks:
            await asyncio.wait(tasks, timeout=1)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    # -- what is said to it

    async def carry_out(self, said: Any, who: str = "") -> Reply:
        """Does what somebody wants, or answers what is asked; what comes of it is told, errors too.

        Args:
            said: One of `protocol.Anything`.
            who: Who says it, as others are told.
        """
        if not isinstance(said, (*say.QUESTIONS, *say.LOOKS)) and who and who != self._controlled_by:
            self._controlled_by = who
            self._changed(facts=True)
        try:
            match said:
                case say.Stop():
                    await self.stop()
                case say.Restart():
                    seed = said.seed if said.seed is not None or said.new_seed or self.start is None else self.start.seed
                    await self.begin(said.settings, seed=seed, record=said.record, run=said.run)
                case say.Overlay() | say.Camera():
                    self.look = self.look.after(said)
                    self._tell_watchers(self.look)
                    self._changed(facts=True)
                case _:
                    self._note(said)
                    return await self._ask(said)
        except (Actr3dError, OSError) as error:
            return Reply(id=0, error=str(error))
        return Reply(id=0)

    def _note(self, said: Any) -> None:
        """Keeps what holds for later runs, too."""
        if isinstance(said, say.Speed):
            self.speed = said.factor
        elif isinstance(said, say.Breakpoints):
            self.breakpoints = said.productions
            self._changed(facts=True)

    async def _ask(self, said: Any) -> Reply:
        worker = self._worker
        if worker is None:
            raise SimulationError("there is no run: begin one")
        if len(self._waiting) >= MOST_WAITING:
            raise SimulationError("too much waits for its answer already; is the model busy?")
        self._number += 1
        number = self._number
        waiting: asyncio.Future[Reply] = asyncio.get_running_loop().create_future()
        self._waiting[number] = worker, waiting
        worker.send(Do(id=number, say=said.model_dump_json().encode()))
        return await waiting

    def draw(self, kinds: tuple[str, ...]) -> None:
        """Lets the states of this run and later ones tell what overlays of these kinds show."""
        if kinds != self._drawn:
            self._drawn = kinds
            if self._worker is not None:
                self._worker.send(Draw(kinds=kinds))

    # -- what is told of it

    def tell(self, notice: Notice, start: Start | None = None) -> None:
        """Tells all who watch something; with the attempt that it is about, and the version of the model's text then."""
        told: dict[str, Any] = {"number": self._notice_number, "level": notice.level, "text": notice.text, "detail": notice.detail}
        told |= {"file": self._shown_file(notice.file, start), "line": notice.line}
        told |= {"attempt": self._attempt if start is None else start.attempt, "version": start and start.version}
        self.notices.append((self._notice_number, msgspec.json.encode(told)))
        self._notice_number += 1
        self._changed()

    def scene_ready(self) -> None:
        """Takes note that there is a 3D view now."""
        self.has_scene = True
        self._changed(facts=True)

    def file_changed(self) -> None:
        """Takes note that the model's file has been saved: the run may be stale now."""
        self._changed(facts=True)

    def renamed(self, path: Path, model: str) -> None:
        """Takes note that the model's file has another name now."""
        self.path, self.model = path, model
        self._changed(facts=True)

    # -- who watches

    def join(self, name: str) -> Feed:
        """Lets one more browser watch."""
        feed = Feed(self, name)
        self.feeds.append(feed)
        self._changed(facts=True)
        return feed

    def part(self, feed: Feed) -> None:
        """Takes note that a browser is gone."""
        self.feeds.remove(feed)
        self._changed(facts=True)

    def _changed(self, *, facts: bool = False) -> None:
        self.facts_version += facts
        for feed in self.feeds:
            feed.wake()

    def _tell_watchers(self, what: Facts | State | Look) -> None:
        for watcher in self.watchers:
            watcher(self, what)

    def _keep(self, work: Any) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
