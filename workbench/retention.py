"""Decides which recordings a folder keeps: each run makes one, and few users delete them by hand."""

from __future__ import annotations

import fcntl
import re
import time
from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from actr3d.recording.opening import COMPANIONS
from workbench.file_names import STAMP, unique_suffix
from workbench.labels import Labels

MAX_RECORDINGS = 500
"""Default maximum number of recordings."""
MAX_MEGABYTES = 4_000
"""Default maximum size of all recordings [MB]."""
MAX_BRANCHES = 20
"""How many of the newest branches of one run are kept; branches with a label do not count."""
_BEGUN = re.compile(STAMP)
_UNNAMED = re.compile(f".*{STAMP}")
"""The form of the name that a run gives its recording; any other name was given by a user."""
_SQLITE_LOCK = 510, 0x40000002
"""The bytes of a file, their number and the first, that a process locks while it has the file open with SQLite and a write-ahead log.
Source: https://www.sqlite.org/src/file/src/os.h (SHARED_SIZE, SHARED_FIRST)."""
_BRANCH = re.compile(rf"(.+)-at-(\d+\.\d+)s{STAMP}")


@dataclass(frozen=True, kw_only=True)
class RetentionLimits:
    """Limits for the recordings that are kept."""

    number: int = MAX_RECORDINGS
    """Maximum number of recordings; 0 for no limit."""
    megabytes: int = MAX_MEGABYTES
    """Maximum size of all recordings [MB]; 0 for no limit."""


def recordings_over_limit(files: Sequence[Path], limits: RetentionLimits, labelled: Collection[str] = ()) -> list[Path]:
    """Returns the recordings that exceed the limits: the oldest of those that no user has named or labelled, and no run is writing."""

    def is_kept(path: Path) -> bool:
        return not is_unnamed(path) or path.stem in labelled or not is_complete(path)

    newest = sorted(files, key=written, reverse=True)
    number = size = 0
    found: list[Path] = []
    for path in [path for path in newest if is_kept(path)] + [path for path in newest if not is_kept(path)]:
        own = size_of(path)
        number += 1
        size += own
        much = (limits.number and number > limits.number) or (limits.megabytes and size > limits.megabytes * 1_000_000)
        if much and not is_kept(path):
            found.append(path)
            number -= 1
            size -= own
    return found


def written(path: Path) -> float:
    """Returns when a file was last written [s since 1970]; 0 if it no longer exists."""
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def begun(path: Path, file: Path | None = None) -> float:
    """Returns when a recording or experiment began according to its name, or else when it was written [s since 1970].

    Args:
        path: The recording, or the folder of the experiment.
        file: The file that is written when it begins, and not later; None for the recording.
    """
    named = _BEGUN.search(path.stem)
    if named is not None:
        try:
            return time.mktime(time.strptime(named[1], "%Y%m%d-%H%M%S"))
        except (ValueError, OverflowError):
            pass
    return written(path if file is None else file)


def is_unnamed(path: Path) -> bool:
    """Returns whether a recording still has the name that its run gave it."""
    return _UNNAMED.fullmatch(path.stem) is not None


def companions(path: Path) -> list[Path]:
    """Returns the paths of the files that may lie beside a recording while it is written."""
    return [path.with_name(path.name + end) for end in COMPANIONS]


def size_of(path: Path) -> int:
    """Returns the size of a recording or another file with its companion files (as during writing) [bytes]; 0 if there is none."""
    size = 0
    for each in (path, *companions(path)):
        with suppress(OSError):
            size += each.stat().st_size
    return size


def is_complete(path: Path) -> bool:
    """Returns whether a recording has no companion files, as after a run that has ended normally."""
    return not any(each.exists() for each in companions(path))


def is_open_elsewhere(path: Path) -> bool:
    """Returns whether another process has a recording open that is not yet complete: its writer, or for a moment a reader."""
    if is_complete(path):
        return False
    with suppress(OSError), path.open("r+b") as file:
        try:
            fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB, *_SQLITE_LOCK)
        except (BlockingIOError, PermissionError):
            return True
    return False


def erase(path: Path) -> None:
    """Deletes a recording and its companion files."""
    for each in (path, *companions(path)):
        each.unlink(missing_ok=True)


# -- branches: copies of a run, kept because a user has changed something in its past


def new_branch(recording: Path, moment: float) -> Path:
    """Returns the file for a new branch of a run.

    Args:
        recording: The recording of the run.
        moment: The time at which the past was changed [s].
    """
    return recording.with_name(f"{recording.stem}-at-{moment:.3f}s{unique_suffix()}{recording.suffix}")


def copied_from(name: str) -> tuple[str, float] | None:
    """Returns the recording that a branch was copied from when the past of its run was changed, and the time of the change [s]; None if
    the name is not that of a branch."""
    found = _BRANCH.fullmatch(name)
    return None if found is None else (found[1], float(found[2]))


def superfluous_branches(recording: Path) -> list[Path]:
    """Returns the oldest branches of a run beyond the number that is kept; those with a label do not count. Empty if labels are missing."""
    labels = Labels(recording.parent)
    if labels.problem is not None:
        return []
    labelled = labels.all()
    branches = [path for path in recording.parent.glob(f"{recording.stem}-at-*{recording.suffix}") if copied_from(path.stem) is not None]
    found = [path for path in branches if path.stem not in labelled]
    return sorted(found, key=written, reverse=True)[MAX_BRANCHES:]
