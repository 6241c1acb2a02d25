"""Writes files whole: a reader finds all of a file or nothing of it, even if the writer is killed or another one writes it, too."""

from __future__ import annotations

import errno
import fcntl
import os
import re
import secrets
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path

UNFINISHED = re.compile(r"\.[0-9a-f]{16}\.tmp")
"""The names of files that are not finished; a killed process leaves them."""


NO_LINKS = (errno.EPERM, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS)
"""The errors of a file system that has no hard links, such as that of many USB sticks."""


@contextmanager
def replacing(target: Path) -> Generator[Path]:
    """Yields the path of a new file beside a file, which it replaces at the end of the block; after an error, nothing changes.

    Args:
        target: The file; it need not exist. If it does, its permissions are kept.

    Raises:
        OSError: If the file cannot be written.
    """
    with _unfinished(target) as part:
        yield part
        _sync(part)
        if target.exists():
            part.chmod(target.stat().st_mode)
        part.replace(target)


@contextmanager
def creating(target: Path) -> Generator[Path]:
    """Yields the path of a new file, which gets its name at the end of the block; after an error, or if the name is taken, nothing changes.

    Args:
        target: The file, which must not exist.

    Raises:
        FileExistsError: If it exists, also if another process has made it meanwhile.
        OSError: If the file cannot be written.
    """
    if target.exists():
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(target))
    with _unfinished(target) as part:
        yield part
        _sync(part)
        try:
            os.link(part, target)  # unlike a rename, this never replaces a file
        except OSError as error:
            if error.errno not in NO_LINKS:
                raise
            target.open("xb").close()
            part.replace(target)


@contextmanager
def _unfinished(target: Path) -> Generator[Path]:
    """Yields the path for an unfinished file beside a file, and deletes it at the end of the block."""
    part = target.with_name(f".{secrets.token_hex(8)}.tmp")
    try:
        yield part
    finally:
        part.unlink(missing_ok=True)


def _sync(file: Path) -> None:
    """Waits until the contents of a file are on the disk."""
    with file.open("rb") as opened:
        os.fsync(opened.fileno())


def replace_file(target: Path, data: bytes) -> None:
    """Replaces the contents of a file, or makes it.

    Raises:
        OSError: If it cannot be written.
    """
    with replacing(target) as part:
        part.write_bytes(data)


@contextmanager
def locked(target: Path) -> Generator[None]:
    """Locks a file against other processes that call this, inside the block, unless the file system has no locks.

    Args:
        target: The file; it need not exist. The lock is a file beside it, which stays.

    Raises:
        OSError: If the file of the lock cannot be made.
    """
    with target.with_name(f".{target.name}.lock").open("wb") as lock:
        with suppress(OSError):
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield
