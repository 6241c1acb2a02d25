"""Defines the part of a session that pages see: its state, its notices, and who watches it."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec

from workbench.attempt import Attempt
from workbench.feed import MOST_NOTICES, EventLog, Feed, Raw
from workbench.look import Look
from workbench.summaries import begun
from workbench.worker.messages import Branched, Facts, Notice, Start, State

Watcher = Callable[[Facts | State | Look | None], None]


class Telling:
    """Holds what is shown of a session, and who watches it.

    Args:
        name: The name of the session.
        path: The model file.
        shown_path: The model's path as pages show it.
    """

    def __init__(self, name: str, path: Path, shown_path: str) -> None:
        self.name = name
        self.path = path
        self.model = shown_path
        self.feeds: list[Feed] = []
        self.watchers: list[Watcher] = []
        """Called with the facts of each new run, each state, each change of the view settings, and None at the end."""
        self.look = Look()
        self.run: int = 0
        self.epoch: int = 0
        self.state_version: int = 0
        self.facts_version: int = 0
        self.log = EventLog()
        self.notices: deque[tuple[int, bytes]] = deque(maxlen=MOST_NOTICES)
        self.state: State | None = None
        self.facts: Facts | None = None
        self.breakpoints: tuple[str, ...] = ()
        self.born = time.time()
        """When the session began [s since 1970]: distinguishes it from a session of the same name of an earlier server."""
        self.branched: Branched | None = None
        """What was kept when a user last changed something in the past of the current run."""
        self.has_scene = False
        """Whether there is a 3D view."""
        self._shown: Attempt | None = None
        """The attempt whose run is on screen, even after its worker has ended."""
        self._loading: Attempt | None = None
        """The attempt whose run is being built."""
        self._attempt = 0
        """The number of the latest attempt."""
        self._notice_number = 0
        self._cuts: deque[tuple[int, int]] = deque(maxlen=MOST_NOTICES)
        """Where the run was cut and continued differently: (number of the next notice, number of events kept).

        Earlier notices about later events belong to a past that no longer exists.
        """
        self._controlled_by = ""
        self._ending = ""
        self._stuck: dict[str, Any] | None = None

    @property
    def start(self) -> Start | None:
        """What the current run was started with."""
        return None if self._shown is None else self._shown.start

    @property
    def recorded(self) -> Path | None:
        """The recording that the run on screen, or the one being built, repeats; None for a new run."""
        start = self._shown.start if self._shown is not None else None if self._loading is None else self._loading.start
        return None if start is None or start.recorded is None else Path(start.recorded)

    @property
    def alive(self) -> bool:
        """Whether the current run still accepts commands."""
        return self._shown is not None and not self._shown.over

    def _shown_file(self, file: str | None, start: Start | None = None) -> str | None:
        """Returns the path of a file in the models folder as pages show it; for the model itself, its current name."""
        if file is None or file == str(self.path) or (start is not None and file == start.path):
            return file and self.model
        root = self.path.parents[self.model.count("/")]
        inside = self.path == root / self.model and Path(file).is_relative_to(root)
        return Path(file).relative_to(root).as_posix() if inside else file

    def facts_json(self) -> bytes:
        """Returns the facts about the session and its run as JSON."""
        facts, start = self.facts, self.start
        told: dict[str, Any] = {
            **self.summary(),
            "stuck": self._stuck,
            "branched": None
            if self.branched is None
            else {"recording": self.branched.recording, "at": self.branched.at, "until": self.branched.until},
            "scene": self.has_scene,
            **self.look.told(),
            "breakpoints": self.breakpoints,
            "settings": start.settings if start is not None else {},
            "seed": None if facts is None else _exactly(facts.seed),
            "stale": self._shown is not None and self._shown.texts.differ(self.path),
            "gone": not self.path.is_file(),
            "attempt": self._attempt,
            "shown_attempt": start.attempt if start is not None else None,
            "version": start.version if start is not None else None,
            "cuts": list(self._cuts),
            "born": self.born,
            "made": None if self.recorded is None else begun(self.recorded),
            "recording": Path(start.record).stem if start is not None and start.record is not None else None,
        }
        if facts is not None:
            told |= {"kind": facts.kind, "period": facts.period, "parameters": Raw(facts.parameters), "world": Raw(facts.world)}
        return msgspec.json.encode(told)

    def summary(self) -> dict[str, Any]:
        """Returns the entry of this session in the list of sessions."""
        return {
            "recorded": None if self.recorded is None else self.recorded.stem,
            "id": self.name,
            "model": self.model,
            "run": self.run,
            "alive": self.alive,
            "loading": self._loading is not None,
            "ending": self._ending,
            "status": None if self.state is None else self.state.status,
            "watching": [feed.name for feed in self.feeds],
            "controlled_by": self._controlled_by,
        }

    def state_json(self) -> bytes:
        """Returns the newest state as JSON."""
        state = self.state
        if state is None:
            return b"null"
        told = {name: getattr(state, name) for name in ("status", "reason", "tick", "time", "furthest", "wanted", "measured", "events")}
        return msgspec.json.encode({**told, "apertures": state.apertures, "result": Raw(state.result), "parts": Raw(state.parts)})

    @property
    def source(self) -> str | None:
        """The model text of the run on screen, or else of the one being built; None if there is neither."""
        attempt = self._shown or self._loading
        return None if attempt is None else attempt.start.source

    # -- who watches

    def join(self, name: str) -> Feed:
        """Adds a browser that watches."""
        feed = Feed(self, name)
        self.feeds.append(feed)
        self._changed(facts=True)
        return feed

    def part(self, feed: Feed) -> None:
        """Removes a browser that has left."""
        self.feeds.remove(feed)
        if feed.name == self._controlled_by:
            self._controlled_by = ""
        self._changed(facts=True)

    def tell(self, notice: Notice, start: Start | None = None) -> None:
        """Sends a notice to all who watch, with the attempt it is about and the version of the model's text at that time."""
        told: dict[str, Any] = {"number": self._notice_number, "level": notice.level, "text": notice.text, "detail": notice.detail}
        told |= {"file": self._shown_file(notice.file, start), "line": notice.line}
        is_shown = self._shown is not None and (self._attempt if start is None else start.attempt) == self._shown.start.attempt
        told["events"] = notice.events if notice.events is not None else self.log.next if is_shown else 0
        told |= {"attempt": self._attempt if start is None else start.attempt, "version": start and start.version}
        self.notices.append((self._notice_number, msgspec.json.encode(told)))
        self._notice_number += 1
        self._changed()

    def scene_ready(self) -> None:
        """Records that the 3D view is ready."""
        self.has_scene = True
        self._changed(facts=True)

    def file_changed(self, path: Path) -> None:
        """Informs pages that a file may have changed: a run that was made from it is stale."""
        if path == self.path or (self._shown is not None and self._shown.texts.has_helper(path)):
            self._changed(facts=True)

    def renamed(self, path: Path, model: str) -> None:
        """Records the new name of the model's file."""
        self.path, self.model = path, model
        self._changed(facts=True)

    def _changed(self, *, facts: bool = False) -> None:
        self.facts_version += facts
        for feed in self.feeds:
            feed.wake()

    def _tell_watchers(self, what: Facts | State | Look | None) -> None:
        for watcher in self.watchers:
            watcher(what)


def _exactly(seed: int | str) -> int | str:
    """Returns a seed in a form that a page can read without loss: as text if it exceeds JavaScript's exact integers."""
    return seed if isinstance(seed, int) and abs(seed) < 2**53 else str(seed)
