"""Ends a worker whose model uses more memory than allowed, to protect the server and the machine."""

from __future__ import annotations

import resource
import sys
import threading
import time
from pathlib import Path

from actr3d.runner.before_exit import end_at_once

MODEL_MEMORY = 4_000
"""Default maximum memory of a model in addition to the worker's own at its start [MB]."""
TOO_MUCH_MEMORY = 87
"""Exit code of a worker that has used too much memory."""
EVERY = 0.1
"""Interval between two checks [s]."""
MEGABYTE = 1 << 20


def watch_memory(megabytes: int) -> None:
    """Limits the memory that this process may use in addition to its present use [MB]; 0 for no limit.

    On Linux, the system refuses further memory, which a model sees as `MemoryError`. Other systems ignore such a limit: there, and
    if compiled code gets memory in other ways, the process is ended once it exceeds the limit.
    """
    if not megabytes:
        return
    if sys.platform == "linux":
        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        most = _reserved() + megabytes * MEGABYTE
        resource.setrlimit(resource.RLIMIT_AS, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))
    threading.Thread(target=_watch, args=(peak() + megabytes * MEGABYTE,), name="memory", daemon=True).start()


def relieve() -> None:
    """Lifts the address space limit so that the process can report a `MemoryError`; the process is still ended if it uses too much."""
    if sys.platform == "linux":
        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        resource.setrlimit(resource.RLIMIT_AS, (hard, hard))


def _watch(most: int) -> None:
    """Ends this process once its peak memory exceeds a limit [bytes]."""
    while peak() <= most:
        time.sleep(EVERY)
    end_at_once(TOO_MUCH_MEMORY)


def peak() -> int:
    """Returns the peak memory use of this process [bytes]."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak


def _reserved() -> int:
    """Returns the size of this process's address space [bytes]."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
