"""A fork of a process that records or compares does neither: the recording is that of the first process."""

from __future__ import annotations

from pathlib import Path

import pytest

from actr3d.recording import Recorded
from tests.helpers.commands import run_command

MODEL = """import os, sys
from actr3d.actr import *
class Counter(Model):
    def start(self):
        for number in range(12):
            yield 0.25
            print(who, number)
who = "parent"
"""
CHILD, WAIT = "child = os.fork()\nif not child:\n    who = 'child'\n", "if child:\n    os.waitpid(child, 0)\n"
FORKS = {
    "a pool": "from multiprocessing import get_context\n"
    "def trial(number):\n    global who\n    who = 'child'\n    Counter().run()\n    return number\n"
    "with get_context('fork').Pool(2) as pool:\n    print(pool.map(trial, range(4)))\n    pool.close()\n    pool.join()\nCounter().run()\n",
    "before a run": CHILD + "Counter().run()\n" + WAIT,
    "between two runs": "Counter().run()\n" + CHILD + "Counter().run()\n" + WAIT,
    "a code": "child = os.fork()\nif not child:\n    print('child', flush=True)\n    os._exit(7)\nprint(os.waitpid(child, 0)[1] >> 8)\n",
}


def complaints(text: str) -> list[str]:
    """Returns the lines on standard error but for Python's own warning about forks in processes with threads."""
    return [line for line in text.splitlines() if "is multi-threaded, use of fork()" not in line]


@pytest.mark.daily(2)
@pytest.mark.parametrize("forks", FORKS.values(), ids=FORKS)
def test_a_recording_is_that_of_the_first_process_and_is_replayed(forks: str, tmp_path: Path) -> None:
    (tmp_path / "model.py").write_text(MODEL + forks, encoding="utf-8")
    done = run_command("run", "model.py", "--record", "run.sqlite", "--seed", "1", folder=tmp_path)
    assert (done.returncode, complaints(done.stderr)) == (0, [])
    assert "child" in done.stdout
    with Recorded(tmp_path / "run.sqlite") as recorded:
        recorded.check()
        assert not any("child" in str(event.data.get("text")) for event in recorded.events())
        assert recorded.facts["ended"] == {"by": "end"}
    again = run_command("replay", "run.sqlite", folder=tmp_path)
    assert (again.returncode, complaints(again.stderr)) == (0, [])
    assert again.stdout.splitlines()[-1].startswith("every byte agrees: ")


def test_prints_of_the_copies_are_printed_once(tmp_path: Path) -> None:
    (tmp_path / "model.py").write_text(MODEL + FORKS["before a run"], encoding="utf-8")
    done = run_command("run", "model.py", "--record", "run.sqlite", folder=tmp_path)
    assert sorted(done.stdout.split("\n")[:-1]) == sorted(f"{who} {number}" for who in ("parent", "child") for number in range(12))
