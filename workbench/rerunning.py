"""Runs a recording again, in a process of its own."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import Awaitable, Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from actr3d.errors import Actr3dError

LONGEST = 120.0
"""So long a recording is run again for a comparison [s]."""
MOST = 2
"""So many are run again at once; each takes a processor."""
MOST_TEXT = 20_000
"""No more is told of what it says [characters]."""
LOOK = 0.25
"""How often it is looked whether anyone waits still [s]."""

_going_on: set[object] = set()


class BusyError(Actr3dError):
    """Enough recordings are run again already."""

    status = 409


async def rerun(path: Path, left: Callable[[], Awaitable[bool]]) -> dict[str, Any]:
    """Returns whether every byte agrees (None where that cannot be told), and what the comparison says.

    Args:
        path: The recording.
        left: Tells whether nobody waits for it any more; then it is ended.

    Raises:
        BusyError: If enough are run again already.
        OSError: If no process can be started.
    """
    if len(_going_on) >= MOST:
        raise BusyError(f"{MOST} recordings are run again already; wait for one of them, or cancel it")
    mark = object()
    _going_on.add(mark)
    try:
        return await _rerun(path, left)
    finally:
        _going_on.discard(mark)


async def _rerun(path: Path, left: Callable[[], Awaitable[bool]]) -> dict[str, Any]:
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "actr3d.cli", "replay", str(path)),
        stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.STDOUT,
        env={**os.environ, "PYTHONHASHSEED": "0"},
        start_new_session=True,
    )
    reading = asyncio.create_task(process.communicate())
    end = asyncio.get_running_loop().time() + LONGEST
    try:
        while not (await asyncio.wait([reading], timeout=LOOK))[0]:
            if await left():
                return {"agrees": None, "text": "cancelled"}
            if asyncio.get_running_loop().time() > end:
                return {"agrees": None, "text": f"it takes longer than {LONGEST:g} s"}
        output, _ = reading.result()
    finally:
        with suppress(ProcessLookupError):  # what the model has started ends with it
            os.killpg(process.pid, signal.SIGKILL)
        reading.cancel()
        await process.wait()
    text = output.decode(errors="replace").strip()[-MOST_TEXT:].replace(f"'{path}'", "it")
    return {"agrees": {0: True, 1: False}.get(-1 if process.returncode is None else process.returncode), "text": text}
