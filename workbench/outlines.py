"""Describes model files for a list: each file is read once, and again only when it has changed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from actr3d.actr.loading.source_text import read_source
from actr3d.errors import ModelFileError
from workbench.files import LARGEST, MOST_FILES
from workbench.loader import listing_of


@dataclass(frozen=True)
class Outline:
    """Holds what a list shows of a model file."""

    title: str = ""
    """The first line of its docstring."""
    kind: str = "program"
    """`simulation` if the file defines `build`, otherwise `program`."""


def outline_of(path: Path) -> Outline:
    """Returns the outline of a file; an empty one if the file cannot be read."""
    try:
        now = path.stat()
        return _read(path, (now.st_mtime_ns, now.st_size, now.st_ino)) if now.st_size <= LARGEST else Outline()
    except (OSError, ModelFileError):
        return Outline()


@lru_cache(maxsize=2 * MOST_FILES)
def _read(path: Path, _: tuple[int, ...]) -> Outline:
    """Reads a file; the numbers change when the file changes, so that the cache is not used for an old version."""
    listing = listing_of(read_source(path), path.name)
    return Outline(listing.title, listing.kind)
