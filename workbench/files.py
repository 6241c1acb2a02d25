"""The model files of one folder: nothing outside it is read or written, and nothing in it is ever run."""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import secrets
import time
import tokenize
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from actr3d.actr.loading.source_text import read_source
from actr3d.errors import Actr3dError

LARGEST = 1_000_000
"""No model file is larger [bytes]."""
MOST_FILES = 2_000
"""So many files are listed at most."""
OWN = ".workbench"
"""The folder, inside that of the models, of what the workbench keeps: recordings, and what was deleted."""


class FileError(Actr3dError):
    """A file cannot be read or written as asked."""

    status = 400


class NoSuchFileError(FileError):
    """There is no such file."""

    status = 404


class ConflictError(FileError):
    """The file is not what who writes it thinks it is."""

    status = 409


@dataclass(frozen=True, kw_only=True)
class ModelFile:
    """A model file."""

    path: str
    """Inside the folder, with slashes."""
    text: str
    version: str
    """Tells one text from another: a hash of the file's bytes."""


class ModelFolder:
    """Reads and writes the model files of a folder.

    Args:
        root: The folder.
    """

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()

    def paths(self) -> list[str]:
        """Returns the paths of all model files, in the order of their names; hidden ones and links that lead out left out."""
        found: list[str] = []
        for path in self._walk(self.root):
            found.append(path.relative_to(self.root).as_posix())
            if len(found) >= MOST_FILES:
                break
        return sorted(found, key=lambda path: (path.count("/"), path))

    def _walk(self, folder: Path) -> Iterator[Path]:
        try:
            inside = sorted(folder.iterdir()) if folder.is_dir() else []
        except OSError:  # which one may not read, or which has gone meanwhile: the others are there all the same
            return
        for path in inside:
            if path.name[0] in "._":
                continue
            if path.is_dir() and not path.is_symlink():
                yield from self._walk(path)
            elif path.suffix == ".py" and path.is_file() and path.resolve().is_relative_to(self.root):
                yield path

    def locate(self, path: str) -> Path:
        """Returns where a path inside the folder is.

        Raises:
            FileError: If it leads out of the folder, is hidden, or is no name of a model file.
        """
        parts = path.split("/")
        if not path or "\0" in path or "\\" in path or len(path.encode("utf-8", "replace")) > 400:
            raise FileError("that is no name of a model file")
        if any(part in ("", ".", "..") or part[0] == "." or len(part.encode("utf-8", "replace")) > 200 for part in parts):
            raise FileError("a model file lies inside the models folder, and no part of its path is hidden")
        if not path.endswith(".py") or any(unicodedata.category(c)[0] == "C" for c in path) or ":" in path:
            raise FileError("a model file's name ends in .py, and has no special characters")
        where = self.root.joinpath(*parts)
        try:
            inside = where.resolve().is_relative_to(self.root)
        except (OSError, RuntimeError):  # links that lead in a circle
            inside = False
        if not inside:
            raise FileError("that leads out of the models folder")
        return where

    def read(self, path: str) -> ModelFile:
        """Reads a model file.

        Raises:
            FileError: If there is no such file, or it is too large or no text.
        """
        where = self._existing(path)
        try:
            if where.stat().st_size > LARGEST:
                raise FileError(f"'{path}' is larger than {LARGEST:,} bytes")
            return ModelFile(path=path, text=read_source(where), version=self.version(where))
        except OSError as error:
            raise FileError(f"cannot read '{path}': {error.strerror}") from None

    @staticmethod
    def version(where: Path) -> str:
        """Returns what tells a file's present text from others."""
        return hashlib.sha256(where.read_bytes()).hexdigest()

    def save(self, path: str, text: str, version: str | None) -> ModelFile:
        """Writes a model file, if it still is what the writer knows.

        Args:
            path: Which.
            text: What is to be in it.
            version: That of the text which this one replaces; None for a new file.

        Raises:
            ConflictError: If there is such a file already, or it has another text than that.
            FileError: If it cannot be written.
        """
        where = self.locate(path)
        data = _encoded(text, self._line_end(where))
        if len(data) > LARGEST:
            raise FileError(f"a model file has no more than {LARGEST:,} bytes")
        now = self.version(where) if where.is_file() else None
        if now != version:
            told = (
                "there is no such file any more" if now is None else "there is such a file already" if version is None else "it has changed"
            )
            raise ConflictError(f"'{path}' was not saved: {told}")
        try:
            if where.exists() and not _writable(where):
                raise FileError(f"cannot write '{path}': it is read-only")
            where.parent.mkdir(parents=True, exist_ok=True)
            self._write(where, data)
        except OSError as error:
            raise FileError(f"cannot write '{path}': {error.strerror}") from None
        return ModelFile(path=path, text=text, version=self.version(where))

    def _line_end(self, where: Path) -> str:
        """Returns how a file's lines end, so that a file from elsewhere keeps its way."""
        with contextlib.suppress(OSError), where.open("rb") as file:
            return "\r\n" if file.readline(LARGEST).endswith(b"\r\n") else "\n"
        return "\n"

    def _write(self, where: Path, data: bytes) -> None:
        """Writes a file as a whole, or not at all."""
        target = where.resolve()  # a link inside the folder stays one
        beside = target.with_name(f".{secrets.token_hex(8)}.tmp")
        try:
            with beside.open("xb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            if target.exists():
                beside.chmod(target.stat().st_mode)
            beside.replace(target)
        finally:
            beside.unlink(missing_ok=True)

    def copy(self, path: str, to: str) -> ModelFile:
        """Writes a copy of a model file under another name.

        Raises:
            FileError: If there is none, or something of the other name already.
        """
        return self.save(to, self.read(path).text, None)

    def rename(self, path: str, to: str) -> ModelFile:
        """Gives a model file another name.

        Raises:
            FileError: If there is none, or something of the other name already.
        """
        where, target = self._existing(path), self.locate(to)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            os.link(where, target, follow_symlinks=False)  # which never replaces what is there
            where.unlink()
        except FileExistsError:
            raise ConflictError(f"there is a '{to}' already") from None
        except OSError as error:
            raise FileError(f"cannot rename '{path}': {error.strerror}") from None
        return self.read(to)

    def delete(self, path: str) -> str:
        """Puts a model file into the trash folder; returns where that is, inside the models folder.

        Raises:
            FileError: If there is none, or it cannot be moved.
        """
        where = self._existing(path)
        trash = self.root / OWN / "trash" / time.strftime("%Y%m%d-%H%M%S")
        target = trash / f"{secrets.token_hex(2)}-{where.name}"
        try:
            trash.mkdir(parents=True, exist_ok=True)
            where.rename(target)
        except OSError as error:
            raise FileError(f"cannot delete '{path}': {error.strerror}") from None
        with contextlib.suppress(OSError):
            if where.parent != self.root:
                where.parent.rmdir()  # only where nothing is left in it
        return target.relative_to(self.root).as_posix()

    def _existing(self, path: str) -> Path:
        where = self.locate(path)
        if not where.is_file():
            raise NoSuchFileError(f"there is no '{path}'")
        return where


def _writable(where: Path) -> bool:
    """Tells whether a file may be written: saving puts another in its place, for which the system asks the folder alone.

    It lets root write everything; a file that nobody may write is left alone by root, too.
    """
    return os.access(where, os.W_OK) and bool(where.stat().st_mode & 0o222)


def _encoded(text: str, line_end: str) -> bytes:
    """Returns a text as it stands in a file, in the encoding that its first lines declare.

    Raises:
        FileError: If that encoding does not have all of its characters, or is unknown.
    """
    try:
        declared, _ = tokenize.detect_encoding(io.BytesIO(text.encode("utf-8")).readline)
        return text.replace("\n", line_end).encode(declared)
    except UnicodeEncodeError as error:
        if 0xD800 <= ord(error.object[error.start]) < 0xE000:
            raise FileError("the text has half characters, which no file can hold") from None
        raise FileError(f"{error.object[error.start]!r} is not in the encoding that the text declares ({error.encoding})") from None
    except (SyntaxError, LookupError) as error:
        raise FileError(f"the text declares an encoding that cannot be used: {error}") from None
