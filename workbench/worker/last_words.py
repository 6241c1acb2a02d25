"""Sends what a model has printed before the model ends or stops its own process, as nothing can be sent afterwards."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from functools import wraps
from typing import Any, Final

_ENDING = ((os, ("_exit", "abort", "kill", "killpg", "execv", "execve")), (signal, ("raise_signal", "pthread_kill")))
"""The functions with which a process may end or stop itself."""
end_at_once: Final = os._exit
"""Ends the process without sending anything first."""


def say_before_the_end(say: Callable[[], object]) -> None:
    """Makes every function with which a model may end its process call `say` first.

    Args:
        say: Sends what has not been sent yet.
    """
    for module, names in _ENDING:
        for name in names:
            setattr(module, name, _after(say, getattr(module, name)))


def _after(say: Callable[[], object], end: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(end)
    def say_and_end(*values: Any, **named: Any) -> Any:
        say()
        return end(*values, **named)

    return say_and_end
