"""`actr3d run --record` of programs that create simulations themselves: every simulation is recorded and compared."""

from __future__ import annotations

import sqlite3
import subprocess
import sys
from array import array
from collections.abc import Callable
from itertools import groupby
from pathlib import Path
from typing import Any

import pytest

from actr3d.cli import main
from actr3d.recording import Recorded, Recording, reader
from actr3d.recording.facts import SIMULATION
from actr3d.runner.facts import program_facts
from actr3d.runner.replay import replay
from tests.helpers.recording_forgery import Change, forge
from tests.helpers.replays import verdict
from tests.helpers.walkers import DRIVER

BEGIN = (
    DRIVER
    + """
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, SimpleObject, Mannequin, Scene

def simulation(*more):
    scene = Scene(parts=(Floor(), Aperture(position=(3.0, 0.0)), Mannequin(name="walker"), *more))
    return Simulation(scene, {"walker": Driver})

"""
)
PROGRAM = (
    BEGIN
    + """one, two = simulation(), simulation(SimpleObject(name="box", position=(0.0, 2.0, 1.0)))
one.run(0.3)
for tick in range(20):
    two.step()
    one.step()
    if tick == 10:
        one.command("aperture", width=0.6)
        two.command("stop", body="walker")
one.seek(0.2)
one.run(0.3)
print("way", one.ticks, two.ticks)
Model().run(0.1)
"""
)


@pytest.fixture(name="file")
def file_(tmp_path: Path) -> Path:
    path = tmp_path / "program.py"
    path.write_text(PROGRAM, encoding="utf-8")
    return path


@pytest.fixture(name="path")
def path_(file: Path) -> Path:
    path = file.parent / "run"
    assert main(["run", str(file), "--seed", "1", "--record", str(path)]) == 0
    return path


def test_all_simulations_of_a_program_are_recorded_as_they_went(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with Recorded(path) as recorded:
        states = list(recorded.states())
        ticks = [(state.run, state.tick) for state in states]
        in_turn = [(run, tick) for tick in range(1, 21) for run, tick in ((2, tick), (1, 30 + tick))]
        assert [at for at in ticks if at != (2, 0)] == [(1, t) for t in range(31)] + in_turn + [(1, t) for t in range(21, 51)]
        assert recorded.ticks == 30 + 20 + 20 + 30
        once, again = ([state.data for state in states if state.run == 1 and 20 < state.tick <= 50][n : n + 30] for n in (0, 30))
        assert once == again
        assert len({len(state.data) for state in states}) == 2
        assert [(command.run, command.tick, command.data["command"]) for command in recorded.commands()] == [
            (1, 41, "aperture"),
            (2, 11, "stop"),
        ]
        answers = list(recorded.answers())
        assert {answer.run for answer in answers} == {1, 2}
        events = list(recorded.events())
        values = [event.data["value"] for event in events if event.kind == "answer" and event.run == 2]
        assert [answer.value for answer in answers if answer.run == 2][: len(values)] == values
        assert [run for run, _ in groupby(event.run for event in events[: states[30].events])] == [1]
        assert states[-1].events < len(events)
    capsys.readouterr()
    assert main(["replay", str(path)]) == 0
    assert capsys.readouterr().out == f"every byte agrees: 100 ticks, {len(events):,} events\n"


def test_a_program_records_the_same_as_its_simulation(tmp_path: Path) -> None:
    file = tmp_path / "program.py"
    own = tmp_path / "own"
    file.write_text(
        PROGRAM.split("one, two")[0] + f"\none = simulation()\nwith one.record({str(own)!r}):\n    one.run(0.5)\n", encoding="utf-8"
    )
    assert main(["run", str(file), "--seed", "3", "--record", str(tmp_path / "run")]) == 0
    with Recorded(own) as alone, Recorded(tmp_path / "run") as program:
        assert list(alone.states()) == list(program.states())
        assert list(alone.answers()) == list(program.answers())
        assert [event.to_json() for event in alone.events()] == [event.to_json() for event in program.events()]


def test_a_scene_of_many_simulations_is_recorded_once_and_the_recording_can_be_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reader, "OPENING_STEPS", 1_000)
    path = tmp_path / "many.sqlite"
    scenes: list[dict[str, Any]] = [{"period_us": 10_000, "compiled": name * 10_000, "world": {}} for name in "abc"]
    with Recording(path, program_facts("many.py", "", 1, None)) as recording:
        for number in range(1_000):
            recording.fact(SIMULATION.format(number), scenes[number % 2])
        recording.fact("simulation 1000", scenes[2])
        recording.fact("simulation 1000", None)  # a user changed something before it
        recording.fact("simulation 1001", scenes[2])
        recording.fact("simulation 1002", scenes[2])
    assert path.stat().st_size < 300_000
    with Recorded(path) as recorded:
        recorded.check()
        assert [recorded.facts[SIMULATION.format(number)] for number in range(1_003)] == [*500 * scenes[:2], None, *2 * scenes[2:]]


