"""Replays of recordings in the process of the test: the verdict of `actr3d replay`, without starting Python for it."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

from actr3d.runner.replay_process import ReplayResult, write_result


def verdict(path: Path) -> ReplayResult:
    """Returns the verdict of the process of `actr3d replay PATH`."""
    with tempfile.TemporaryDirectory() as folder:
        to = Path(folder, "verdict")
        write_result(file=str(path), to=str(to), trust=False, any_version=False)
        return ReplayResult(**json.loads(to.read_text(encoding="utf-8")))
