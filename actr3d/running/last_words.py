"""Keeps what a model has done before the model ends or stops its own process, as nothing can be kept afterwards."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Generator
from contextlib import contextmanager, suppress
from functools import wraps
from typing import Any, Final

_ENDS = ((os, ("_exit", "abort", "execv", "execve")),)
"""The functions that end the model's program."""
_MAY_END = ((os, ("kill", "killpg")), (signal, ("raise_signal", "pthread_kill")))
"""The functions that may end or stop it, or do something else."""
end_at_once: Final = os._exit
"""Ends the process without keeping anything first."""


@contextmanager
def before_the_end(keep: Callable[[bool], object]) -> Generator[None]:
    """Makes every function with which a model may end its process call `keep` first, inside the block.

    Only in this process: a forked copy of it has nothing to keep. What ends the process from outside, or in compiled code, is not noticed.

    Args:
        keep: Writes or sends everything so far; called with whether the program surely ends now. Its errors are ignored.
    """
    process = os.getpid()
    before: list[tuple[Any, str, Any]] = []
    for functions, ends in ((_ENDS, True), (_MAY_END, False)):
        for module, names in functions:
            for name in names:
                before.append((module, name, getattr(module, name)))
                setattr(module, name, _after(keep, ends, process, getattr(module, name)))
    try:
        yield
    finally:
        for module, name, function in before:
            setattr(module, name, function)


def _after(keep: Callable[[bool], object], ends: bool, process: int, function: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(function)
    def keep_and_end(*values: Any, **named: Any) -> Any:
        if os.getpid() == process:
            with suppress(Exception):
                keep(ends)
        return function(*values, **named)

    return keep_and_end
