"""Makes replays in processes of their own, so that the server never waits for one."""

from __future__ import annotations

import asyncio
import os
import sys
import tempfile
from pathlib import Path

from actr3d.errors import Actr3dError

MOST = 2
"""So many are made at once; others wait for their turn."""
LONGEST = 120.0
"""So long it may take to make one [s]."""

_turns = asyncio.Semaphore(MOST)


class ReplayError(Actr3dError):
    """A replay cannot be made."""

    status = 409


async def replay_of(path: Path) -> Path:
    """Returns a new file with the replay of a recording, for the caller to delete.

    Raises:
        ReplayError: If it cannot be made, or not in time.
        OSError: If no file or process can be had.
    """
    descriptor, name = tempfile.mkstemp(prefix="replay-", suffix=".html")
    os.close(descriptor)
    made = Path(name)
    try:
        async with _turns:
            await _make(path, made)
    except BaseException:
        made.unlink(missing_ok=True)
        raise
    return made


async def _make(path: Path, to: Path) -> None:
    command = [sys.executable, "-m", "workbench.html_replay", str(path), str(to)]
    quiet, pipe = asyncio.subprocess.DEVNULL, asyncio.subprocess.PIPE
    process = await asyncio.create_subprocess_exec(*command, stdin=quiet, stdout=quiet, stderr=pipe)
    try:
        async with asyncio.timeout(LONGEST):
            _, complaint = await process.communicate()
    except TimeoutError:
        raise ReplayError(f"the replay was not made within {LONGEST:g} s") from None
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()
    if process.returncode:
        lines = complaint.decode(errors="replace").strip().splitlines()
        raise ReplayError(f"the replay cannot be made: {lines[-1] if lines else f'exit code {process.returncode}'}")
