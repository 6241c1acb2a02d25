"""A disk without room, for some processes."""

from __future__ import annotations

import resource
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager


@contextmanager
def full_disk(processes: Callable[[], Iterable[int]], room: int = 1) -> Generator[None]:
    """Lets no file of some processes grow beyond a size, as on a full disk.

    Args:
        processes: Returns their numbers; it is called again at the end, for those that have begun since.
        room: The size [bytes].
    """
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    for process in processes():
        resource.prlimit(process, resource.RLIMIT_FSIZE, (room, limits[1]))
    try:
        yield
    finally:
        for process in processes():
            resource.prlimit(process, resource.RLIMIT_FSIZE, limits)
