"""Runs the worker jobs for recordings: replays one, makes files from them, or reads their summaries."""

from __future__ import annotations

import resource
from collections.abc import Callable
from pathlib import Path
from typing import Any

from actr3d.errors import Actr3dError
from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from actr3d.values import to_json
from workbench.exports import EXPORTS
from workbench.files import ModelFolder
from workbench.recording_index import summary_json, without_path
from workbench.worker.channel import Channel
from workbench.worker.memory import relieve
from workbench.worker.messages import Reply, Share, shortened

STEP = 0.001
"""Progress is reported in steps of this share."""
MAX_TEXT = 20_000
"""Maximum length of the text about the differences [characters]."""
MIN_ROOM = 1_000_000_000
"""Minimum limit for the size of a file made from recordings [bytes]."""
ROOM = 10
"""The limit is also this multiple of the recordings' size: text tables are larger than numbers and compressed text."""


def replay_again(channel: Channel) -> None:
    """Runs a recording again; replies with the verdict (see `Replays.run`) and the rest of the comparison's text, or why there is none."""
    path = Path(channel.start.path)
    sent = 0.0

    def progress(share: float) -> None:
        nonlocal sent
        if share >= sent + STEP:
            sent = share
            channel.post(Share(done=share))

    try:
        with Recorded(path) as recorded:
            comparison = replay(recorded, trust=True, progress=progress, within=Path(channel.start.to))  # the server has checked the trust
        verdict = "differs" if comparison.difference is not None else "agrees" if comparison.to_its_end else "agrees up to its end"
        found: dict[str, Any] = {"verdict": verdict, "text": shortened(str(comparison).partition(": ")[2], MAX_TEXT)}
    except Actr3dError as error:
        found = {"verdict": None, "text": without_path(shortened(str(error), MAX_TEXT), path)}
    channel.post(Reply(id=0, result=to_json(found).encode()))


def make(channel: Channel) -> None:
    """Makes a file from recordings; replies with its size [bytes], or with the reason why it cannot be made."""
    start = channel.start
    paths, to = [Path(path) for path in start.recordings], Path(start.to)

    def made() -> bytes:
        room = max(MIN_ROOM, ROOM * sum(path.stat().st_size for path in paths))
        soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (room if soft == resource.RLIM_INFINITY else min(room, soft), hard))
        EXPORTS[start.export](*paths, to, **start.settings)
        return str(to.stat().st_size).encode()

    channel.post(_answer(0, made, paths))


def summarize(channel: Channel) -> None:
    """Replies with the summary of each recording, in order."""
    models = ModelFolder(Path(channel.start.folder))
    for number, path in enumerate(map(Path, channel.start.recordings)):
        channel.post(_answer(number, lambda path=path: summary_json(path, models), [path]))


def _answer(number: int, work: Callable[[], bytes], paths: list[Path]) -> Reply:
    """Returns a reply with the result of some work, or with the reason for its failure."""
    try:
        return Reply(id=number, result=work())
    except MemoryError:
        relieve()
        problem = "reading it needs more memory than allowed"
    except Actr3dError as error:
        problem = str(error)
    except OSError as error:
        problem = f"it cannot be read or written: {error.strerror or error}"
    except Exception as error:  # noqa: BLE001 - a damaged file may raise anything
        which = "the recording" if len(paths) == 1 else "one of the recordings"
        problem = f"{which} is damaged: {type(error).__name__}: {error}"
    for path in paths:
        problem = problem.replace(str(path), path.stem)
    return Reply(id=number, error=shortened(problem, 2_000))
