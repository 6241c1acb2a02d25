"""Starts the process from which workers are forked. It imports nothing of weight, so that this process loads while the server does."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass

MEMORY = 4_000
"""How much memory a model may take beyond what a worker has at its start [MB], unless told otherwise."""


@dataclass(frozen=True, kw_only=True)
class Zygote:
    """The process, as the server has it."""

    process: subprocess.Popen[bytes]
    control: socket.socket
    """Where it is told what to do; it ends where this is closed."""

    def end(self, wait: float = 3.0) -> None:
        """Ends it, and with it all workers; waits for it so long at most [s] before it is killed."""
        self.control.close()
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(wait)
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()


def spawn() -> Zygote:
    """Starts it; it loads meanwhile."""
    ours, theirs = socket.socketpair()
    # Whoever is started by it goes through sets in the same order each time, as `actr3d run` does; numpy's threads would
    # not outlive a fork, and are of no use here.
    environment = {**os.environ, "PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "workbench.worker.zygote", str(theirs.fileno())]
    # In a session of its own it is not interrupted where a user interrupts the server.
    fds = [theirs.fileno()]
    process = subprocess.Popen(command, pass_fds=fds, env=environment, stdin=subprocess.DEVNULL, start_new_session=True)
    theirs.close()
    ours.setblocking(False)
    return Zygote(process=process, control=ours)
