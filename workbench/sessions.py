"""All sessions of a server, and the jobs that need a worker for a moment only."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

from actr3d.errors import Actr3dError
from actr3d.recording import Recorded
from workbench.attempt import Relived, Wanted
from workbench.files import ModelFolder
from workbench.jobs import doing
from workbench.recordings import Recordings
from workbench.rerunning import Reruns
from workbench.scene_view import SceneView
from workbench.session import Session
from workbench.worker.messages import Start
from workbench.worker.workers import Workers

MOST = 8
"""So many sessions there may be at once; each has a worker."""
CHECK_TIME = 10.0
"""So long a model may take to be loaded for a check [s]."""


class SessionError(Actr3dError):
    """A session cannot be begun, or is not there."""

    status = 409


class NoSuchSessionError(SessionError):
    """There is no session of that name."""

    status = 404


class Sessions:
    """Begins and ends sessions.

    Args:
        folder: The models.
        recordings: Where runs are recorded.
        workers: Who runs them.
    """

    def __init__(self, folder: ModelFolder, recordings: Recordings, workers: Workers) -> None:
        self.folder = folder
        self.recordings = recordings
        self.workers = workers
        self.reruns = Reruns(workers)
        self._sessions: dict[str, Session] = {}
        self._views: dict[str, SceneView] = {}
        self._count = 0
        self._opening = asyncio.Lock()

    def all(self) -> list[Session]:
        """Returns all sessions, the oldest first."""
        return list(self._sessions.values())

    def get(self, name: str) -> Session:
        """Returns a session.

        Raises:
            NoSuchSessionError: If there is none of that name.
        """
        if name not in self._sessions:
            raise NoSuchSessionError("there is no such session")
        return self._sessions[name]

    def writing(self) -> dict[str, str]:
        """Returns by their names the recordings that runs go on writing, and their sessions."""
        return {
            Path(session.start.record).stem: session.name
            for session in self.all()
            if session.alive and session.start is not None and session.start.record is not None
        }

    def view(self, name: str) -> SceneView | None:
        """Returns the 3D view of a session, once there is something to see."""
        view = self._views.get(name)
        return view if view is not None and view.ready.is_set() else None

    async def open(self, model: str, settings: dict[str, Any], *, seed: int | None, record: bool, run: bool) -> Session:
        """Begins a session with a model file.

        Raises:
            Actr3dError: If there is no such file, or there are too many sessions.
            OSError: If no worker can be started.
        """
        where = self.folder.locate(model)
        self.folder.read(model)
        return await self._begun(where, model, Wanted(settings=settings, seed=seed, record=record, run=run))

    async def reopen(self, recording: str) -> Session:
        """Begins a session that lives through a recorded run again, with everything that users did.

        Raises:
            Actr3dError: If there is no such recording, or there are too many sessions.
            OSError: If no worker can be started.
        """
        with Recorded(self.recordings.path(recording)) as recorded:
            facts = recorded.facts
            commands = [(command.tick, command.data) for command in recorded.commands()]
        file = facts.get("file")
        if file is None or file not in facts.get("sources", {}):
            raise SessionError("the recording does not say which model file made it")
        path = Path(file)
        inside = path.resolve().is_relative_to(self.folder.root)
        shown = path.resolve().relative_to(self.folder.root).as_posix() if inside else path.name
        seed = facts.get("program_seed", facts["seed"])
        settings = facts.get("parameters", {})
        helpers = {name: (str(where), str(text)) for name, (where, text) in facts.get("helpers", {}).items()}
        relived = Relived(source=facts["sources"][file], commands=commands, helpers=helpers)
        return await self._begun(path, shown, Wanted(settings=settings, seed=seed, record=False, relived=relived))

    async def _begun(self, path: Path, model: str, wanted: Wanted) -> Session:
        """Returns a new session that has begun a run; where that cannot be begun, there is no session either."""
        async with self._opening:  # making room takes a moment, in which nobody else takes it
            session = await self._new(path, model)
        try:
            await session.begin(wanted)
        except BaseException:
            if self._sessions.get(session.name) is session:
                await self.close(session.name)
            raise
        return session

    async def _new(self, path: Path, model: str) -> Session:
        if len(self._sessions) >= MOST:
            # Whoever has tried many models has left many behind: their runs are recorded, and can be opened again.
            idle = [one for one in self.all() if one.state is not None and not one.feeds and not one.going_on]
            if not idle:
                raise SessionError(f"there are {MOST} sessions already, and each is watched or goes on: close a page, or stop a run")
            await self.close(idle[0].name)
        self._count += 1
        name = f"s{self._count}"
        session = Session(name, path, self.workers, self.recordings.new, model)
        self._sessions[name] = session
        self._views[name] = SceneView(session)
        return session

    async def close(self, name: str) -> None:
        """Ends a session.

        Raises:
            NoSuchSessionError: If there is none of that name.
        """
        session = self.get(name)
        del self._sessions[name], self._views[name]
        await session.close()

    async def close_all(self) -> None:
        """Ends all sessions."""
        await asyncio.gather(*(self.close(name) for name in list(self._sessions)))

    def saved(self, path: Path) -> None:
        """Takes note that a file has another text now."""
        for session in self.all():
            session.file_changed(path)

    def renamed(self, before: Path, path: Path, model: str) -> None:
        """Takes note that a model file has another name now: its sessions go on with it."""
        for session in self.all():
            if session.path == before:
                session.renamed(path, model)

    async def check(self, path: Path, text: str) -> list[dict[str, Any]]:
        """Loads a model in a worker, and builds what it describes, without running it; returns what is complained of.

        Raises:
            OSError: If no worker can be started.
        """
        told: list[dict[str, Any]] = []
        async with doing(self.workers, Start(job="check", path=str(path), source=text, folder=str(path.parent))) as checking:
            try:
                async with asyncio.timeout(CHECK_TIME):
                    await checking.over.wait()
            except TimeoutError:
                told.append({"level": "error", "message": f"loading takes longer than {CHECK_TIME:g} s", "line": None})
            for notice in checking.notices:
                own = notice.file in (None, str(path))
                told.append({"level": notice.level, "message": notice.text, "line": notice.line if own else None})
            if checking.ending:
                told.append({"level": "error", "message": checking.ending, "line": None})
        return told
