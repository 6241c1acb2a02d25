"""Folders with other permissions."""

from __future__ import annotations

import os
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def not_writable(folder: Path) -> Generator[None]:
    """Makes a folder read-only inside the block. Root could still write there, so it becomes another user for the block."""
    for path in (*folder.iterdir(), folder):
        path.chmod(0o555 if path.is_dir() else 0o444)
    was = os.geteuid()
    try:
        if was == 0:
            os.seteuid(65_534)
        yield
    finally:
        if was == 0:
            os.seteuid(0)
        folder.chmod(0o755)
