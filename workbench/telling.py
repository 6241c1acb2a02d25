"""What pages are told of a session, as JSON."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec

from actr3d.actr.reading import read_source
from actr3d.errors import Actr3dError
from workbench.feed import Feed, Raw
from workbench.helpers import helper_texts
from workbench.look import Look
from workbench.worker.messages import Facts, Start, State
from workbench.worker.workers import Worker


class Telling:
    """The part of a session that says in JSON what it is like."""

    name: str
    path: Path
    model: str
    run: int
    state: State | None
    facts: Facts | None
    start: Start | None
    feeds: list[Feed]
    breakpoints: tuple[str, ...]
    has_scene: bool
    look: Look
    _worker: Worker | None
    _loading: Worker | None
    _ending: str
    _stuck: dict[str, Any] | None
    _controlled_by: str
    _attempt: int
    _began_with: tuple[Start, dict[Path, str]] | None = None
    """The texts of the modules that the model imports from its folder, as the run of this start began."""

    def _shown_file(self, file: str | None, start: Start | None = None) -> str | None:
        """Returns a file of the models folder as pages call it; the model itself by its present name."""
        if file is None or file == str(self.path) or (start is not None and file == start.path):
            return file and self.model
        root = self.path.parents[self.model.count("/")]
        inside = self.path == root / self.model and Path(file).is_relative_to(root)
        return Path(file).relative_to(root).as_posix() if inside else file

    def facts_json(self) -> bytes:
        """Returns what is known of the session and its run."""
        facts, start = self.facts, self.start
        told: dict[str, Any] = {
            **self.summary(),
            "stuck": self._stuck,
            "scene": self.has_scene,
            **self.look.told(),
            "breakpoints": self.breakpoints,
            "settings": start.settings if start is not None else {},
            "seed": facts.seed if facts is not None else None,
            "stale": start is not None and self._text_differs(start),
            "gone": not self.path.is_file(),
            "attempt": self._attempt,
            "shown_attempt": start.attempt if start is not None else None,
            "version": start.version if start is not None else None,
            "recording": Path(start.record).stem if start is not None and start.record is not None else None,
        }
        if facts is not None:
            told |= {"kind": facts.kind, "period": facts.period, "parameters": Raw(facts.parameters), "world": Raw(facts.world)}
        return msgspec.json.encode(told)

    def summary(self) -> dict[str, Any]:
        """Returns what a list of sessions tells of it."""
        return {
            "id": self.name,
            "model": self.model,
            "run": self.run,
            "alive": self._worker is not None,
            "loading": self._loading is not None,
            "ending": self._ending,
            "status": None if self.state is None else self.state.status,
            "watching": [feed.name for feed in self.feeds],
            "controlled_by": self._controlled_by,
        }

    def state_json(self) -> bytes:
        """Returns the newest state."""
        state = self.state
        if state is None:
            return b"null"
        told = {name: getattr(state, name) for name in ("status", "reason", "tick", "time", "furthest", "wanted", "measured", "events")}
        return msgspec.json.encode({**told, "apertures": state.apertures, "result": Raw(state.result), "parts": Raw(state.parts)})

    def _text_differs(self, start: Start) -> bool:
        """Tells whether the model's file, or a module beside it that it imports, is not what it was when the run began."""
        folder = Path(start.folder)
        if self._began_with is None or self._began_with[0] is not start:
            relived = {folder / file: text for file, text in start.helpers.values()}
            self._began_with = start, relived or helper_texts(start.source, folder)
        try:
            return read_source(self.path) != start.source or any(read_source(path) != text for path, text in self._began_with[1].items())
        except Actr3dError:
            return True
