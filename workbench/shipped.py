"""Finds the models folder: the one named by the user, `models` in the current folder, or one at home with copies of the shipped models."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import actr3d

HOME = "actr3d-models"
"""The name of the models folder in the user's home folder."""


def shipped() -> Path:
    """Returns the folder of the models that are shipped with the library."""
    package = Path(actr3d.__file__).parent
    inside = package / "models"
    return inside if inside.is_dir() else package.parent / "models"


def models_folder(named: Path | None, present: Path, home: Path) -> Path:
    """Returns the folder to work in: the one that the user named, else `models` in the present folder, else one at home, which is created
    and filled if there is none.

    Raises:
        OSError: If the folder cannot be created or read.
    """
    if named is not None:
        named.mkdir(parents=True, exist_ok=True)
        os.scandir(named).close()
        return named
    if (present / "models").is_dir():
        return present / "models"
    folder = home / HOME
    if not folder.exists():
        # Copies only the contents: the user's copies must be writable even if the installed files are not.
        shutil.copytree(shipped(), folder, ignore=shutil.ignore_patterns("__pycache__", ".*"), copy_function=shutil.copyfile)
    return folder


def static() -> Path:
    """Returns the folder of the page: inside the package if installed, beside it in a copy of the repository."""
    package = Path(__file__).parent
    inside = package / "static"
    return inside if inside.is_dir() else package.parent / "static"
