"""How many recordings a folder keeps: each run makes one, and nobody deletes them all by hand."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

MOST = 500
"""So many recordings are kept, unless told otherwise."""
MOST_MEGABYTES = 4_000
"""And no more than so many MB of them."""
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
    known = sorted(((path, path.stat()) for path in files), key=lambda entry: entry[1].st_mtime, reverse=True)
    number = size = 0
    found: list[Path] = []
    for path, status in [entry for entry in known if not is_unnamed(entry[0])] + [entry for entry in known if is_unnamed(entry[0])]:
        number += 1
        size += status.st_size
        much = (keeping.number and number > keeping.number) or (keeping.megabytes and size > keeping.megabytes * 1_000_000)
        if much and is_unnamed(path):
            found.append(path)
            number -= 1
            size -= status.st_size
    return found


def is_unnamed(path: Path) -> bool:
    """Tells whether a recording has the name that its run has given it."""
    return _UNNAMED.fullmatch(path.stem) is not None
