"""Reads and writes the model files of one folder: nothing outside it is touched, and nothing in it is executed."""

from __future__ import annotations

import codecs
import contextlib
import hashlib
import io
import os
import tokenize
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from threading import Lock

from actr3d.actr.loading.source_text import decode_source, read_bytes
from actr3d.errors import Actr3dError
from actr3d.replacing import replace_file
from workbench.trash import move_to_trash

MAX_FILE_SIZE = 1_000_000
"""Maximum size of a model file [bytes]."""
MAX_FILES = 2_000
"""Maximum number of files that are listed."""


class FileError(Actr3dError):
    """A file cannot be read or written as requested."""

    status = 400


class NoSuchFileError(FileError):
    """The file does not exist."""

    status = 404


class ConflictError(FileError):
    """The file has changed since its writer read it, or already exists."""

    status = 409


@dataclass(frozen=True, kw_only=True)
class ModelFile:
    """Holds the content of a model file."""

    path: str
    """The path inside the folder, with slashes."""
    text: str
    version: str
    """A hash of the file's bytes, which identifies this version of the text."""


class ModelFolder:
    """Reads and writes the model files of a folder."""

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()
        self._saving = Lock()

    def paths(self) -> list[str]:
        """Returns the paths of all model files, sorted by folder depth and name, without hidden files and links that lead outside.

        Other programs can make files whose paths cannot be opened: `problem_of` says why.
        """
        found: list[str] = []
        for path in self._walk(self.root):
            found.append(path.relative_to(self.root).as_posix())
            if len(found) >= MAX_FILES:
                break
        return sorted(found, key=lambda path: (path.count("/"), path))

    def _walk(self, folder: Path) -> Iterator[Path]:
        try:
            inside = sorted(folder.iterdir()) if folder.is_dir() else []
        except OSError:  # not readable, or deleted in the meantime: the other folders are still listed
            return
        for path in inside:
            if path.name[0] in "._":
                continue
            if path.is_dir() and not path.is_symlink():
                yield from self._walk(path)
            elif path.suffix == ".py" and path.is_file() and path.resolve().is_relative_to(self.root):
                yield path

    @staticmethod
    def problem_of(path: str) -> str | None:
        """Returns why a path cannot be that of a model file, whether or not there is such a file; None if it can."""
        parts = path.split("/")
        if not path or "\0" in path or "\\" in path or len(path.encode("utf-8", "replace")) > 400:
            return "must be a path with slashes, of at most 400 bytes"
        if any(len(part.encode("utf-8", "replace")) > 200 for part in parts):
            return "each name in it must have at most 200 bytes; many letters have more than one"
        if any(part in ("", ".", "..") or part[0] == "." for part in parts):
            return "must lie inside the models folder, without hidden parts"
        if not path.endswith(".py"):
            return "must end in .py"
        if ":" in path:
            return "must have no colon"
        if any(unicodedata.category(c)[0] == "C" for c in path):
            return "must have no invisible or invalid characters"
        return None

    def locate(self, path: str) -> Path:
        """Returns the location of a path inside the folder.

        Raises:
            FileError: If the path leads out of the folder, is hidden, or is not a name of a model file.
        """
        problem = self.problem_of(path)
        if problem is not None:
            raise FileError(f"the path of a model file: {problem}")
        where = self.root / path
        try:
            end = where.resolve()
            inside = end.is_relative_to(self.root) and not end.is_symlink()  # since Python 3.13, a loop of links is returned
        except (OSError, RuntimeError):  # links that form a loop
            inside = False
        if not inside:
            raise FileError("the path is outside the models folder")
        return where

    def shown(self, file: str) -> str:
        """Returns a recorded path as pages show it: the path inside the folder, or only the name of a file that may lie elsewhere."""
        path = Path(os.path.normpath(Path(file).absolute()))
        name = path.name if file else ""
        try:
            end = path.resolve()
        except (OSError, RuntimeError, ValueError):  # links that form a loop, or characters that no path has
            return name
        if file == name or not end.is_relative_to(self.root):
            return name
        return (path if path.is_relative_to(self.root) else end).relative_to(self.root).as_posix()

    def read(self, path: str) -> ModelFile:
        """Reads a model file.

        Raises:
            FileError: If the file does not exist, is too large, or is not text.
        """
        where = self._existing(path)
        try:
            if where.stat().st_size > MAX_FILE_SIZE:
                raise FileError(f"'{path}' is larger than {MAX_FILE_SIZE:,} bytes")
            text, version = self.text_and_version(where)
            return ModelFile(path=path, text=text, version=version)
        except OSError as error:
            raise FileError(f"cannot read '{path}': {error.strerror}") from None

    @staticmethod
    def version(where: Path) -> str:
        """Returns the version of a file's current text: a hash of its bytes."""
        return _version(where.read_bytes())

    @staticmethod
    def text_and_version(where: Path) -> tuple[str, str]:
        """Returns the current text of a file and its version, from the same bytes.

        Raises:
            ModelFileError: If the file does not exist, cannot be read, or is not text.
        """
        data = read_bytes(where)
        return decode_source(data, where), _version(data)

    def save(self, path: str, text: str, version: str | None) -> ModelFile:
        """Writes a model file if it has not changed since the writer read it.

        Args:
            path: The path of the file.
            text: The new text.
            version: The version of the text that is replaced; None for a new file.

        Raises:
            ConflictError: If a new file already exists, or the file has a different version.
            FileError: If the file cannot be written.
        """
        where = self.locate(path)
        data = _encoded(text, *self._line_end_and_mark(where))
        if len(data) > MAX_FILE_SIZE:
            raise FileError(f"the size of a model file: must be <= {MAX_FILE_SIZE:,} bytes (got {len(data):,})")
        with self._saving:  # of two who have read the same version, only one replaces it
            now = self.version(where) if where.is_file() else None
            if now != version:
                gone, exists = "the file no longer exists", "the file already exists"
                reason = gone if now is None else exists if version is None else "the file has changed"
                raise ConflictError(f"'{path}' was not saved: {reason}")
            try:
                if where.exists() and not is_writable(where):
                    raise FileError(f"cannot write '{path}': it is read-only")
                where.parent.mkdir(parents=True, exist_ok=True)
                replace_file(where.resolve(), data)  # a link inside the folder stays a link
            except OSError as error:
                raise FileError(f"cannot write '{path}': {error.strerror}") from None
        return ModelFile(path=path, text=text, version=_version(data))

    def _line_end_and_mark(self, where: Path) -> tuple[str, bytes]:
        """Returns the line ending of a file and the byte order mark at its start, if any, so that a file keeps its own."""
        with contextlib.suppress(OSError), where.open("rb") as file:
            first = file.readline(MAX_FILE_SIZE)
            return "\r\n" if first.endswith(b"\r\n") else "\n", codecs.BOM_UTF8 if first.startswith(codecs.BOM_UTF8) else b""
        return "\n", b""

    def copy(self, path: str, to: str) -> ModelFile:
        """Writes a copy of a model file under another name.

        Raises:
            FileError: If the file does not exist, or the other name is taken.
        """
        return self.save(to, self.read(path).text, None)

    def rename(self, path: str, to: str) -> ModelFile:
        """Renames a model file.

        Raises:
            FileError: If the file does not exist, or the other name is taken.
        """
        where, target = self._existing(path), self.locate(to)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            os.link(where, target, follow_symlinks=False)  # unlike rename, this never replaces an existing file
            where.unlink()
        except FileExistsError:
            raise ConflictError(f"there is a '{to}' already") from None
        except OSError as error:
            raise FileError(f"cannot rename '{path}': {error.strerror}") from None
        return self.read(to)

    def delete(self, path: str) -> str:
        """Moves a model file to the trash folder; returns its new path inside the models folder.

        Raises:
            FileError: If the file does not exist or cannot be moved.
        """
        where = self._existing(path)
        try:
            trash = move_to_trash(self.root, where)
        except OSError as error:
            raise FileError(f"cannot delete '{path}': {error.strerror}") from None
        with contextlib.suppress(OSError):
            if where.parent != self.root:
                where.parent.rmdir()  # succeeds only if the folder is empty
        return trash

    def _existing(self, path: str) -> Path:
        where = self.locate(path)
        if not where.is_file():
            raise NoSuchFileError(f"there is no '{path}'")
        return where


