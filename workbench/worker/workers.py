"""Starts and ends worker processes, and hears how they ended; the server's side of the zygote."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
from contextlib import suppress

from workbench.worker.messages import FROM_WORKER, LENGTH, LONGEST, FromWorker, Leave, Message, framed
from workbench.worker.spawn import Zygote, spawn
from workbench.worker.zygote import ANSWER, ASK, BORN, DEAD, HALTED, READY

GRACE = 0.7
"""How long a worker may take to end in good order [s]; then it is told by the system."""
MORE_GRACE = 0.4
"""How long after that until it is killed [s]: in all less than the 2 s that a user is promised."""
PRINTED = 8192
"""So much of what a worker prints past its model's `print` is read at once [bytes]."""
LOST = 1000
"""How a worker ended of which that is not known: the process from which it was forked has been ended."""
NO_MORE = "no worker can be started: the process that starts them has ended"


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
        self.halted = 0
        """The signal that has stopped it, so that it stands still; 0 where it does not."""

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
        zygote: The process from which they are forked, where it has been started already.
    """

    def __init__(self, memory: int = 0, zygote: Zygote | None = None) -> None:
        self.memory = memory
        self._zygote = zygote
        self._control: socket.socket | None = None
        self._alive: dict[int, Worker] = {}
        self._early: dict[int, int] = {}
        """How workers ended of which the server had not heard yet."""
        self._born: asyncio.Queue[int] = asyncio.Queue()
        self._ready = asyncio.Event()
        self._launching = asyncio.Lock()
        self._listening: asyncio.Task[None] | None = None
        self._going: asyncio.Task[None] | None = None

    def begin(self) -> None:
        """Begins to listen to the process from which workers are forked, and starts it where that has not been done."""
        if self._zygote is None:
            self._zygote = spawn()
        self._control = self._zygote.control
        self._ready = asyncio.Event()
        self._born = asyncio.Queue()
        self._listening = asyncio.create_task(self._listen(self._zygote))
        self._going = asyncio.create_task(self._keep_going(self._zygote))

    @property
    def ready(self) -> bool:
        """Whether what workers need has been loaded, so that they begin at once."""
        return self._ready.is_set()

    async def launch(self, memory: int | None = None) -> Worker:
        """Returns a new worker.

        Args:
            memory: How much memory it may take [MB]; None for as much as every model may.

        Raises:
            OSError: If the system has no more processes or files to give, or workers are to come no more.
        """
        ours, theirs = socket.socketpair()
        reading, writing = os.pipe()
        # Who waits may leave; the process that is being born is heard of all the same, and ends where its wire is closed.
        birth = asyncio.create_task(self._birth(theirs, writing, self.memory if memory is None else memory))
        try:
            pid = await asyncio.shield(birth)
        except BaseException:
            ours.close()
            os.close(reading)
            raise
        ours.setblocking(False)
        reader, writer = await asyncio.open_connection(sock=ours, limit=1 << 20)
        worker = Worker(pid, reader, writer, await _stream(reading))
        self._alive[pid] = worker
        if pid in self._early:
            worker.exit.set_result(self._early.pop(pid))
        return worker

    async def _birth(self, wire: socket.socket, output: int, memory: int) -> int:
        """Lets a worker be born that has these; returns its process number."""
        try:
            await self._ready.wait()
            async with self._launching:
                if self._control is None:
                    raise OSError(NO_MORE)
                socket.send_fds(self._control, [ASK.pack(memory)], [wire.fileno(), output])
                pid = await self._born.get()
        finally:
            wire.close()
            os.close(output)
        if pid < 0:
            raise OSError(NO_MORE)
        return pid

    async def _listen(self, zygote: Zygote) -> None:
        loop = asyncio.get_running_loop()
        rest = b""
        while data := await loop.sock_recv(zygote.control, 4096):
            rest += data
            while len(rest) >= ANSWER.size:
                what, pid, status = ANSWER.unpack(rest[: ANSWER.size])
                rest = rest[ANSWER.size :]
                if what == READY:
                    self._ready.set()
                elif what == BORN:
                    self._born.put_nowait(pid)
                elif what == HALTED and pid in self._alive:
                    self._alive[pid].halted = status
                elif what == DEAD:
                    self._bury(pid, status)
        await self._begin_again(zygote)

    def _bury(self, pid: int, status: int) -> None:
        worker = self._alive.pop(pid, None)
        if worker is None:
            self._early[pid] = status
        elif not worker.exit.done():
            worker.exit.set_result(status)

    async def _keep_going(self, zygote: Zygote) -> None:
        """Lets the process from which workers are forked go on, now and then: a model may have stopped it by a signal."""
        while True:
            await asyncio.sleep(GRACE)
            with suppress(OSError):
                os.kill(zygote.process.pid, signal.SIGCONT)

    async def _begin_again(self, zygote: Zygote) -> None:
        """Starts another process from which workers are forked, as a model has ended this one; runs end with it."""
        if self._going is not None:
            self._going.cancel()
        useful = self._ready.is_set()
        self._say_ended()
        workers = list(self._alive.values())
        self._alive.clear()
        for worker in workers:
            worker.kill()
            if not worker.exit.done():
                worker.exit.set_result(LOST)
        await asyncio.to_thread(zygote.end)
        if useful:  # one that cannot even load would not load again
            self._zygote = None
            self.begin()

    def _say_ended(self) -> None:
        """Lets those know who wait for a worker that none will come."""
        self._control = None
        self._ready.set()
        self._born.put_nowait(-1)

    async def close(self) -> None:
        """Ends all workers, and the process that has started them."""
        for task in (self._listening, self._going):
            if task is not None:
                task.cancel()
        for worker in list(self._alive.values()):
            worker.kill()
        self._say_ended()
        if self._zygote is not None:
            await asyncio.to_thread(self._zygote.end)


async def _stream(descriptor: int) -> Output:
    reader = asyncio.StreamReader(limit=PRINTED)
    protocol = asyncio.StreamReaderProtocol(reader)
    transport, _ = await asyncio.get_running_loop().connect_read_pipe(lambda: protocol, os.fdopen(descriptor, "rb", buffering=0))
    return reader, transport
