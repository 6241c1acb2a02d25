"""Starts and ends worker processes, and hears how they ended; the server's side of the zygote."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
import subprocess
import sys
from contextlib import suppress

from workbench.worker.messages import FROM_WORKER, LENGTH, LONGEST, FromWorker, Leave, Message, framed
from workbench.worker.zygote import ANSWER, ASK, BORN, READY

GRACE = 0.7
"""How long a worker may take to end in good order [s]; then it is told by the system."""
MORE_GRACE = 0.4
"""How long after that until it is killed [s]: in all less than the 2 s that a user is promised."""
PRINTED = 8192
"""So much of what a worker prints past its model's `print` is read at once [bytes]."""


Output = tuple[asyncio.StreamReader, asyncio.BaseTransport]


class Worker:
    """One worker process, as the server has it.

    Args:
        pid: Its process number, which is that of its group, too.
        reader: What it says.
        writer: Where it is told things.
        output: What it prints past its model's `print`.
    """

    def __init__(self, pid: int, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, output: Output) -> None:
        self.pid = pid
        self.output, self._pipe = output
        self._reader = reader
        self._writer = writer
        self.exit: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        """How it ended: its exit code, or the negative number of a signal."""

    def send(self, message: Message) -> None:
        """Tells it something; nothing, where it is gone."""
        if not self._writer.is_closing():
            self._writer.write(framed(message))

    async def receive(self) -> FromWorker | None:
        """Returns what it says next; None where it is gone.

        Raises:
            ValueError: If it says what is no message: the model has written to its wire.
        """
        try:
            size = int.from_bytes(await self._reader.readexactly(LENGTH), "big")
            if size > LONGEST:
                raise ValueError(f"a message of {size:,} bytes")
            return FROM_WORKER.decode(await self._reader.readexactly(size))
        except (asyncio.IncompleteReadError, OSError):
            return None

    async def stop(self) -> None:
        """Ends it, whatever it does: asks, then terminates, then kills it and all that it has started."""
        self.send(Leave())
        for wait, sign in ((GRACE, signal.SIGTERM), (MORE_GRACE, signal.SIGKILL)):
            if await self._ended(wait):
                break
            self._signal(sign)
        await asyncio.shield(self.exit)
        self.kill()

    def kill(self) -> None:
        """Ends it at once, and all processes that its model has started."""
        self._signal(signal.SIGKILL)
        self._writer.close()

    def release(self) -> None:
        """Lets go of what it was spoken to by; it is gone."""
        self._writer.close()
        self._pipe.close()

    async def _ended(self, wait: float) -> bool:
        with suppress(TimeoutError):
            await asyncio.wait_for(asyncio.shield(self.exit), wait)
        return self.exit.done()

    def _signal(self, sign: signal.Signals) -> None:
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self.pid, sign)


class Workers:
    """All worker processes of a server.

    Args:
        memory: How much memory each may take [MB]; 0 for no limit.
    """

    def __init__(self, memory: int = 0) -> None:
        self.memory = memory
        self._zygote: subprocess.Popen[bytes] | None = None
        self._control: socket.socket | None = None
        self._alive: dict[int, Worker] = {}
        self._early: dict[int, int] = {}
        """How workers ended of which the server had not heard yet."""
        self._born: asyncio.Queue[int] = asyncio.Queue()
        self._ready = asyncio.Event()
        self._launching = asyncio.Lock()
        self._listening: asyncio.Task[None] | None = None

    def begin(self) -> None:
        """Starts the process from which workers are forked; it loads meanwhile."""
        ours, theirs = socket.socketpair()
        # Whoever is started by it goes through sets in the same order each time, as `actr3d run` does; numpy's threads would
        # not outlive a fork, and are of no use here.
        environment = {**os.environ, "PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1"}
        command = [sys.executable, "-m", "workbench.worker.zygote", str(theirs.fileno())]
        self._zygote = subprocess.Popen(command, pass_fds=[theirs.fileno()], env=environment, stdin=subprocess.DEVNULL)
        theirs.close()
        ours.setblocking(False)
        self._control = ours
        self._listening = asyncio.create_task(self._listen(ours))

    async def launch(self) -> Worker:
        """Returns a new worker.

        Raises:
            OSError: If the system has no more processes or files to give.
        """
        await self._ready.wait()
        if self._control is None:
            raise OSError("no worker can be started: the process that starts them has ended")
        ours, theirs = socket.socketpair()
        reading, writing = os.pipe()
        try:
            async with self._launching:
                socket.send_fds(self._control, [ASK.pack(self.memory)], [theirs.fileno(), writing])
                pid = await self._born.get()
        finally:
            theirs.close()
            os.close(writing)
        if pid < 0:
            ours.close()
            os.close(reading)
            raise OSError("no worker can be started: the process that starts them has ended")
        ours.setblocking(False)
        reader, writer = await asyncio.open_connection(sock=ours, limit=1 << 20)
        worker = Worker(pid, reader, writer, await _stream(reading))
        self._alive[pid] = worker
        if pid in self._early:
            worker.exit.set_result(self._early.pop(pid))
        return worker

    async def _listen(self, control: socket.socket) -> None:
        loop = asyncio.get_running_loop()
        rest = b""
        while data := await loop.sock_recv(control, 4096):
            rest += data
            while len(rest) >= ANSWER.size:
                what, pid, status = ANSWER.unpack(rest[: ANSWER.size])
                rest = rest[ANSWER.size :]
                if what == READY:
                    self._ready.set()
                elif what == BORN:
                    self._born.put_nowait(pid)
                elif (worker := self._alive.pop(pid, None)) is not None:
                    if not worker.exit.done():
                        worker.exit.set_result(status)
                else:
                    self._early[pid] = status
        self._control = None
        self._ready.set()
        self._born.put_nowait(-1)
        for worker in self._alive.values():
            if not worker.exit.done():
                worker.exit.set_result(-signal.SIGKILL)

    async def close(self) -> None:
        """Ends all workers, and the process that has started them."""
        if self._listening is not None:
            self._listening.cancel()
        for worker in list(self._alive.values()):
            worker.kill()
        if self._control is not None:
            self._control.close()
        if self._zygote is not None:
            with suppress(subprocess.TimeoutExpired):
                await asyncio.to_thread(self._zygote.wait, 3)
            if self._zygote.poll() is None:
                self._zygote.kill()
                await asyncio.to_thread(self._zygote.wait)


async def _stream(descriptor: int) -> Output:
    reader = asyncio.StreamReader(limit=PRINTED)
    protocol = asyncio.StreamReaderProtocol(reader)
    transport, _ = await asyncio.get_running_loop().connect_read_pipe(lambda: protocol, os.fdopen(descriptor, "rb", buffering=0))
    return reader, transport
