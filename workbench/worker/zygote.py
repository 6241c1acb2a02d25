"""The process from which workers are forked: it has everything loaded, so that a run begins within milliseconds.

It is told by its own socket: each message has two file descriptors, the wire and the output of a new worker, and how much
memory that may take. It answers with the worker's process number, and later with how that ended. When the server is gone
it ends all workers, and itself.
"""

from __future__ import annotations

import gc
import os
import select
import signal
import socket
import struct
import sys
import time
from contextlib import suppress

from workbench.worker.orphans import adopt, end_orphans

ANSWER = struct.Struct("!Bqi")
"""What is told (BORN, DEAD, HALTED or READY), the process number, and of a dead one its status as `os.waitstatus_to_exitcode` gives it,
of one that stands still the signal that has stopped it; 0 where it goes on again."""
BORN, DEAD, READY, HALTED = 1, 2, 3, 4
ASK = struct.Struct("!i")
"""How much memory a new worker may take [MB]."""
FAREWELL = 1.0
"""So long it takes at most to see its workers end [s]."""


def main(number: int) -> None:
    """Serves until the server is gone.

    Args:
        number: The file descriptor of the socket to the server.
    """
    gc.disable()  # nothing that is loaded is garbage
    import workbench.worker.preload  # pyright: ignore[reportUnusedImport] # noqa: F401

    gc.enable()
    adopt()
    control = socket.socket(fileno=number)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    woken, wake = os.pipe()
    os.set_blocking(wake, False)
    os.set_blocking(woken, False)
    signal.signal(signal.SIGCHLD, _woken)
    signal.set_wakeup_fd(wake)
    gc.collect()
    gc.freeze()
    _answer(control, READY, os.getpid(), 0)
    children: set[int] = set()
    while True:
        ready, _, _ = select.select([control, woken], [], [])
        if woken in ready:
            with suppress(BlockingIOError):
                os.read(woken, 4096)
            _bury(control, children)
        if control not in ready:
            continue
        try:
            data, descriptors, _, _ = socket.recv_fds(control, ASK.size, 2)
        except ConnectionError:
            break
        if not data:
            break
        pid = _born(control, (woken, wake), descriptors, ASK.unpack(data)[0])
        children.add(pid)
        _answer(control, BORN, pid, 0)
    _end_all(control, children)


def _end_all(control: socket.socket, children: set[int]) -> None:
    """Ends all workers, and what they leave behind; for a moment only, as nobody is left who waits for it."""
    for pid in children:
        with suppress(OSError):
            os.killpg(pid, signal.SIGKILL)
    end = time.monotonic() + FAREWELL
    while time.monotonic() < end:
        _bury(control, children)
        if not children:
            time.sleep(0.01)  # for those whom the last one has left
            end_orphans(children)
            return
        time.sleep(0.005)


def _answer(control: socket.socket, *what: int) -> None:
    """Tells the server something; that it is gone is found out where it is heard next."""
    with suppress(OSError):
        control.sendall(ANSWER.pack(*what))


def _born(control: socket.socket, pipe: tuple[int, int], descriptors: list[int], memory: int) -> int:
    """Forks a worker, and returns its process number; in the worker it does not return."""
    from workbench.worker.entry import main as work

    pid = os.fork()
    if pid == 0:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        for descriptor in pipe:
            os.close(descriptor)
        control.close()
        wire, output = descriptors
        try:
            work(socket.socket(fileno=wire), output, memory)
        finally:
            os._exit(1)  # it has ended by itself, unless it could not even do that
    for descriptor in descriptors:
        os.close(descriptor)
    return pid


def _woken(_: int, __: object) -> None:
    """Does nothing: that a signal came is read from the pipe."""


def _bury(control: socket.socket, children: set[int]) -> None:
    """Tells the server of the children that have died, and of those that a signal has stopped."""
    for pid in list(children):
        with suppress(ChildProcessError):
            done, status = os.waitpid(pid, os.WNOHANG | os.WUNTRACED | os.WCONTINUED)
            if done and (os.WIFSTOPPED(status) or os.WIFCONTINUED(status)):
                _answer(control, HALTED, pid, os.WSTOPSIG(status) if os.WIFSTOPPED(status) else 0)
            elif done:
                children.discard(pid)
                with suppress(OSError):
                    os.killpg(pid, signal.SIGKILL)  # whom it has left in its group
                _answer(control, DEAD, pid, os.waitstatus_to_exitcode(status))
    end_orphans(children)


if __name__ == "__main__":
    main(int(sys.argv[1]))
