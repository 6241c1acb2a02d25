"""Manages all sessions of a server, and short jobs that need a worker."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

from actr3d.errors import Actr3dError, ModelFileError
from workbench.files import ModelFolder
from workbench.jobs import doing
from workbench.listing import Listing
from workbench.readers import Readers
from workbench.recorded_start import RecordedStart
from workbench.recordings import Recordings
from workbench.replays import Replays
from workbench.run_request import RunOptions
from workbench.scene_view import SceneView
from workbench.session import Session
from workbench.worker.messages import Notice, Start
from workbench.worker.workers import Worker, Workers

MAX_SESSIONS = 8
"""Maximum number of sessions; each has a worker."""
CHECK_TIME = 10.0
"""Maximum time for loading a model for a check [s]."""


class SessionError(Actr3dError):
    """A session cannot be started or does not exist."""


class NoSuchSessionError(SessionError):
    """There is no session of that name."""

    status = 404


class PermissionNeededError(SessionError):
    """Code of a recording or experiment that this installation did not make would be run without the user's permission."""

    status = 403

    def __init__(self, what: str) -> None:
        super().__init__(
            f"this installation did not make the {what} (or it was changed since), and the code in it would be run: "
            'send "trust": true if you know where it comes from'
        )


class Sessions:
    """Starts and ends sessions."""

    def __init__(self, folder: ModelFolder, recordings: Recordings, workers: Workers) -> None:
        self.folder = folder
        self.recordings = recordings
        self.workers = workers
        self.readers = Readers(workers)
        self.listing = Listing(recordings, workers, folder.root)
        self.replays = Replays(workers)
        self._sessions: dict[str, Session] = {}
        self._views: dict[str, SceneView] = {}
        self._count = 0
        self._opening = asyncio.Lock()
        self._reopening = asyncio.Lock()
        recordings.spare = lambda: {path for session in self.all() if (path := session.spare_recording) is not None}

    def all(self) -> list[Session]:
        """Returns all sessions, oldest first."""
        return list(self._sessions.values())

    def get(self, name: str, born: float | None = None) -> Session:
        """Returns a session.

        Args:
            name: Its name.
            born: When it began [s since 1970]; None for any session of that name: an earlier server has given the same names.

        Raises:
            NoSuchSessionError: If there is no such session.
        """
        session = self._sessions.get(name)
        if session is None or born not in (None, session.born):
            raise NoSuchSessionError("there is no such session")
        return session

    def writing(self) -> dict[str, str]:
        """Returns the recordings that runs are still writing, with the names of their sessions."""
        return {path.stem: session.name for session in self.all() for path in session.writing}

    def view(self, name: str) -> SceneView | None:
        """Returns the 3D view of a session; None if the run on screen has no world."""
        view = self._views.get(name)
        return view if view is not None and view.exists else None

    async def open(
        self, model: str, settings: dict[str, Any], *, seed: int | None, record: bool, run: bool, real_time: bool = False
    ) -> Session:
        """Starts a session with a model file.

        Args:
            model: The path of the file as pages show it.
            settings: Values of parameters.
            seed: None for a new random seed.
            record: Whether the run is recorded.
            run: Whether the run starts going at once, instead of paused.
            real_time: Whether the session is for somebody who watches it: a run with a body goes in real time until a speed is chosen,
                and the session takes over overlays, a chosen speed, and for the same model the breakpoints, from the session that a page
                shows, or else from the newest. Otherwise it goes as fast as possible.

        Raises:
            Actr3dError: If there is no such file, or there are too many sessions.
            OSError: If no worker can be started.
        """
        where = self.folder.locate(model)
        self.folder.read(model)
        try:
            return await self._begun(where, model, RunOptions(settings=settings, seed=seed, record=record, run=run), real_time=real_time)
        except ModelFileError:
            self.folder.read(model)  # raises the error of a file that does not exist, if it was renamed or deleted in the meantime
            raise

    async def recorded_start(self, recording: str) -> RecordedStart:
        """Returns what a recorded run began with; its code is not executed.

        Raises:
            Actr3dError: If there is no such recording, or it cannot be read.
            OSError: If no worker can be started.
        """
        with await self.readers.make("recorded start", self.recordings.path(recording)) as made:
            return RecordedStart.from_json(made.read())

    async def trusted(self, recording: str, trust: bool) -> RecordedStart:
        """Returns what a recorded run began with, if its code may be run; with `trust`, also code that this installation has not recorded.

        Raises:
            PermissionNeededError: If the code may not be run.
            Actr3dError: If there is no such recording, or it cannot be read.
            OSError: If no worker can be started.
        """
        start = await self.recorded_start(recording)
        if not (start.made_here or trust):
            raise PermissionNeededError("recording")
        return start

    async def reopen(self, recording: str, *, trust: bool = False, real_time: bool = False, record: bool = True) -> Session:
        """Starts a session that repeats a recorded run with all commands of users; or returns the session that is known by it.

        A session that is open stays so if its recording is deleted.

        Args:
            recording: The name of the recording.
            trust: As in `trusted`.
            real_time: As in `open`.
            record: Whether the run is recorded once users change it.

        Raises:
            Actr3dError: If there is no such recording, or there are too many sessions.
            OSError: If no worker can be started.
        """
        async with self._reopening:  # two simultaneous requests get the same session
            open_already = [one for one in self.all() if one.recorded is not None and one.recorded.stem == recording and not one.is_over]
            if open_already:
                return open_already[-1]
            start = await self.trusted(recording, trust)
            shown = self.folder.shown(start.file)
            path = self.folder.root / shown  # a new run uses the user's own model of that name, if there is one
            options = RunOptions(settings=start.parameters, seed=start.seed, record=record, repeated=start)
            return await self._begun(path, shown, options, real_time=real_time)

    async def adopt(self, worker: Worker, name: str) -> Session:
        """Starts a session with a run that has been built elsewhere; see `Session.adopt`.

        Args:
            worker: The connection to the process of the run.
            name: What pages show in place of a model file.

        Raises:
            SessionError: If there are too many sessions.
        """
        async with self._opening:
            session = await self._new(self.folder.root / name, name)
        session.adopt(worker)
        return session

    async def _begun(self, path: Path, model: str, options: RunOptions, *, real_time: bool = False) -> Session:
        """Returns a new session that has started a run; if the run cannot be started, the session is closed again."""
        async with self._opening:  # making room takes a moment, in which no other session may take it
            present = max(reversed(self.all()), key=lambda one: bool(one.feeds), default=None)
            session = await self._new(path, model)
        session.real_time = real_time
        if real_time and present is not None:
            session.take_choices(present)
        try:
            await session.begin(options)
        except BaseException:
            if self._sessions.get(session.name) is session:
                await self.close(session.name)
            raise
        return session

    async def _new(self, path: Path, model: str) -> Session:
        ended: Session | None = None
        if len(self._sessions) >= MAX_SESSIONS:
            # Users who try many models leave sessions behind: their runs are recorded and can be opened again.
            idle = [one for one in self.all() if not one.feeds and (one.is_over or (one.state is not None and not one.going_on))]
            if not idle:
                busy = "each is shown on a page or still running: close a page, or stop a run"
                raise SessionError(f"there are {MAX_SESSIONS} sessions already, and {busy}")
            ended = next((one for one in idle if one.recorded is not None), idle[0])
            await self.close(ended.name)
        self._count += 1
        name = f"s{self._count}"
        session = Session(name, path, self.workers, self.recordings, model, self.announce_recordings)
        self._sessions[name] = session
        self._views[name] = SceneView(session)
        if ended is not None:
            self._report_ended(ended)
        return session

    def _report_ended(self, ended: Session) -> None:
        """Informs all browsers that a session was ended to make room for another one."""
        recorded = ended.recorded is not None or ended.recording in [path.stem for path in self.recordings.all()]
        where = "its recording is under Runs" if recorded else "it was not recorded"
        text = f"At most {MAX_SESSIONS} models can be open: the run of {ended.model}, which no page showed, was ended; {where}."
        for session in self.all():
            session.add_notice(Notice(level="warning", text=text), of_run=False)

    async def close(self, name: str) -> None:
        """Ends a session.

        Raises:
            NoSuchSessionError: If there is no session of that name.
        """
        session = self.get(name)
        del self._sessions[name], self._views[name]
        await session.close()

    async def close_all(self) -> None:
        """Ends all sessions."""
        await asyncio.gather(*(self.close(name) for name in list(self._sessions)))

    def announce_recordings(self) -> None:
        """Informs all browsers that a recording began, ended, or was labelled or deleted."""
        for session in self.all():
            session.recording_changes += 1
            session.changed(facts=True)

    def saved(self, path: Path) -> None:
        """Informs the sessions that a file may have a new text."""
        for session in self.all():
            session.file_changed(path)

    def renamed(self, before: Path, path: Path, model: str) -> None:
        """Informs the sessions of a model file that it has been renamed: they continue with the new name."""
        for session in self.all():
            if session.path == before:
                session.renamed(path, model)

    async def check(self, path: Path, text: str) -> list[dict[str, Any]]:
        """Loads a model in a worker and builds what it describes, and runs no more than one tick; returns the problems found.

        Raises:
            OSError: If no worker can be started.
        """
        problems: list[dict[str, Any]] = []
        async with doing(self.workers, Start(job="check", path=str(path), source=text, folder=str(path.parent))) as checking:
            try:
                async with asyncio.timeout(CHECK_TIME):
                    await checking.over.wait()
            except TimeoutError:
                problems.append({"level": "error", "message": f"loading takes longer than {CHECK_TIME:g} s", "line": None})
            for notice in checking.notices:
                own = notice.file in (None, str(path))
                problems.append({"level": notice.level, "message": notice.text, "line": notice.line if own else None})
            if checking.ending:
                problems.append({"level": "error", "message": checking.ending, "line": None})
        return problems
