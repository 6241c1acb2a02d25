"""The number of processors that a process may use."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import suppress
from math import ceil
from pathlib import Path


def processors(root: Path = Path("/")) -> int:
    """Returns the number of processors that this process may use: a container or a job of a cluster may have fewer than its machine.

    Args:
        root: The root of the file system, in which Linux describes the limits of containers.

    Source: `dask.system.cpu_count`, which is there only with the packages for experiments.
    """
    if sys.version_info >= (3, 13):
        usable = os.process_cpu_count()
    else:
        usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    limits = [ceil(quota / period) for quota, period in _quotas(root) if quota > 0]
    return min([usable or 1, *limits])


def _quotas(root: Path) -> Iterator[tuple[int, int]]:
    """Yields the processor time that the container of this process may use in a period, and the period, in the same unit."""
    groups = root / "sys" / "fs" / "cgroup"
    for folder in ("cpuacct,cpu", "cpu,cpuacct"):  # version 1 of control groups
        with suppress(OSError, ValueError):
            quota, period = (int((groups / folder / f"cpu.cfs_{what}_us").read_text()) for what in ("quota", "period"))
            yield quota, period
    with suppress(OSError, ValueError):  # version 2; a group without a limit has the quota `max`
        own = (root / "proc" / "self" / "cgroup").read_text().strip().rpartition(":")[2]
        quota, period = map(int, (groups / own.strip("/") / "cpu.max").read_text().split())
        yield quota, period
