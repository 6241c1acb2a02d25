"""What a worker does with a recording: runs it again, or makes a page of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from actr3d.errors import Actr3dError
from actr3d.recording import Recorded
from actr3d.running.replay import replay
from workbench.worker.link import Link
from workbench.worker.messages import Share, whole

STEP = 0.001
"""It is told whenever so much more is done."""
MOST_TEXT = 20_000
"""No more is told of where a run differs [characters]."""


def replay_again(link: Link) -> dict[str, Any]:
    """Runs a recording again; returns whether every byte agrees (None where that cannot be told), and what the comparison says."""
    path = Path(link.start.path)
    told = 0.0

    def progress(share: float) -> None:
        nonlocal told
        if share >= told + STEP:
            told = share
            link.post(Share(done=share))

    try:
        with Recorded(path) as recorded:
            comparison = replay(recorded, progress=progress)
    except Actr3dError as error:
        return {"agrees": None, "text": whole(str(error), MOST_TEXT).replace(f"'{path}'", "it")}
    return {"agrees": comparison.difference is None, "text": whole(str(comparison), MOST_TEXT)}


def make_page(link: Link) -> None:
    """Makes one HTML file of a recording."""
    from workbench.html_replay.make import write_replay

    write_replay(Path(link.start.path), Path(link.start.to))
