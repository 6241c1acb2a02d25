"""Recordings that are run again: each in a worker of its own, which tells how far it has come."""

from __future__ import annotations

import asyncio
import re
import time
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.sessions import PATIENCE, Desk
from workbench.replays import BusyError, Replays

BUILT = """import os, time
from pathlib import Path
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    def init():
        goal.set("count 0")
    def count(goal="count ?n!9"):
        {does}
        goal.set(f"count {{int(n) + 1}}")
    def end(goal="count 9"):
        self.stop()

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {{"walker": Walker}}, seed=1)
"""
PROGRAM = BUILT.replace("def build() -> Simulation:\n    return ", "made = ") + "made.run(0.6)\n"
HALF = """
        while int(n) == 5 and not Path({gate!r}).exists():
            time.sleep(0.01)
"""


async def waits() -> bool:
    return False


def recorded(desk: Desk, folder: Path, source: str) -> Path:
    """Records a run, and returns the recording."""
    talk = desk.begin(folder, source, record=True, run=True, wait="ended")
    desk.do(talk.session.stop())
    return talk.sessions.recordings.path(talk.facts["recording"])


@pytest.mark.parametrize("source", [BUILT, PROGRAM], ids=["built", "program"])
def test_the_progress_of_a_replay_is_reported(desk: Desk, tmp_path: Path, source: str) -> None:
    gate = tmp_path / "gate"
    gate.touch()
    path = recorded(desk, tmp_path, source.format(does=HALF.format(gate=str(gate))))
    gate.unlink()
    replays = Replays(desk.workers)

    async def run() -> tuple[float, dict[str, Any]]:
        assert replays.share(path) is None
        running = asyncio.create_task(replays.run(path, waits))
        share: float | None = 0.0
        end = time.monotonic() + PATIENCE
        while share is not None and share < 0.4:
            assert time.monotonic() < end
            await asyncio.sleep(0.01)
            share = replays.share(path)
        assert share is not None, await running
        gate.touch()
        return share, await running

    share, told = desk.do(run())
    assert share < 0.7
    assert told["verdict"] == "agrees"
    assert re.fullmatch(r"[\d,]+ ticks, [\d,]+ events", told["text"])
    assert replays.share(path) is None


@pytest.mark.daily(3)
@pytest.mark.parametrize(
    ("does", "verdict", "text"),
    [
        ("print(os.path.exists({mark!r}))", "differs", "event "),
        ("os.path.exists({mark!r}) and os._exit(0)", None, "no verdict: the model's process ended with exit code 0"),
        ("os.path.exists({mark!r}) and os._exit(7)", None, "no verdict: the model's process ended with exit code 7"),
        ("os.path.exists({mark!r}) and os.abort()", None, "ended by SIGABRT"),
        ("os.path.exists({mark!r}) and bytearray(10**12)", "differs", "MemoryError"),
        ("os.path.exists({mark!r}) and os.write(1, b'x' * 10**7)", "agrees", " events"),
    ],
)
def test_whatever_a_model_does_in_a_replay_is_reported(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, does: str, verdict: str | None, text: str
) -> None:
    mark = tmp_path / "mark"
    path = recorded(desk, tmp_path, BUILT.format(does=does.format(mark=str(mark))))
    mark.touch()
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    told = desk.do(Replays(desk.workers).run(path, waits))
    assert told["verdict"] == verdict
    assert text in told["text"]
    assert not list((tmp_path / "temporary").iterdir())


def test_what_is_no_recording_cannot_be_run_again(desk: Desk, tmp_path: Path) -> None:
    path = tmp_path / "x.sqlite"
    path.write_bytes(b"nothing" * 1000)
    told = desk.do(Replays(desk.workers).run(path, waits))
    assert told == {"verdict": None, "text": "it is not a recording: it is a file of another kind, or damaged"}


def test_it_ends_when_no_client_waits_and_when_it_makes_no_progress(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    gate = tmp_path / "gate"
    gate.touch()
    path = recorded(desk, tmp_path, BUILT.format(does=HALF.format(gate=str(gate))))
    gate.unlink()
    replays = Replays(desk.workers)
    begin = time.monotonic()

    async def gone() -> bool:
        return time.monotonic() > begin + 0.5

    async def three() -> list[object]:
        return await asyncio.gather(*(replays.run(path, gone) for _ in range(3)), return_exceptions=True)

    first, second, third = desk.do(three())
    assert first == second == {"verdict": None, "text": "cancelled"}
    assert isinstance(third, BusyError)
    monkeypatch.setattr("workbench.jobs.PATIENCE", 0.5)
    assert desk.do(replays.run(path, waits)) == {"verdict": None, "text": "no progress for 0.5 s"}
    assert replays.share(path) is None