def swap(table: str, change: Callable[[bytes], bytes]) -> Callable[[sqlite3.Connection], None]:
    def alter(file: sqlite3.Connection) -> None:
        first, data = file.execute(f"SELECT first, data FROM {table} ORDER BY first DESC LIMIT 1").fetchone()
        file.execute(f"UPDATE {table} SET data = ? WHERE first = ?", (change(data), first))

    return alter


def no_run(file: sqlite3.Connection) -> None:
    for first, marks in file.execute("SELECT first, marks FROM states").fetchall():
        numbers = array("q", marks)
        numbers[::4] = array("q", [0]) * (len(numbers) // 4)
        file.execute("UPDATE states SET marks = ? WHERE first = ?", (numbers.tobytes(), first))


def last_number(data: bytes) -> bytes:
    numbers = array("d", data)
    numbers[-40] += 1e-12
    return numbers.tobytes()


SOURCE = "UPDATE facts SET value = replace(value, '{}', '{}') WHERE name = 'sources'"


@pytest.mark.daily(1)
@pytest.mark.parametrize(
    ("alter", "message"),
    [
        (swap("states", last_number), "differs: the physics at the end of tick 50 of top: number "),
        (SOURCE.format("1.0))", "1.1))"), "differs: the physics at the end of tick 0 of top#2: number "),
        (SOURCE.format("width=0.6", "width=0.5"), "differs: event "),
        (SOURCE.format("one.seek(0.2)", "one.seek(0.3)"), "differs: event "),
        ("DELETE FROM states WHERE first = (SELECT max(first) FROM states)", "; recorded: nothing; now: tick "),
        (no_run, "differs: state 1; recorded: tick 0 of top#0; now: tick 0 of top"),
        (SOURCE.format("one.run(0.3)\\nprint", "print"), "event "),
        ("UPDATE commands SET data = replace(data, '0.6', '0.5')", "differs: command 1; recorded: [1, 41, {"),
        ("UPDATE answers SET data = replace(data, '\"x\":0', '\"x\":1')", "differs: answer 1; recorded: [1, "),
        ("INSERT INTO commands SELECT 2, run, 51, data, checksum FROM commands WHERE first = 1", "the recording holds 1 command more"),
    ],
)
def test_a_replay_reports_where_a_simulation_of_a_program_differs(alter: Change, message: str, path: Path) -> None:
    forge(path, alter)
    report = verdict(path)
    assert report.code == 1
    assert message in report.text


def test_a_program_that_was_killed_agrees_as_far_as_it_goes(tmp_path: Path) -> None:
    file, path = tmp_path / "program.py", tmp_path / "run"
    file.write_text(
        PROGRAM.split("one, two")[0] + "\none = simulation()\nwhile True:\n    one.step()\n    print(one.ticks)\n", encoding="utf-8"
    )
    code = "import sys; from actr3d.cli import main; main(sys.argv[1:])"
    with subprocess.Popen([sys.executable, "-c", code, "run", str(file), "--record", str(path)], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if path.exists() and int(line) % 50 == 0:
                with Recorded(path) as recorded:
                    if recorded.ticks > 50:
                        break
        process.kill()
    with Recorded(path) as recorded:
        comparison = replay(recorded)
        assert comparison.difference is None
        assert comparison.ticks == recorded.ticks > 50
        assert comparison.events + comparison.unfinished == recorded.event_count


def test_a_program_that_raises_a_base_exception_is_recorded_as_failed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, recording = tmp_path / "odd.py", tmp_path / "odd.rec"
    file.write_text("print('begun')\nclass Odd(BaseException): pass\nraise Odd('on purpose')\n", encoding="utf-8")
    assert main(["run", str(file), "--seed", "1", "--record", str(recording)]) == 1
    assert "Odd: on purpose" in capsys.readouterr().err
    report = verdict(recording)
    assert report.code == 0
    assert "failed after 0 s (Odd: on purpose)" in report.text


def test_a_program_that_prints_the_report_of_its_run_agrees_with_itself(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file.write_text(
        PROGRAM.split("one, two")[0] + "\nprint(simulation().run(0.05))\nprint(simulation().run(0.05, real_time=1e9))\n", encoding="utf-8"
    )
    assert main(["run", str(file), "--seed", "1", "--record", str(tmp_path / "printed")]) == 0
    assert capsys.readouterr().out == "RunReport(ended_by='seconds', ticks=5, simulated=0.05)\n" * 2
    with Recorded(tmp_path / "printed") as recorded:
        assert str(replay(recorded)).startswith("every byte agrees: 10 ticks, ")
