"""Keeps what a model has done before the model ends or stops its own process, as nothing can be kept afterwards."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Generator
from contextlib import contextmanager, suppress
from functools import wraps
from typing import Any, Final

_NOT_FATAL = {"SIGCHLD", "SIGURG", "SIGWINCH", "SIGCONT", "SIGSTOP", "SIGTSTP", "SIGTTIN", "SIGTTOU", "SIGIO", "SIGINFO"}
"""The signals that do not end a process which does not handle them."""


def _starts_another(path: Any, *_: Any, **__: Any) -> bool | None:
    """Returns whether `exec` ends the program; None if it fails, because there is no such program."""
    return True if os.path.isfile(path) and os.access(path, os.X_OK) else None  # noqa: PTH113 - the path may be bytes or a number


def _raises(number: int) -> bool:
    """Returns whether a signal surely ends this process."""
    default = number == signal.SIGKILL or signal.getsignal(number) == signal.SIG_DFL
    return default and signal_name(number) not in _NOT_FATAL


def signal_name(number: int) -> str:
    """Returns the name of a signal."""
    return signal.Signals(number).name if number in set(signal.Signals) else f"signal {number}"


def how_it_ended(status: int) -> str:
    """Returns how a process ended: «ended with exit code 1», «was ended by SIGKILL».

    Args:
        status: Its exit code, or the negative number of a signal.
    """
    return f"ended with exit code {status}" if status >= 0 else f"was ended by {signal_name(-status)}"


def _kills(process: int, number: int) -> bool:
    return process == os.getpid() and _raises(number)


_ENDS: tuple[tuple[Any, str, Callable[..., bool | None]], ...] = (
    (os, "_exit", lambda *_, **__: True),
    (os, "abort", lambda *_, **__: True),
    (os, "execv", _starts_another),
    (os, "execve", _starts_another),
    (os, "kill", _kills),
    (os, "killpg", lambda *_, **__: False),
    (signal, "raise_signal", _raises),
    (signal, "pthread_kill", lambda *_, **__: False),
    (os, "closerange", lambda *_, **__: False),
)
"""The functions with which a model ends its process, or closes what it is recorded with; and for each, whether a call surely ends it."""
end_at_once: Final = os._exit
"""Ends the process without keeping anything first."""


@contextmanager
def before_the_end(keep: Callable[[bool], object]) -> Generator[None]:
    """Makes every function with which a model may end its process call `keep` first, inside the block.

    Only in this process: a forked copy of it has nothing to keep. What ends the process from outside, or in compiled code, is not noticed.

    Args:
        keep: Writes or sends what has been done until now; called with whether the program surely ends now. Its errors are ignored.
    """
    process = os.getpid()
    before = [(module, name, getattr(module, name)) for module, name, _ in _ENDS]
    for module, name, ends in _ENDS:
        setattr(module, name, _after(keep, ends, process, getattr(module, name)))
    try:
        yield
    finally:
        for module, name, function in before:
            setattr(module, name, function)


def _after(
    keep: Callable[[bool], object], ends: Callable[..., bool | None], process: int, function: Callable[..., Any]
) -> Callable[..., Any]:
    @wraps(function)
    def keep_and_end(*values: Any, **named: Any) -> Any:
        if os.getpid() == process:
            with suppress(Exception):
                does_end = ends(*values, **named)
                if does_end is not None:
                    keep(does_end)
        return function(*values, **named)

    return keep_and_end
