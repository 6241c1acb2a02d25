"""What tests in several processes use: the first that needs it makes it."""

from __future__ import annotations

import fcntl
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest


def made_once(folders: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """Returns a folder that is made once in a run of the tests, for all of its processes; tests must not change what is in it.

    Args:
        folders: Pytest's folders for temporary files.
        name: The name of the folder, which no other has.
        make: Fills the folder.
    """
    own = folders.getbasetemp()
    place = (own.parent if own.name.startswith("popen-") else own) / f"shared-{name}"
    with place.with_name(f"{place.name}.lock").open("a") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        done = place / "done"
        if not done.exists():
            shutil.rmtree(place, ignore_errors=True)  # what an error has left
            place.mkdir()
            make(place)
            done.touch()
    return place
