"""Finds the manual, and builds it in a copy of the repository that has none."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import threading
from importlib.util import find_spec
from pathlib import Path

PACKAGE = Path(__file__).parent
SITE = PACKAGE.parent / "build" / "site"
"""Where the manual is built in a copy of the repository."""

_building = threading.Event()
"""Set while this process builds it."""


def manual() -> Path | None:
    """Returns the folder of the built manual, inside the package or in a copy of the repository; None if it has not been built."""
    return next((folder for folder in (PACKAGE / "manual", SITE) if folder.is_dir()), None)


def manual_page(model: str) -> str | None:
    """Returns the address of a shipped model's page in the manual, by its path in the models folder; None if there is none."""
    folder = manual()
    name = model.removesuffix(".py").replace("/", "-")
    if folder is None or "\0" in name or not (folder / "models" / name / "index.html").is_file():
        return None
    return f"/manual/models/{name}/"


def is_being_built() -> bool:
    """Returns whether this process builds the manual at present."""
    return _building.is_set()


def no_manual() -> str:
    """Returns the answer for a user who asks for the manual while there is none."""
    if is_being_built():
        return "The manual is being built: try again in half a minute."
    return "The manual has not been built. In a copy of the repository: uv run mkdocs build"


def build_manual() -> None:
    """Begins to build the manual in the background, if this is a copy of the repository that has none and mkdocs is installed."""
    if manual() is None and (PACKAGE.parent / "mkdocs.yml").is_file() and find_spec("mkdocs") is not None:
        _building.set()
        threading.Thread(target=_build, daemon=True).start()


def _build() -> None:
    try:
        SITE.parent.mkdir(exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="site-", dir=SITE.parent) as folder:
            made = Path(folder) / "site"
            # What the user does meanwhile has the processor first.
            command = ["nice", "-n", "10", sys.executable, "-m", "mkdocs", "build", "--quiet", "--site-dir", str(made)]
            subprocess.run(command, cwd=PACKAGE.parent, stdin=subprocess.DEVNULL, capture_output=True, check=True)
            made.rename(SITE)
    except (OSError, subprocess.CalledProcessError):
        pass  # the command that `no_manual` names says what is wrong
    finally:
        _building.clear()
