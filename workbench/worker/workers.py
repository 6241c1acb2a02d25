"""Starts and ends worker processes and receives their exit codes; the server's side of the fork server."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import socket
from contextlib import suppress

from workbench.worker.fork_server import ANSWER, ASK, BORN, DEAD, HALTED, READY
from workbench.worker.messages import FROM_WORKER, LENGTH, LONGEST, FromWorker, Leave, Message, framed
from workbench.worker.spawn import ForkServer, spawn

GRACE = 0.7
"""How long a worker may take to end normally [s]; then it gets SIGTERM."""
MORE_GRACE = 0.4
"""How long after that it is killed [s]. Both together are less than the 2 s that users are promised."""
PRINTED = 8192
"""How much of a worker's other output (not by its model's `print`) is read at a time [bytes]."""
LOST = 1000
"""Exit status of a worker whose real status is unknown because the process from which it was forked has ended."""
NO_MORE = "no worker can be started: the process that starts them has ended"


Output = tuple[asyncio.StreamReader, asyncio.BaseTransport]


class Worker:
    """Holds the server's connection to one worker process.

    Args:
        pid: Its process id, which is also that of its process group.
        reader: Receives its messages.
        writer: Sends messages to it.
        output: What it prints other than by its model's `print`.
    """

    def __init__(self, pid: int, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, output: Output) -> None:
        self.pid = pid
        self.output, self._pipe = output
        self._reader = reader
        self._writer = writer
        self.exit: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        """Its exit code, or the negative number of a signal."""
        self.halted = 0
        """The signal that has stopped (paused) it; 0 if it is not stopped."""

    def send(self, message: Message) -> None:
        """Sends a message; does nothing if the worker is gone."""
        if not self._writer.is_closing():
            self._writer.write(framed(message))

    async def receive(self) -> FromWorker | None:
        """Returns its next message; None if the worker is gone.

        Raises:
            ValueError: If the data is not a valid message, because the model has written to the connection.
        """
        try:
            size = int.from_bytes(await self._reader.readexactly(LENGTH), "big")
            if size > LONGEST:
                raise ValueError(f"a message of {size:,} bytes")
            return FROM_WORKER.decode(await self._reader.readexactly(size))
        except (asyncio.IncompleteReadError, OSError):
            return None

    async def stop(self) -> None:
        """Ends the worker whatever it is doing: asks, then terminates, then kills it and all processes that it has started."""
        self.send(Leave())
        for wait, sign in ((GRACE, signal.SIGTERM), (MORE_GRACE, signal.SIGKILL)):
            if await self._ended(wait):
                break
            self._signal(sign)
        await asyncio.shield(self.exit)
        self.kill()

    def kill(self) -> None:
        """Kills the worker and all processes that its model has started."""
        self._signal(signal.SIGKILL)
        self._writer.close()

    def release(self) -> None:
        """Closes the connections of a worker that has ended."""
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
    """Manages all worker processes of a server.

    Args:
        memory: Maximum memory of each worker's model [MB]; 0 for no limit.
        fork_server: The process from which workers are forked, if it has been started already.
    """

    def __init__(self, memory: int = 0, fork_server: ForkServer | None = None) -> None:
        self.memory = memory
        self._fork_server = fork_server
        self._control: socket.socket | None = None
        self._alive: dict[int, Worker] = {}
        self._early: dict[int, int] = {}
        """Exit statuses of workers that ended before the server knew of them."""
        self._born: asyncio.Queue[int] = asyncio.Queue()
        """The process id of each new worker; the negative number of the error if there is none, or 0 if there are no more."""
        self._ready = asyncio.Event()
        self._launching = asyncio.Lock()
        self._listening: asyncio.Task[None] | None = None
        self._going: asyncio.Task[None] | None = None

    def begin(self) -> None:
        """Listens to the process from which workers are forked, and starts it if necessary."""
        if self._fork_server is None:
            self._fork_server = spawn()
        self._control = self._fork_server.control
        self._born = asyncio.Queue()
        self._listening = asyncio.create_task(self._listen(self._fork_server))
        self._going = asyncio.create_task(self._keep_going(self._fork_server))

    @property
    def ready(self) -> bool:
        """Whether everything that workers need is loaded, so that they start at once."""
        return self._ready.is_set()

    async def launch(self, memory: int | None = None) -> Worker:
        """Starts a new worker.

        Args:
            memory: Maximum memory of its model [MB]; None for the default of this server.

        Raises:
            OSError: If the system has no more processes or files, or no more workers can be started.
        """
        own_end, its_end = socket.socketpair()
        reading, writing = os.pipe()
        # The caller may be cancelled; the new process is registered nevertheless, and ends when its connection is closed.
        birth = asyncio.create_task(self._birth(its_end, writing, self.memory if memory is None else memory))
        try:
            pid = await asyncio.shield(birth)
        except BaseException:
            own_end.close()
            os.close(reading)
            raise
        own_end.setblocking(False)
        reader, writer = await asyncio.open_connection(sock=own_end, limit=1 << 20)
        worker = Worker(pid, reader, writer, await _stream(reading))
        self._alive[pid] = worker
        if pid in self._early:
            worker.exit.set_result(self._early.pop(pid))
        if self._control is None:  # all were ended meanwhile
            self._end_workers()
        return worker

    async def _birth(self, wire: socket.socket, output: int, memory: int) -> int:
        """Requests a new worker with this connection and output, and returns its process id."""
        try:
            async with self._launching:
                await self._ready.wait()
                if self._control is None:
                    raise OSError(NO_MORE)
                socket.send_fds(self._control, [ASK.pack(memory)], [wire.fileno(), output])
                pid = await self._born.get()
        finally:
            wire.close()
            os.close(output)
        if pid <= 0:
            raise OSError(f"no worker can be started: {os.strerror(-pid)}" if pid else NO_MORE)
        return pid

    async def _listen(self, fork_server: ForkServer) -> None:
        loop = asyncio.get_running_loop()
        rest = b""
        with suppress(OSError):  # the connection is reset if a request was left unread
            while data := await loop.sock_recv(fork_server.control, 4096):
                rest += data
                while len(rest) >= ANSWER.size:
                    self._take(*ANSWER.unpack(rest[: ANSWER.size]))
                    rest = rest[ANSWER.size :]
        await self._begin_again(fork_server)

    def _take(self, what: int, pid: int, status: int) -> None:
        """Handles a reply of the process from which workers are forked."""
        if what == READY:
            self._ready.set()
        elif what == BORN:
            self._early.pop(pid, None)  # of an earlier process, if nobody has asked for its status
            self._born.put_nowait(pid)
        elif what == HALTED and pid in self._alive:
            self._alive[pid].halted = status
        elif what == DEAD:
            self._bury(pid, status)

    def _bury(self, pid: int, status: int) -> None:
        worker = self._alive.pop(pid, None)
        if worker is None:
            self._early[pid] = status
        elif not worker.exit.done():
            worker.exit.set_result(status)

    async def _keep_going(self, fork_server: ForkServer) -> None:
        """Sends SIGCONT at intervals to the process from which workers are forked, as a model may have stopped it by a signal."""
        while True:
            await asyncio.sleep(GRACE)
            with suppress(OSError):
                os.kill(fork_server.process.pid, signal.SIGCONT)

    async def _begin_again(self, fork_server: ForkServer) -> None:
        """Starts a new process from which workers are forked after a model has ended the previous one; all runs end with it."""
        if self._going is not None:
            self._going.cancel()
        useful = self._ready.is_set()
        if useful:  # from now on, callers wait for the new process
            self._ready.clear()
            self._born.put_nowait(0)
        else:  # a process that failed to load would fail again
            self._report_end()
        self._end_workers()
        await asyncio.to_thread(fork_server.end)
        if useful:
            self._fork_server = None
            try:
                self.begin()
            except OSError:
                logging.getLogger("workbench").exception("no more workers can be started")
                self._report_end()

    def _end_workers(self) -> None:
        """Kills all workers, without reporting their end."""
        workers = list(self._alive.values())
        self._alive.clear()
        for worker in workers:
            worker.kill()
            if not worker.exit.done():
                worker.exit.set_result(LOST)

    def _report_end(self) -> None:
        """Reports to all callers that wait for a worker that none can be started."""
        self._control = None
        self._ready.set()
        self._born.put_nowait(0)

    async def close(self) -> None:
        """Ends all workers, and the process that has started them."""
        for task in (self._listening, self._going):
            if task is not None:
                task.cancel()
        self._report_end()
        self._end_workers()
        if self._fork_server is not None:
            await asyncio.to_thread(self._fork_server.end)


async def _stream(descriptor: int) -> Output:
    reader = asyncio.StreamReader(limit=PRINTED)
    protocol = asyncio.StreamReaderProtocol(reader)
    transport, _ = await asyncio.get_running_loop().connect_read_pipe(lambda: protocol, os.fdopen(descriptor, "rb", buffering=0))
    return reader, transport
