"""The number of processors that a process may use."""

from __future__ import annotations

import os


def processors() -> int:
    """Returns the number of processors that this process may use: a container or a job of a cluster may have fewer than its machine.

    Without Dask, which comes with the packages for experiments, the limits of containers are not known.
    """
    try:
        from dask.system import CPU_COUNT  # takes a while to load
    except ModuleNotFoundError:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return CPU_COUNT
