"""Ends processes that a model has left behind: this process adopts and kills them. On Linux only."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Container
from contextlib import suppress
from pathlib import Path

PR_SET_CHILD_SUBREAPER = 36
"""Source: prctl(2)."""


def adopt() -> None:
    """Makes this process the parent of orphaned descendants, instead of the system's first process; this includes daemons."""
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def end_orphans(known: Container[int]) -> None:
    """Ends all children of this process that are not in `known`; their own children follow at the next call."""
    for pid in _children() if sys.platform == "linux" else ():
        if pid not in known:
            with suppress(OSError):
                os.kill(pid, signal.SIGKILL)
            with suppress(OSError):
                os.waitpid(pid, os.WNOHANG)


def _children() -> list[int]:
    """Returns the child processes of this process, started by any thread."""
    found: list[int] = []
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            # After the name, which may contain any character: the state, and the parent's number.
            if int((folder / "stat").read_bytes().rpartition(b")")[2].split()[1]) == os.getpid():
                found.append(int(folder.name))
    return found
