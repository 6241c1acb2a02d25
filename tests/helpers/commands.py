"""Runs the command `actr3d` as a shell would, in processes that are forked from one which has the libraries loaded.

Starting Python and importing NumPy, MuJoCo and numba takes a second or two; a fork takes some milliseconds. Each command still has a
process, a folder, an environment and standard streams of its own.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from multiprocessing import get_context
from pathlib import Path
from subprocess import CompletedProcess, TimeoutExpired
from unittest.mock import patch

_CONTEXT = get_context("forkserver")
_CONTEXT.set_forkserver_preload(["actr3d.cli", "actr3d.simulation", "actr3d.runner.replay", "actr3d.recording"])


def run_command(
    *words: str, folder: Path | None = None, environment: Mapping[str, str] | None = None, timeout: float = 120
) -> CompletedProcess[str]:
    """Runs `actr3d` with arguments and returns its exit code and output.

    Args:
        words: The arguments.
        folder: The working directory; None for the current one.
        environment: Environment variables that differ from the current ones.
        timeout: Maximum duration [s].

    Raises:
        TimeoutExpired: If it takes longer; it is killed.
    """
    with tempfile.TemporaryDirectory() as place, patch.dict(os.environ, PYTHONHASHSEED="0"):
        out, error = Path(place, "out"), Path(place, "error")
        arguments = (words, str(folder or Path.cwd()), dict(environment or {}), str(out), str(error))
        process = _CONTEXT.Process(target=_run, args=arguments)
        process.start()
        process.join(timeout)
        if process.exitcode is None:
            process.kill()
            process.join()
            raise TimeoutExpired(words, timeout)
        return CompletedProcess(words, process.exitcode, _text(out), _text(error))


def run_without_reader(command: Sequence[str], folder: Path, *, unbuffered: str = "1", timeout: float = 200) -> CompletedProcess[str]:
    """Runs a command in a process whose output nobody reads, as behind a pipe to a `head` that has ended; returns its exit code and what it
    writes to standard error.

    Args:
        command: The program and its arguments.
        folder: The working directory.
        unbuffered: The variable `PYTHONUNBUFFERED`: "1" to write everything at once, "" to write it in blocks.
        timeout: Maximum duration [s].

    Raises:
        TimeoutExpired: If it takes longer; it is killed.
    """
    reading, writing = os.pipe()
    os.close(reading)
    try:
        with patch.dict(os.environ, PYTHONUNBUFFERED=unbuffered):
            return subprocess.run(command, cwd=folder, stdout=writing, stderr=subprocess.PIPE, text=True, timeout=timeout, check=False)
    finally:
        os.close(writing)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8").replace("\r\n", "\n") if path.exists() else ""


def _run(words: tuple[str, ...], folder: str, environment: dict[str, str], out: str, error: str) -> None:
    """Runs the command in this process, which serves no other purpose."""
    from actr3d.cli import main

    for number, path in ((1, out), (2, error)):
        file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(file, number)
        os.close(file)
    sys.stdout = io.TextIOWrapper(os.fdopen(1, "wb", closefd=False), encoding="utf-8")
    sys.stderr = io.TextIOWrapper(os.fdopen(2, "wb", closefd=False), encoding="utf-8", write_through=True)
    os.chdir(folder)
    os.environ.update(environment)
    sys.argv = ["actr3d", *words]
    sys.exit(main(words))
