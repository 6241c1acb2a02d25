"""The manual as a site, built once for all tests that need it."""

from __future__ import annotations

import fcntl
import subprocess
import sys
from pathlib import Path

from tests.helpers.paths import ROOT

SITE = ROOT / "build" / "site"
SOURCES = ("docs", "actr3d", "models", "workbench", "static", "mkdocs.yml", "CHANGELOG.md")
"""Folders and files that the manual is made of."""


def built_manual() -> Path:
    """Builds the manual unless it is newer than its sources; a warning, such as of a broken link or a missing docstring, fails.

    If two processes need it at the same time, one builds it while the other waits.
    """
    SITE.parent.mkdir(exist_ok=True)
    with (SITE.parent / "manual.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        built = SITE.parent / "manual.built"
        listed = subprocess.run(["git", "ls-files", "-z", *SOURCES], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        changed = max(path.stat().st_mtime for name in listed.split("\0") if name and (path := ROOT / name).exists())
        if not SITE.is_dir() or not built.exists() or built.stat().st_mtime <= changed:
            build_strictly(ROOT)
            built.touch()
    return SITE


def build_strictly(folder: Path) -> None:
    """Builds the manual of a folder with `mkdocs.yml`; a warning fails. Without `--quiet`, which hides warnings from the strict mode, too.

    Raises:
        AssertionError: If there is a warning or an error; with all that mkdocs says.
    """
    command = [sys.executable, "-m", "mkdocs", "build", "--strict"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
