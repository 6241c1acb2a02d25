"""The texts that a run was made of: the model's own and those of its helper modules; and whether the files hold them still."""

from __future__ import annotations

from pathlib import Path

from actr3d.actr.loading.source_text import read_source
from actr3d.errors import Actr3dError
from workbench.worker.messages import Loaded, Start, digest_of

MOST = 100
"""No more helper modules are watched."""


class Texts:
    """Knows what a run was made of.

    Args:
        start: What the run began with. Helper modules that it names are of an earlier run, which it lives through again.
    """

    def __init__(self, start: Start) -> None:
        self._source = start.source
        self._helpers: dict[Path, str] = {}
        for file, text in list(start.helpers.values())[:MOST]:
            self._helpers[(Path(start.folder) / file).resolve()] = digest_of(text)

    def take(self, loaded: Loaded) -> None:
        """Takes note of a helper module that the run has loaded."""
        path = Path(loaded.file).resolve()
        if path in self._helpers or len(self._helpers) < MOST:
            self._helpers[path] = loaded.digest

    def has_helper(self, path: Path) -> bool:
        """Tells whether a file is one of the helper modules."""
        return path.resolve() in self._helpers

    def differ(self, path: Path) -> bool:
        """Tells whether any of the files holds another text now.

        Args:
            path: Where the model is now.
        """
        try:
            # A file that is none may never come to its end.
            if not all(each.is_file() for each in (path, *self._helpers)):
                return True
            return read_source(path) != self._source or any(digest_of(read_source(path)) != then for path, then in self._helpers.items())
        except (Actr3dError, OSError):
            return True
