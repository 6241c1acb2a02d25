"""Remembers the texts that a run was made from, those of the model and its helper modules, to detect whether the files have changed."""

from __future__ import annotations

from pathlib import Path

from actr3d.actr.loading.source_text import read_source
from actr3d.errors import Actr3dError
from workbench.worker.messages import Loaded, Start, digest_of

MOST = 100
"""Maximum number of helper modules that are watched."""


class SourceVersions:
    """Holds the versions of the texts that a run was made from.

    Args:
        start: What the run began with. Its helper modules, if any, are those of the earlier run that it repeats.
    """

    def __init__(self, start: Start) -> None:
        self._source = start.source
        self._helpers: dict[Path, str] = {}
        for file, text in list(start.helpers.values())[:MOST]:
            self._helpers[(Path(start.folder) / file).resolve()] = digest_of(text)

    def add(self, loaded: Loaded) -> None:
        """Records a helper module that the run has loaded."""
        path = Path(loaded.file).resolve()
        if path in self._helpers or len(self._helpers) < MOST:
            self._helpers[path] = loaded.digest

    def has_helper(self, path: Path) -> bool:
        """Returns whether a file is one of the helper modules."""
        return path.resolve() in self._helpers

    def differ(self, path: Path) -> bool:
        """Returns whether any of the files has changed.

        Args:
            path: The current path of the model.
        """
        try:
            # Reading something other than a regular file may never end.
            if not all(each.is_file() for each in (path, *self._helpers)):
                return True
            return read_source(path) != self._source or any(digest_of(read_source(path)) != then for path, then in self._helpers.items())
        except (Actr3dError, OSError):
            return True
