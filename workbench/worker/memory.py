"""Ends a worker whose model takes more memory than it may, so that neither the server nor the machine suffers."""

from __future__ import annotations

import resource
import sys
import threading
import time
from pathlib import Path

from workbench.worker.last_words import end_at_once

TOO_MUCH_MEMORY = 87
"""With this exit code a worker ends that has taken too much."""
EVERY = 0.1
"""How often it is looked [s]."""
MEGABYTE = 1 << 20


def watch_memory(megabytes: int) -> None:
    """Sees to it that this process takes no more memory than so much beyond what it has [MB]; 0 for no limit.

    On Linux the system refuses more, which a model sees as `MemoryError`. Other systems take no notice of such a limit: there,
    and where compiled code takes memory in other ways, the process is ended when it has too much.
    """
    if not megabytes:
        return
    if sys.platform == "linux":
        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        most = _reserved() + megabytes * MEGABYTE
        resource.setrlimit(resource.RLIMIT_AS, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))
    threading.Thread(target=_watch, args=(peak() + megabytes * MEGABYTE,), name="memory", daemon=True).start()


def relieve() -> None:
    """Lets this process have memory to tell what has happened, once it was refused some; it still ends where it takes too much."""
    if sys.platform == "linux":
        _, hard = resource.getrlimit(resource.RLIMIT_AS)
        resource.setrlimit(resource.RLIMIT_AS, (hard, hard))


def _watch(most: int) -> None:
    """Ends this process once it has had more memory [bytes]."""
    while peak() <= most:
        time.sleep(EVERY)
    end_at_once(TOO_MUCH_MEMORY)


def peak() -> int:
    """Returns how much memory this process has had at most [bytes]."""
    told = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return told if sys.platform == "darwin" else 1024 * told


def _reserved() -> int:
    """Returns how much of its address space this process has taken [bytes]."""
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
