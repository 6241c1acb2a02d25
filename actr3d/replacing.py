"""Writes a file whole: a reader finds either the earlier one or the new one, even if the writer is killed or another one writes it, too."""

from __future__ import annotations

import fcntl
import os
import secrets
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def replacing(target: Path) -> Generator[Path]:
    """Yields the path of a new file beside a file, which it replaces at the end of the block; after an error, nothing changes.

    Args:
        target: The file; it need not exist. If it does, its permissions are kept.

    Raises:
        OSError: If the file cannot be written.
    """
    part = target.with_name(f".{secrets.token_hex(8)}.tmp")
    try:
        yield part
        with part.open("rb") as file:
            os.fsync(file.fileno())
        if target.exists():
            part.chmod(target.stat().st_mode)
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)


def replace_file(target: Path, data: bytes) -> None:
    """Replaces the contents of a file, or makes it.

    Raises:
        OSError: If it cannot be written.
    """
    with replacing(target) as part:
        part.write_bytes(data)


@contextmanager
def locked(target: Path) -> Generator[None]:
    """Lets no other process that calls this change a file during the block, unless the file system has no locks.

    Args:
        target: The file; it need not exist. The lock is a file beside it, which stays.

    Raises:
        OSError: If the file of the lock cannot be made.
    """
    with target.with_name(f".{target.name}.lock").open("wb") as lock:
        with suppress(OSError):
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield
