"""Replays a recording in a separate process: what the recorded program prints, or how it ends, cannot be mistaken for the verdict.

A program that is written to deceive can still find the file of the verdict: a verdict is only as trustworthy as the program.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from actr3d.errors import Actr3dError, UntrustedError
from actr3d.recording import Recorded
from actr3d.runner.before_exit import how_it_ended
from actr3d.runner.replayable import check_replayable
from actr3d.runner.traceback_report import traceback_report

T = TypeVar("T")
AGREES, DIFFERS, UNKNOWN = 0, 1, 2
"""The exit codes of a replay."""
_CHILD = """
import json, sys
order = json.loads(sys.argv[1])
sys.path[:] = order.pop("path")
try:
    from actr3d.runner.replay_process import write_result
    write_result(**order)
except KeyboardInterrupt:
    sys.exit(130)
"""


@dataclass(frozen=True, kw_only=True)
class ReplayResult:
    """The exit code and the text of a replay."""

    code: int
    """`AGREES`, `DIFFERS`, or `UNKNOWN` if neither is known."""
    text: str


def replay_in_process(file: str, *, trust: bool, any_version: bool) -> ReplayResult:
    """Runs a recording again, in a process of its own; returns its verdict.

    The verdict comes in a file that only this process and that one know of, so nothing that the program prints, and no way in
    which it ends, is taken for one. Texts have the same order in sets as in `actr3d run`.

    Args:
        file: The recording.
        trust: As `actr3d.runner.replay.replay` has it.
        any_version: Likewise.
    """
    problem = _answered(file, partial(_check, file, trust, any_version))
    if problem is not None:
        return problem
    with _ended_in_order(), tempfile.TemporaryDirectory(prefix="actr3d-verdict-") as folder:
        to = Path(folder, "verdict")
        order = {"path": sys.path, "file": file, "to": str(to), "trust": trust, "any_version": any_version}
        flags: list[str] = subprocess._args_from_interpreter_flags()  # pyright: ignore # made for this purpose, but not public
        command: list[str] = [sys.executable, *flags, "-P", "-c", _CHILD, json.dumps(order)]
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, env={**os.environ, "PYTHONHASHSEED": "0"})
        try:
            status = process.wait()
        finally:
            process.kill()
            process.wait()
        try:
            return ReplayResult(**json.loads(to.read_text(encoding="utf-8")))
        except (OSError, ValueError, TypeError):
            return ReplayResult(code=UNKNOWN, text=f"error: no verdict: the model's process {how_it_ended(status)}\n")


def write_result(*, file: str, to: str, trust: bool, any_version: bool) -> None:
    """Runs a recording again in this process, and writes the verdict to a file."""
    process = os.getpid()
    verdict = _answered(file, partial(_compare, file, trust, any_version, Path(to).parent))
    if os.getpid() == process:  # else the program has made a copy of the process
        Path(to).write_text(json.dumps(asdict(verdict)), encoding="utf-8")


def _check(file: str, trust: bool, any_version: bool) -> None:
    with Recorded(file) as recorded:
        check_replayable(recorded, trust=trust, any_version=any_version)


def _compare(file: str, trust: bool, any_version: bool, within: Path) -> ReplayResult:
    from actr3d.runner.replay import replay

    with Recorded(file) as recorded:
        comparison = replay(recorded, trust=trust, any_version=any_version, within=within)
    return ReplayResult(code=AGREES if comparison.difference is None else DIFFERS, text=f"{comparison}\n")


def _answered(file: str, work: Callable[[], T]) -> T | ReplayResult:
    """Returns the result of some work with a recording, or the reason why it cannot be done."""
    try:
        return work()
    except UntrustedError:
        reason = "was not made by this installation (or was changed since), and a replay runs the code that it holds"
        text = f"error: '{file}' {reason}; if you trust where it comes from, add --trust\n"
    except (Actr3dError, OSError) as error:
        text = traceback_report(error).text
    except Exception as error:  # noqa: BLE001 - a file that anybody may have made is never answered by a traceback
        text = f"error: '{file}' cannot be run again: {type(error).__name__}: {error}\n"
    return ReplayResult(code=UNKNOWN, text=text)


@contextmanager
def _ended_in_order() -> Generator[None]:
    """Handles signals that terminate this process inside the block, so that it ends its child processes first."""
    signs = [signal.SIGTERM, signal.SIGHUP]
    before: dict[signal.Signals, Any] = {sign: signal.getsignal(sign) for sign in signs if signal.getsignal(sign) is signal.SIG_DFL}
    for sign in before:
        signal.signal(sign, lambda number, _: sys.exit(128 + number))
    try:
        yield
    finally:
        for sign, handler in before.items():
            signal.signal(sign, handler)
