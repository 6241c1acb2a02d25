"""Makes replays in workers, so that the server never waits for one."""

from __future__ import annotations

import asyncio
import os
import tempfile
from pathlib import Path

from actr3d.errors import Actr3dError
from workbench.jobs import doing
from workbench.worker.messages import Start
from workbench.worker.workers import Workers

MOST = 2
"""So many are made at once; others wait for their turn."""
LONGEST = 120.0
"""So long it may take to make one [s]."""

_turns = asyncio.Semaphore(MOST)


class ReplayError(Actr3dError):
    """A replay cannot be made."""

    status = 409


async def replay_of(workers: Workers, path: Path) -> Path:
    """Returns a new file with the replay of a recording, for the caller to delete.

    Raises:
        ReplayError: If it cannot be made, or not in time.
        OSError: If no file or worker can be had.
    """
    descriptor, name = tempfile.mkstemp(prefix="replay-", suffix=".html")
    os.close(descriptor)
    made = Path(name)
    try:
        async with _turns, doing(workers, Start(job="page", path=str(path), to=name)) as making:
            async with asyncio.timeout(LONGEST):
                await making.over.wait()
            if making.result is None:
                raise ReplayError(f"the replay cannot be made: {making.problem}")
    except TimeoutError:
        made.unlink(missing_ok=True)
        raise ReplayError(f"the replay was not made within {LONGEST:g} s") from None
    except BaseException:
        made.unlink(missing_ok=True)
        raise
    return made
