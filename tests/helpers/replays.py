"""Replays of recordings in the process of the test: the verdict of `actr3d replay`, without starting Python for it."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

from actr3d.runner.verdict import Verdict, give_verdict


def verdict(path: Path) -> Verdict:
    """Returns the verdict of the process of `actr3d replay PATH`."""
    with tempfile.TemporaryDirectory() as folder:
        to = Path(folder, "verdict")
        give_verdict(file=str(path), to=str(to), trust=False, any_version=False)
        return Verdict(**json.loads(to.read_text(encoding="utf-8")))
