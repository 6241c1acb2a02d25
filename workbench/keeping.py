"""Which recordings a folder keeps: each run makes one, and nobody deletes them all by hand."""

from __future__ import annotations

import re
import secrets
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import msgspec

from actr3d.recording.opening import COMPANIONS
from workbench.feed import EventLog
from workbench.worker.messages import State

MOST = 500
"""So many recordings are kept, unless told otherwise."""
MOST_MEGABYTES = 4_000
"""And no more than so many MB of them."""
_BEGUN = re.compile(r"-(\d{8}-\d{6})-[0-9a-f]{4}")
_UNNAMED = re.compile(r".*-\d{8}-\d{6}-[0-9a-f]{4}")
"""The name that a run gives its recording; one with another name was given it by a user."""


@dataclass(frozen=True, kw_only=True)
class Keeping:
    """What is kept."""

    number: int = MOST
    """So many recordings; 0 for any number."""
    megabytes: int = MOST_MEGABYTES
    """So much of them [MB]; 0 for any size."""


def superfluous(files: Sequence[Path], keeping: Keeping) -> list[Path]:
    """Returns which recordings are too many: the oldest of those that no user has named.

    Args:
        files: All recordings.
        keeping: What is kept.
    """
    newest = sorted(files, key=written, reverse=True)
    number = size = 0
    found: list[Path] = []
    for path in [path for path in newest if not is_unnamed(path)] + [path for path in newest if is_unnamed(path)]:
        own = size_of(path)
        number += 1
        size += own
        much = (keeping.number and number > keeping.number) or (keeping.megabytes and size > keeping.megabytes * 1_000_000)
        if much and is_unnamed(path):
            found.append(path)
            number -= 1
            size -= own
    return found


def stamp() -> str:
    """Returns what stands at the end of a new recording's name: when it began, and a number, as several may begin in one second."""
    return f"{time.strftime('%Y%m%d-%H%M%S')}-{secrets.token_hex(2)}"


def written(path: Path) -> float:
    """Returns when a file was last written; 0 where it is gone meanwhile."""
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def begun(path: Path) -> float:
    """Returns when a recording began, as its name tells; else when it was last written [s since 1970]."""
    named = _BEGUN.search(path.stem)
    if named is not None:
        try:
            return time.mktime(time.strptime(named[1], "%Y%m%d-%H%M%S"))
        except (ValueError, OverflowError):
            pass
    return written(path)


def is_unnamed(path: Path) -> bool:
    """Tells whether a recording has the name that its run has given it."""
    return _UNNAMED.fullmatch(path.stem) is not None


def never_begun(state: State | None, log: EventLog) -> bool:
    """Tells whether a run has stood at its start all the time, and printed nothing: its recording is of no use.

    Args:
        state: Its newest state; None where it has not told any.
        log: Its events.
    """
    if state is None or state.furthest > 0 or state.status != "paused":
        return False
    _, events = log.since(0)
    return not any(msgspec.json.decode(event)[2] in ("output", "command") for event in events)


def size_of(path: Path) -> int:
    """Returns how large a recording is with what lies beside it, as of one that is being written [bytes]; 0 where it is gone."""
    size = 0
    for each in (path, *(path.with_name(path.name + end) for end in COMPANIONS)):
        with suppress(OSError):
            size += each.stat().st_size
    return size


def stands_alone(path: Path) -> bool:
    """Tells whether a recording is all in its own file, as one is whose run has ended in good order."""
    return not any(path.with_name(path.name + end).exists() for end in COMPANIONS)


def erase(path: Path) -> None:
    """Deletes a recording, and what lies beside it."""
    for each in (path, *(path.with_name(path.name + end) for end in COMPANIONS)):
        each.unlink(missing_ok=True)
