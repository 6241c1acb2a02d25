"""A worker that cannot be forked is reported, and the others go on; so is the end of the process that forks them."""

from __future__ import annotations

import asyncio
import errno
import os
import socket
import subprocess
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import pytest

from workbench.worker import fork_server, workers
from workbench.worker.fork_server import ANSWER, ASK, BORN, DEAD, READY
from workbench.worker.spawn import ForkServer
from workbench.worker.workers import NO_MORE, Workers


@asynccontextmanager
async def pool() -> AsyncGenerator[tuple[Workers, socket.socket]]:
    """Yields workers, and the other end of their connection to the process that forks them; the test answers in its place."""
    own_end, its_end = socket.socketpair()
    own_end.setblocking(False)
    its_end.setblocking(False)
    there = Workers(fork_server=ForkServer(process=subprocess.Popen(["true"]), control=own_end))
    there.begin()
    its_end.sendall(ANSWER.pack(READY, 1, 0))
    yield there, its_end
    await there.close()
    its_end.close()


async def asked(its_end: socket.socket) -> None:
    """Receives a request for a worker."""
    await asyncio.get_running_loop().sock_recv(its_end, ASK.size)


def test_a_failed_fork_returns_its_error_and_closes_what_was_for_the_worker(monkeypatch: pytest.MonkeyPatch) -> None:
    def fork() -> int:
        raise OSError(errno.EAGAIN, "no more processes")

    monkeypatch.setattr(os, "fork", fork)
    ours, theirs = socket.socketpair()
    reading, writing = os.pipe()
    with ours:
        assert fork_server._born(ours, (-1, -1), [theirs.detach(), writing], 0) == -errno.EAGAIN
        assert ours.recv(1) == b""
    assert os.read(reading, 1) == b""
    os.close(reading)


def test_a_worker_that_cannot_be_forked_is_reported_and_the_next_one_begins() -> None:
    async def told() -> None:
        async with pool() as (there, its_end):
            launch = asyncio.create_task(there.launch())
            await asked(its_end)
            its_end.sendall(ANSWER.pack(BORN, -errno.EAGAIN, 0))
            with pytest.raises(OSError, match=f"no worker can be started: {os.strerror(errno.EAGAIN)}"):
                await launch
            launch = asyncio.create_task(there.launch())
            await asked(its_end)
            its_end.sendall(ANSWER.pack(DEAD, 2**30, 9) + ANSWER.pack(BORN, 2**30, 0))  # an earlier process had the same number
            worker = await launch
            assert not worker.exit.done()
            worker.release()

    asyncio.run(told())


@pytest.mark.parametrize("late", [False, True])
def test_every_worker_has_ended_when_all_are_ended_also_one_that_was_just_born(late: bool) -> None:
    async def ended() -> None:
        async with pool() as (there, its_end):
            launch = asyncio.create_task(there.launch())
            await asked(its_end)
            its_end.sendall(ANSWER.pack(BORN, 2**30, 0))
            if late:
                while there._born.empty():
                    await asyncio.sleep(0)
                await there.close()
            worker = await launch
            await there.close()
            assert await worker.exit == workers.LOST
            worker.release()

    asyncio.run(ended())


@pytest.mark.parametrize("unread", [False, True])
def test_where_no_process_can_fork_workers_any_more_launching_fails(unread: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    def spawn() -> ForkServer:
        raise OSError(errno.ENOMEM, "no memory")

    async def told() -> None:
        async with pool() as (there, its_end):
            launch = asyncio.create_task(there.launch())
            if unread:  # the connection is then reset, not closed
                while not there._launching.locked():
                    await asyncio.sleep(0)
                await asyncio.sleep(0.01)
            else:
                await asked(its_end)
            its_end.close()
            with pytest.raises(OSError, match=NO_MORE):
                await launch
            with pytest.raises(OSError, match=NO_MORE):
                await there.launch()

    monkeypatch.setattr(workers, "spawn", spawn)
    asyncio.run(asyncio.wait_for(told(), 20))
