"""The files of a mesh or an imported description: read once, from inside one folder, and stored."""

from __future__ import annotations

import hashlib
import posixpath
from contextlib import suppress
from pathlib import Path

from actr3d.errors import WorldError, did_you_mean

MAX_BYTES = 256 * 1024 * 1024
"""Greatest total size of the files of one part [bytes]; a mesh of the largest size takes less in any format."""

Files = tuple[tuple[str, bytes], ...]
"""Names, as in the files that mention them, and contents. The first file is the requested one."""


class AssetFolder:
    """Reads the files of one part from inside a folder, each once; or returns those of an earlier reading, and no others.

    A name that leads out of the folder, by `..`, as an absolute path or through a link, is refused: a foreign description must
    not copy other files of the machine into a recording.

    Args:
        root: The folder; nothing outside it is read.
        error: The exception for a file that cannot be read.
        recorded: The recorded files, by name; then nothing is read from the disk. None to read from the disk.
    """

    def __init__(self, root: Path, error: type[WorldError], recorded: Files | None = None) -> None:
        self.root = resolved(root, error)
        self._error = error
        self._recorded = None if recorded is None else dict(recorded)
        self._read: dict[str, bytes] = {}

    @property
    def files(self) -> Files:
        """The files that were read, in this order."""
        return tuple(self._read.items())

    @property
    def name(self) -> str:
        """The name of the folder, for messages; the whole path of one without a name, such as `/`."""
        return self.root.name or str(self.root)

    def put(self, name: str, content: bytes) -> None:
        """Adds a file that is not in the folder, as if it had been read from there."""
        self._read[name] = content
        self._check_size(name)

    def read(self, name: str, asked_by: str = "") -> bytes:
        """Returns the content of a file, its name relative to the folder.

        Args:
            name: With `/` or `\\` between folders.
            asked_by: The file that mentions it, for the message.

        Raises:
            WorldError: (or the given error) If it is outside the folder, not there, not a file, or too large.
        """
        name = posixpath.normpath(name.replace("\\", "/"))
        if name not in self._read:
            content = self._content(name, f"{asked_by}: " if asked_by else "")
            self._read[name] = content
            self._check_size(name)
        return self._read[name]

    def has(self, name: str) -> bool:
        """Returns whether a file of this name can be read."""
        name = posixpath.normpath(name.replace("\\", "/"))
        if self._recorded is not None:
            return name in self._recorded
        with suppress(self._error):
            path = resolved(self.root / name, self._error)
            return path.is_relative_to(self.root) and path.is_file()
        return False

    def _content(self, name: str, whose: str) -> bytes:
        if self._recorded is not None:
            if not self._recorded:
                raise self._error(f"{whose}'{name}' cannot be read: a description given as text has no folder of its own; give folder=")
            if name not in self._recorded:
                raise self._error(f"{whose}no '{name}' among the files that were recorded{did_you_mean(name, self._recorded)}")
            return self._recorded[name]
        try:
            path = (self.root / name).resolve()
            if not path.is_relative_to(self.root):
                raise self._error(f"{whose}'{name}' lies outside the folder '{self.name}': files are read only from inside it")
            if not path.is_file():
                raise self._error(f"{whose}no file '{name}' in the folder '{self.name}'{self._near(path)}")
            if path.stat().st_size > MAX_BYTES:
                raise self._error(f"{whose}'{name}' has {path.stat().st_size:,} bytes; the limit is {MAX_BYTES:,}")
            return path.read_bytes()
        except (OSError, ValueError, RuntimeError) as error:  # RuntimeError: links that lead in a circle
            raise self._error(f"{whose}'{name}' cannot be read: {error}") from error

    def _near(self, path: Path) -> str:
        if path.is_dir():
            return " (it is a folder)"
        return did_you_mean(path.name, (other.name for other in path.parent.iterdir())) if path.parent.is_dir() else ""

    def _check_size(self, name: str) -> None:
        total = sum(map(len, self._read.values()))
        if total > MAX_BYTES:
            raise self._error(f"'{name}': the files have {total:,} bytes together; the limit is {MAX_BYTES:,}")


def resolved(path: Path, error: type[WorldError]) -> Path:
    """Returns an absolute path without links.

    Raises:
        WorldError: (or the given error) If the path is invalid: a circle of links, or an impossible character.
    """
    try:
        return path.resolve()
    except (OSError, ValueError, RuntimeError) as failure:
        raise error(f"{str(path)!r} is not a readable path: {failure}") from failure


def digest(files: Files) -> str:
    """Returns the sha256 of names and contents, in hexadecimal: the same files, and only they, give the same."""
    whole = hashlib.sha256()
    for name, content in files:
        whole.update(f"{len(name.encode())}:{name}{len(content)}:".encode())
        whole.update(content)
    return whole.hexdigest()
