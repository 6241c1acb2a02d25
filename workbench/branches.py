"""Branches: copies of a run as it was, kept because a user has changed something in its past."""

from __future__ import annotations

import re
from pathlib import Path

from workbench.keeping import stamp, written

MOST = 20
"""So many branches of one run are kept, the newest; a branch with a name that a user has given it does not count."""
_BRANCH = re.compile(r"(.+)-at-(\d+\.\d+)s-\d{8}-\d{6}-[0-9a-f]{4}")


def new_branch(recording: Path, moment: float) -> Path:
    """Returns the file for a branch of a run.

    Args:
        recording: The recording of the run.
        moment: Where its past was changed [s].
    """
    return recording.with_name(f"{recording.stem}-at-{moment:.3f}s-{stamp()}{recording.suffix}")


def branched_at(path: Path) -> float | None:
    """Returns where the past of a run was changed, of which this file is a branch [s]; None where it is no branch."""
    found = _BRANCH.fullmatch(path.stem)
    return None if found is None else float(found[2])


def superfluous_branches(recording: Path) -> list[Path]:
    """Returns the oldest branches of a run, where there are too many."""
    found = [path for path in recording.parent.glob(f"{recording.stem}-at-*{recording.suffix}") if branched_at(path) is not None]
    return sorted(found, key=written, reverse=True)[MOST:]
