"""Starts the process from which workers are forked. It imports no large packages, so that process loads while the server does."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass

PATIENCE = 3.0
"""Time for the fork server to end [s]."""


@dataclass(frozen=True, kw_only=True)
class ForkServer:
    """Holds the server's handle of the process from which workers are forked."""

    process: subprocess.Popen[bytes]
    control: socket.socket
    """The socket for requests to the process, which ends when the socket is closed."""

    def end(self) -> None:
        """Ends the process and all workers; kills it if it has not ended within `PATIENCE`."""
        self.control.close()
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(PATIENCE)
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()


def spawn() -> ForkServer:
    """Starts the process, which then loads in the background."""
    own_end, its_end = socket.socketpair()
    # A fixed hash seed gives all workers the same order of sets, as in `actr3d run`; numpy's threads would
    # not survive a fork, and are of no use here.
    environment = {**os.environ, "PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "workbench.worker.fork_server", str(its_end.fileno())]
    # In a session of its own, it is not interrupted when a user interrupts the server.
    fds = [its_end.fileno()]
    process = subprocess.Popen(command, pass_fds=fds, env=environment, stdin=subprocess.DEVNULL, start_new_session=True)
    its_end.close()
    own_end.setblocking(False)
    return ForkServer(process=process, control=own_end)
