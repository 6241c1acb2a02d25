"""Forged facts with correct checksums and seal are found wherever a replay can show it."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from actr3d.cli import main
from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from tests.helpers.recording_forgery import forge

AGENT = """from actr3d.actr import *
class Counter(ACTR):
    goal = Buffer()
    def init():
        goal.set("count 0")
    def count(goal="count ?n!4"):
        goal.set(f"count {int(n) + 1}")
    def end(goal="count 4"):
        self.stop()
"""
PROGRAM = f"{AGENT}Counter().run()\n"
STOP = f"""{AGENT}from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Scene
def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Aperture())), bodiless={{"counter": Counter}})
"""
DONE = STOP.replace("self.stop()", "goal.clear()")
FAIL = STOP.replace("self.stop()", "1 / 0")
ENDLESS = STOP.replace("?n!4", "?n").replace("count 4", "over")
RUNS: dict[str, tuple[str, tuple[str, ...]]] = {
    "limits": (ENDLESS, ("--until", "0.5")),
    "program": (PROGRAM, ()),
    "stop": (STOP, ()),
    "failed": (FAIL, ()),
    "done": (DONE, ()),
}


@pytest.fixture(name="recordings", scope="module")
def recordings_(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("forged")
    for name, (text, words) in RUNS.items():
        (folder / f"{name}.py").write_text(text, encoding="utf-8")
        main(["run", str(folder / f"{name}.py"), "--seed", "1", "--record", str(folder / name), *words])
    return {name: folder / name for name in RUNS}


Forgery = tuple[str, Callable[[sqlite3.Connection], None]]


def put(name: str, value: Any) -> Forgery:
    """Sets a fact."""

    def put_it(file: sqlite3.Connection) -> None:
        file.execute("INSERT OR REPLACE INTO facts VALUES (?, ?)", (name, json.dumps(value)))

    return f"{name}={value}", put_it


def drop(*names: str) -> Forgery:
    """Removes facts."""

    def drop_them(file: sqlite3.Connection) -> None:
        for name in names:
            file.execute("DELETE FROM facts WHERE name = ?", (name,))

    return f"without {names}", drop_them


def by(ended: str) -> dict[str, str]:
    return {"by": ended}


def verdict(path: Path) -> tuple[int, str]:
    """Replays a recording in this process; returns the exit code and the text of its verdict."""
    try:
        with Recorded(path) as recorded:
            comparison = replay(recorded)
    except RecordingError as error:
        return 2, str(error)
    return int(comparison.difference is not None), str(comparison)


@pytest.mark.parametrize("run", RUNS)
def test_unforged_facts_agree(run: str, recordings: dict[str, Path]) -> None:
    with Recorded(recordings[run]) as recorded:
        assert recorded.facts["until"] == (0.5 if run == "limits" else None)
        if run not in ("program", "failed"):
            assert recorded.facts["ended"] == by(run)
    code, text = verdict(recordings[run])
    assert code == 0
    assert text.startswith("agrees up to the end of the recording: " if run == "failed" else "every byte agrees: ")


BUILT_RUNS = ("limits", "stop", "done")
FORGERIES: list[tuple[str, tuple[Forgery, ...]]] = [
    *((run, (put("ended", by(end)),)) for run in BUILT_RUNS for end in ("limits", "stop", "done", "left", "end", "x") if end != run),
    *((run, (change,)) for run in BUILT_RUNS for change in (put("ended", None), drop("ended"), drop("ended", "whole"))),
    *((run, (put("whole", False),)) for run in (*BUILT_RUNS, "failed", "program")),
    *((run, (drop("whole"),)) for run in BUILT_RUNS),
    *((run, (put("more", 7),)) for run in RUNS),
    *((run, (put("helpers", {"unused": ["unused.py", "A = 1"]}),)) for run in RUNS),
    *((run, (drop("helpers"),)) for run in BUILT_RUNS),
    ("limits", (put("until", 0.6),)),
    ("limits", (put("until", None),)),
    *((run, (drop("until"),)) for run in RUNS),
    *((run, (put(name, "eA=="),)) for run in BUILT_RUNS for name in ("compiled", "scene")),
    *((run, (drop(name),)) for run in BUILT_RUNS for name in ("compiled", "scene", "world", "program_seed", "built", "parameters")),
    *((run, (put("world", {"bodies": {}}),)) for run in BUILT_RUNS),
    *((run, (put("seed", 2),)) for run in BUILT_RUNS),
    *((run, (put("period_us", 20_000),)) for run in BUILT_RUNS),
    ("failed", (put("failed", "ZeroDivisionError: other"),)),
    ("failed", (put("whole", True),)),
    ("program", (put("ended", by("exit")),)),
    ("program", (put("ended", by("limits")),)),
    ("program", (put("failed", "ValueError: no"),)),
    ("program", (put("whole", True),)),
    ("program", (put("parameters", {}),)),
    ("program", (put("simulation 7", {"period_us": 10_000, "compiled": "eA==", "world": {}}),)),
    ("program", (put("simulation 7", {"period_us": 0, "compiled": "eA==", "world": {}}),)),
]


@pytest.mark.daily(3)  # of the three runs of a file that builds its simulation, the one with the most forgeries
@pytest.mark.parametrize("run", RUNS)
def test_forged_facts_do_not_agree(run: str, recordings: dict[str, Path], tmp_path: Path) -> None:
    agreed: list[tuple[list[str], str]] = []
    path = tmp_path / "run"
    for changes in (changes for name, changes in FORGERIES if name == run):
        path.write_bytes(recordings[run].read_bytes())
        forge(path, *(change for _, change in changes))
        code, text = verdict(path)
        if code == 0:
            agreed.append(([name for name, _ in changes], text))
    assert agreed == []
