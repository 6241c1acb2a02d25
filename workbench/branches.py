"""Names and finds branches: copies of a run, kept because a user has changed something in its past."""

from __future__ import annotations

import re
from pathlib import Path

from workbench.labels import Labels
from workbench.retention import stamp, written

MOST = 20
"""How many of the newest branches of one run are kept; a branch that a user has renamed does not count."""
_BRANCH = re.compile(r"(.+)-at-(\d+\.\d+)s-\d{8}-\d{6}-[0-9a-f]{4}")


def new_branch(recording: Path, moment: float) -> Path:
    """Returns the file for a new branch of a run.

    Args:
        recording: The recording of the run.
        moment: The time at which the past was changed [s].
    """
    return recording.with_name(f"{recording.stem}-at-{moment:.3f}s-{stamp()}{recording.suffix}")


def branched_at(path: Path) -> float | None:
    """Returns the time at which the past of a branch's run was changed [s]; None if the file is not a branch."""
    found = _BRANCH.fullmatch(path.stem)
    return None if found is None else float(found[2])


def superfluous_branches(recording: Path) -> list[Path]:
    """Returns the oldest branches of a run beyond the number that is kept; those with a label do not count."""
    labelled = Labels(recording.parent).all()
    branches = [path for path in recording.parent.glob(f"{recording.stem}-at-*{recording.suffix}") if branched_at(path) is not None]
    found = [path for path in branches if path.stem not in labelled]
    return sorted(found, key=written, reverse=True)[MOST:]
