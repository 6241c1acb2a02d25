"""Forked copies of the process: a recording, or a comparison with one, works only in the process that has created it."""

from __future__ import annotations

import os
from typing import Protocol
from weakref import WeakSet


class Detachable(Protocol):
    """Something that a forked copy of the process must not use."""

    def detach(self) -> None:
        """Makes all further calls do nothing. It is called in the copy, where other threads may have held locks."""
        ...


_DETACHED_IN_COPIES: WeakSet[Detachable] = WeakSet()


def detach_in_copies(thing: Detachable) -> None:
    """Detaches an object in every copy of the process that is forked later."""
    _DETACHED_IN_COPIES.add(thing)


def _detach_all() -> None:
    for thing in list(_DETACHED_IN_COPIES):
        thing.detach()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_detach_all)