def _version(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def file_stamp(*paths: Path) -> tuple[int, ...]:
    """Returns numbers that change whenever one of some files changes; the last one is the size of the last file that exists."""
    numbers: list[int] = []
    for path in paths:
        with contextlib.suppress(OSError):
            now = path.stat()
            numbers += now.st_ino, now.st_mtime_ns, now.st_size
    return tuple(numbers)


def database_stamp(path: Path) -> tuple[int, ...]:
    """Returns the stamp of an SQLite file and of the log beside it, which has what is new while the file is written."""
    return file_stamp(path, path.with_name(f"{path.name}-wal"))


def is_writable(where: Path) -> bool:
    """Returns whether a file may be written; saving replaces the file, for which the system checks only the folder's permissions.

    Root may write every file, so a file without any write permission counts as read-only for root, too.
    """
    return os.access(where, os.W_OK) and bool(where.stat().st_mode & 0o222)


def _encoded(text: str, line_end: str, mark: bytes) -> bytes:
    """Returns a text as bytes, in the encoding that its first lines declare; in UTF-8 after a byte order mark, if there was one.

    Raises:
        FileError: If the encoding is unknown, or lacks a character of the text.
    """
    try:
        declared, _ = tokenize.detect_encoding(io.BytesIO(text.encode("utf-8")).readline)
        data = text.replace("\n", line_end).encode(declared)
        return mark + data if declared == "utf-8" else data
    except UnicodeEncodeError as error:
        if 0xD800 <= ord(error.object[error.start]) < 0xE000:
            raise FileError("the text has an unpaired surrogate character, which no file can hold") from None
        raise FileError(f"{error.object[error.start]!r} is not in the encoding that the text declares ({error.encoding})") from None
    except (SyntaxError, LookupError) as error:
        raise FileError(f"the text declares an encoding that cannot be used: {error}") from None
