"""Runs the command `actr3d` in a process of its own, and reads its messages: the server itself loads nothing of what experiments need."""

from __future__ import annotations

import asyncio
import os
import re
import signal
import sys
from collections import deque
from collections.abc import AsyncGenerator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import msgspec

from actr3d.errors import Actr3dError
from actr3d.runner.before_exit import how_it_ended

NICENESS = 10
"""The niceness of its processes, so that the server and the sessions have priority: 0 to 19."""
LONGEST_LINE = 4_000_000
"""Maximum length of a line of its output [bytes]."""
LAST_LINES = 60
"""How many lines of its messages are kept."""
PART = 4_000
"""How much of a message is read at a time, and shown at most [characters]."""
OF_VALUE = re.compile(r"\A--set (\w+): (?:Design(?:, .*?: \1|\.\w+(?:\['.*?'\](?:\[\d+\])?)?)?: )?")
"""How the command begins an error about a value that replaces one of the design: with its option, and the place in the design."""


# -- the messages of `actr3d experiment --json`, one JSON object a line; see `actr3d.experiment.command`


class ExperimentEvent(msgspec.Struct, frozen=True, kw_only=True, tag_field="event"):
    """Base of all messages."""


class ExperimentFacts(ExperimentEvent, frozen=True, kw_only=True, tag="facts"):
    """What is known of an experiment before it runs."""

    name: str
    """The name of the design."""
    description: str
    trials: int
    """The number of trials."""
    trials_a_cell: int
    factors: dict[str, list[Any]]
    """Levels by name."""
    groups: dict[str, int]
    """Numbers of participants by name."""
    group_parameters: dict[str, dict[str, Any]] = {}
    """Values of parameters by group and name; a text for a distribution."""
    settings: dict[str, Any] = {}
    """Values of other parameters by name."""
    changed: dict[str, Any] = {}
    """The values and numbers that replace those of the design."""
    measures: list[dict[str, Any]] = []
    """The measures that the design names: name, unit, meaning, over."""
    seed: int | str = 0
    """For pages, a number that JavaScript would round is a text."""
    model: str = ""
    """The model file."""
    parameters: list[dict[str, Any]] = []
    """The parameters of the model: name, help, unit, default, whether it is `known`, choices."""


class TriedFacts(ExperimentFacts, frozen=True, kw_only=True, tag="check"):
    """The facts of an experiment of which a trial was run."""

    seconds_a_trial: float
    """Its duration on one processor [s]."""
    error: str | None = None
    """The traceback of the trial, if it failed."""


class ExperimentProgress(ExperimentEvent, frozen=True, kw_only=True, tag="progress"):
    """How far an experiment is."""

    done: int
    total: int
    failures: int
    workers: int = 0


class ExperimentEnd(ExperimentEvent, frozen=True, kw_only=True, tag="end"):
    """An experiment has ended normally: all trials have run, or it was stopped."""


AnyExperimentEvent = ExperimentFacts | TriedFacts | ExperimentProgress | ExperimentEnd
EVENTS: msgspec.json.Decoder[AnyExperimentEvent] = msgspec.json.Decoder(AnyExperimentEvent)
"""Decodes a message; other ones raise an error."""


# -- the process


class ExperimentRunError(Actr3dError):
    """An experiment cannot be run, continued or read as requested."""


class ExperimentCommand:
    """Holds a process that runs `actr3d`, the leader of its process group, and reads its output."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process
        self._messages: deque[str] = deque(maxlen=LAST_LINES)
        self._reading = asyncio.create_task(self._read_messages())
        self.interrupted = False
        """Whether it was asked to end."""

    @classmethod
    async def start(cls, arguments: Sequence[str], folder: Path) -> ExperimentCommand:
        """Starts `actr3d` with these arguments in a working folder.

        Raises:
            OSError: If no process can be started.
        """
        # A file of the user must not replace a package: with a safe path, Python does not search the working folder.
        environment = {**os.environ, "PYTHONSAFEPATH": "1", "PYTHONUNBUFFERED": "1"}
        pipe = asyncio.subprocess.PIPE
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "actr3d", *arguments),
            stdin=asyncio.subprocess.DEVNULL,
            stdout=pipe,
            stderr=pipe,
            cwd=folder,
            env=environment,
            limit=LONGEST_LINE,
            start_new_session=True,
        )
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, process.pid, NICENESS)
        return cls(process)

    @property
    def problem(self) -> str:
        """Why it failed: the signal that ended it, or its last messages, which begin with the name of a wrong value if there is one."""
        code = self._process.returncode
        if code is not None and code < 0 and not self.interrupted:
            return f"its process {how_it_ended(code)}"
        text = OF_VALUE.sub(r"\1: ", "\n".join(self._messages).strip().removeprefix("error: "))
        return text if len(text) <= PART else f"… {text[-PART:]}"

    async def events(self) -> AsyncGenerator[AnyExperimentEvent]:
        """Yields its messages; anything else that it prints is left out. Ends when it has closed its output."""
        assert self._process.stdout is not None
        while True:
            try:
                line = await self._process.stdout.readline()
            except ValueError:  # the line is too long
                continue
            if not line:
                return
            with suppress(msgspec.MsgspecError, ValueError, RecursionError):
                event = EVENTS.decode(line)
                yield event

    async def wait(self) -> int:
        """Waits until it has ended; returns its exit code."""
        async for _ in self.events():
            pass
        code = await self._process.wait()
        with suppress(TimeoutError):
            await asyncio.wait_for(asyncio.shield(self._reading), 1)
        return code

    def interrupt(self) -> None:
        """Asks it to end normally, as Ctrl-C does; only once, because a second time would abort it."""
        if not self.interrupted and self._process.returncode is None:
            self.interrupted = True
            with suppress(ProcessLookupError):
                self._process.send_signal(signal.SIGINT)

    async def kill(self) -> None:
        """Kills its process group, if it has not ended."""
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        await self._process.wait()
        self._reading.cancel()

    async def _read_messages(self) -> None:
        assert self._process.stderr is not None
        rest = ""
        while part := await self._process.stderr.read(PART):
            *lines, rest = (rest + part.decode("utf-8", "replace")).split("\n")
            rest = rest[-PART:]
            self._messages.extend(line[:PART] for line in lines)
        self._messages.append(rest)
