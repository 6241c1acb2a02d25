"""Starts a worker process: sets its limits and output, runs its one job, and reports a failure."""

from __future__ import annotations

import faulthandler
import io
import os
import signal
import socket
import sys
import traceback
import warnings
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, NoReturn

from actr3d.actr.kernel.run_limits import EndOfRun
from actr3d.actr.loading.source_text import compile_source
from actr3d.output import ModelOutput
from actr3d.runner.before_exit import before_the_end, end_at_once
from actr3d.runner.build_check import check_build
from workbench.loader import listing_of
from workbench.worker.channel import Channel
from workbench.worker.error_report import notice_of
from workbench.worker.memory import watch_memory
from workbench.worker.messages import MAX_PRINTED, WorkerEnded, notice
from workbench.worker.orphans import adopt
from workbench.worker.run_controller import RunController


def main(wire: socket.socket, output: int, memory: int) -> None:
    """Runs one job for the server.

    Args:
        wire: The socket to the server.
        output: The file descriptor for everything that the process prints other than by the model's `print`.
        memory: Maximum memory that the model may use in addition to the worker's own [MB]; 0 for no limit.
    """
    _settle(output)
    adopt()
    watch_memory(memory)
    channel = Channel(wire)
    os.register_at_fork(after_in_child=channel.leave)
    os.register_at_fork(after_in_child=_PAST_PRINT.open)
    controller = RunController(channel)
    errors = controller.errors = sys.stderr = sys.__stderr__ = _errors(channel, controller)  # type: ignore[misc]
    os.register_at_fork(after_in_child=errors.lines.forget)
    warnings.simplefilter("default")
    warnings.showwarning = partial(_send_warning, channel)
    try:
        with before_the_end(controller.send_all):
            _run(channel, controller)
    except EndOfRun:
        pass
    except BaseException as error:  # noqa: BLE001 - a model may also end with SystemExit
        if channel.left:
            _leave_copy(error)
        channel.post(notice_of(error))
    errors.finish()
    channel.post(WorkerEnded())
    channel.flush()
    with suppress(OSError):
        wire.shutdown(socket.SHUT_WR)
    end_at_once(0)  # threads left behind by the model must not keep the process alive


def _errors(channel: Channel, controller: RunController) -> ModelOutput:
    """Returns a `sys.stderr` whose lines are notices at the moment of the run at which they are written; each is sent once."""
    count = 0

    def take(line: str) -> None:
        nonlocal count
        if channel.left:  # a forked copy of the process sends nothing; its output goes the way of other processes
            with suppress(OSError):
                os.write(2, f"{line}\n".encode(errors="replace"))
        elif line.strip() and not controller.catches_up:
            count += 1
            if count <= MAX_PRINTED:
                channel.post(notice("info", line.rstrip()))
            elif count == MAX_PRINTED + 1:
                channel.post(notice("warning", "the model writes much more to its standard error; that is left out"))

    return ModelOutput(take, 2)


def _leave_copy(error: BaseException) -> NoReturn:
    """Ends a forked copy of the process that the model has made, as Python would end it."""
    code = error.code if isinstance(error, SystemExit) else 1
    with suppress(OSError, ValueError):
        sys.stdout.flush()
        if not isinstance(error, SystemExit):
            traceback.print_exception(error)
        elif code is not None and not isinstance(code, int):
            sys.stderr.write(f"{code}\n")
    end_at_once(0 if code is None else code & 0xFF if isinstance(code, int) else 1)


def _run(channel: Channel, controller: RunController) -> None:
    start = channel.start
    if start.job in ("replay", "make", "list"):
        from workbench.worker import recorded

        {"replay": recorded.replay_again, "make": recorded.make, "list": recorded.summarize}[start.job](channel)
        return
    if start.job == "language":
        from workbench.language.language_worker import serve

        serve(channel)
        return
    compile_source(start.source, start.path)  # errors in the text are reported before anything else
    check_build(start.source, start.path)
    listing = listing_of(start.source, start.path)
    if start.job == "check":
        if listing.kind == "simulation":
            from workbench.worker.simulation_run import check

            check(start.source, start.path, Path(start.folder))
    elif listing.kind == "simulation":
        from workbench.worker.simulation_run import SimulationRun

        SimulationRun(controller, listing).play()
    else:
        from workbench.worker.program_run import ProgramRun

        ProgramRun(controller, listing).play()


def _settle(output: int) -> None:
    """Detaches the process: no terminal, no keyboard, its own process group."""
    with suppress(OSError):
        os.setsid()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    nothing = os.open(os.devnull, os.O_RDWR)
    os.dup2(nothing, 0)
    os.dup2(output, 1)
    os.dup2(output, 2)
    os.close(nothing)
    if output > 2:
        os.close(output)
    sys.stdin = Path(os.devnull).open(encoding="utf-8")  # noqa: SIM115 - it stays open
    # The model's `print` is recorded as events; these streams are for output that bypasses it.
    sys.stdout = sys.__stdout__ = io.TextIOWrapper(_PAST_PRINT, encoding="utf-8", errors="replace", write_through=True)  # type: ignore[misc]
    sys.stderr = sys.__stderr__ = io.TextIOWrapper(io.FileIO(2, "w", closefd=False), encoding="utf-8", errors="replace", write_through=True)  # type: ignore[misc]
    faulthandler.enable(file=2)


class _PastPrint(io.RawIOBase):
    """Discards what the model prints, because it is already recorded as events. A forked copy of the process sends no events; there, the
    output is passed on as other output, line by line.
    """

    def __init__(self) -> None:
        self._rest: bytes | None = None
        """The beginning of an unfinished line; None if output is discarded."""

    def open(self) -> None:
        """Passes output on from now on."""
        self._rest = b""

    def writable(self) -> bool:
        return True

    def write(self, data: Any, /) -> int:
        if self._rest is not None:
            lines, end, rest = bytes(data).rpartition(b"\n")
            if end:
                self._pass_on(self._rest + lines + end)
                self._rest = rest
            else:
                self._rest += rest
        return len(data)

    def flush(self) -> None:
        if self._rest:
            rest, self._rest = self._rest, b""
            self._pass_on(rest + b"\n")  # passed on as a complete line

    def _pass_on(self, data: bytes) -> None:
        with suppress(OSError):  # the model may have closed the file
            while data:
                data = data[os.write(1, data) :]


_PAST_PRINT = _PastPrint()


def _send_warning(channel: Channel, message: Warning | str, _: type[Warning], filename: str, lineno: int, *__: Any) -> None:
    """Sends a warning to the server, in place of `warnings.showwarning`."""
    channel.post(notice("warning", str(message), filename, lineno))
