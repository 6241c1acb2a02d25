"""`actr3d run --record` and `actr3d replay`: a recording is run again, and every byte is compared."""

from __future__ import annotations

import re
import sqlite3
import subprocess
import sys
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.cli import main
from actr3d.errors import ConfigurationError, ModelFileError, ParameterError, RecordingError
from actr3d.recording import Recorded
from actr3d.runner.build_check import has_build, problem_of_build
from actr3d.runner.cli_options import read_settings
from actr3d.runner.model_factory import Blueprint
from actr3d.runner.replay import replay
from actr3d.runner.replay_process import ReplayResult
from actr3d.runner.run import run_model
from actr3d.trace import Trace
from tests.helpers.paths import ROOT
from tests.helpers.recording_forgery import forge
from tests.helpers.replays import verdict
from tests.helpers.walkers import driving

BUILT = """
from dataclasses import dataclass
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, SimpleObject, Scene

@dataclass(frozen=True, kw_only=True)
class Parameters:
    times: int = 3
    height: float = 1.0
    word: str = "fall"

class Watcher(ACTR):
    goal = Buffer()
    noise = PMNoise(noise=1)
    times = 0
    def init():
        goal.set("watch")
    def left(goal="watch"):
        self.watch("left")
    def right(goal="watch"):
        self.watch("right")
    def watch(self, side):
        self.times += 1
        print(side, self.times)
        if self.times >= self.most:
            self.stop()

def build(parameters: Parameters) -> Simulation:
    scene = Scene(parts=(Floor(), Aperture(), SimpleObject(name="box", position=(0, 0, parameters.height), heading=0.3)))
    def watcher():
        agent = Watcher()
        agent.most = parameters.times
        return agent
    return Simulation(scene, bodiless={"watcher": watcher})
"""
NOISY = """
from python_actr import *
class Noisy(ACTR):
    goal = Buffer()
    noise = PMNoise(noise=1)
    def init():
        goal.set('go 0')
    def left(goal='go ?n!5'):
        goal.set({0: 'go', 1: int(n) + 1})
    def right(goal='go ?n!5'):
        goal.set({0: 'go', 1: int(n) + 1})
for _ in range(2):
    Noisy().run()
"""


@pytest.fixture(name="file")
def file_(tmp_path: Path) -> Path:
    path = tmp_path / "falling.py"
    path.write_text(BUILT, encoding="utf-8")
    return path


def recorded_run(file: Path, *words: str) -> Path:
    path = file.parent / "run"
    assert main(["run", str(file), "--seed", "1", "--record", str(path), *words]) == 0
    return path


def test_a_simulation_that_a_file_builds_is_run_to_its_end_recorded_and_replayed(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = recorded_run(file, "--set", "times=4", "--set", "height=0.5")
    assert capsys.readouterr().out.split()[1::2] == ["1", "2", "3", "4"]
    with Recorded(path) as recorded:
        assert recorded.ticks == 20
        assert recorded.facts["parameters"] == {"times": 4, "height": 0.5, "word": "fall"}
        assert recorded.facts["sources"] == {str(file): BUILT}
        assert recorded.facts["ended"] == {"by": "stop"}
        count = recorded.event_count
    assert main(["replay", str(path)]) == 0
    assert capsys.readouterr().out == f"every byte agrees: 20 ticks, {count} events\n"


WALKING = """
from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Floor, Mannequin, Scene, Wall

class Walker(ACTR):
    goal = Buffer()
    felt = Buffer()
    body = BodyPort(felt)
    def init():
        goal.set("start")
    def start(goal="start"):
        body.set("walk", 1.2)
        body.request("rangefinder")
        goal.set("walk")
    def far(goal="walk", felt="rangefinder ?", utility=0):
        body.request("rangefinder", noise=0.01)
        felt.clear()
    def near(goal="walk", felt=(lambda chunk, bound: float(chunk[1]) < 0.5), utility=1):
        body.set("stop")
        print("stopped", self.now())
        goal.clear()
        felt.clear()

def build() -> Simulation:
    scene = Scene(parts=(Floor(), Wall(name="wall", start=(2, -1), end=(2, 1)), Mannequin(name="walker")))
    return Simulation(scene, {"walker": Walker})
"""


def test_a_walker_that_stops_before_a_wall_is_recorded_and_replayed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "walking.py"
    file.write_text(WALKING, encoding="utf-8")
    path = recorded_run(file)
    assert capsys.readouterr().out.startswith("stopped 1.")
    with Recorded(path) as recorded:
        assert recorded.facts["ended"] == {"by": "done"}
        assert all(answer.word == "rangefinder" and answer.body == "walker" for answer in recorded.answers())
        last = list(recorded.answers())[-1]
        ticks = recorded.ticks
    assert 0.2 < last.value < 0.6
    assert f"every byte agrees: {ticks:,} ticks" in verdict(path).text


def test_until_ends_a_built_simulation_with_a_whole_tick(file: Path) -> None:
    path = recorded_run(file, "--until", "0.127")
    with Recorded(path) as recorded:
        assert recorded.ticks == 12
        assert recorded.facts["ended"] == {"by": "limits"}
    assert verdict(path).code == 0


def test_fewer_events_can_be_shown_than_are_recorded(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = recorded_run(file, "--trace", "production")
    shown = [line.split()[2] for line in capsys.readouterr().out.splitlines() if line.startswith("  ")]
    with Recorded(path) as recorded:
        kinds = [event.kind for event in recorded.events()]
    assert shown == [kind for kind in kinds if kind in ("start", "select", "fire")]
    assert "buffer" in kinds


def test_events_can_be_shown_while_they_are_recorded(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = recorded_run(file, "--json")
    shown = capsys.readouterr().out.splitlines()
    with Recorded(path) as recorded:
        assert [event.to_json() for event in recorded.events()] == shown


@pytest.mark.parametrize("name", ["models/counting.py", "models/tutorial/two_agents.py", "noisy.py"])
def test_a_program_without_a_world_is_recorded_and_replayed(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "noisy.py").write_text(NOISY, encoding="utf-8")
    file = ROOT / name if name.startswith("models") else tmp_path / name
    path = tmp_path / "run"
    assert main(["run", str(file), "--record", str(path)]) == 0
    printed = capsys.readouterr().out
    with Recorded(path) as recorded:
        assert verdict(path) == ReplayResult(code=0, text=f"every byte agrees: {recorded.event_count:,} events\n")
        assert recorded.event_count > 20
    assert main(["run", str(file), "--seed", "1"]) == 0
    assert (printed == capsys.readouterr().out) or name == "noisy.py"


def test_a_program_without_a_world_does_not_load_the_packages_of_worlds(tmp_path: Path) -> None:
    text = "import sys; from actr3d.cli import main; code = main(sys.argv[1:]); sys.exit(code or ('mujoco' in sys.modules) * 9)"
    for words in (["run", "models/counting.py"], ["run", "models/counting.py", "--record", str(tmp_path / "run")]):
        assert subprocess.run([sys.executable, "-c", text, *words], cwd=ROOT, check=False, capture_output=True, timeout=60).returncode == 0


def in_fact(name: str, old: str, new: str) -> str:
    return f"UPDATE facts SET value = replace(value, '{old}', '{new}') WHERE name = '{name}'"


CHANGES = [
    (in_fact("sources", "noise=1", "noise=2"), "differs: event "),
    (in_fact("sources", "heading=0.3", "heading=0.4"), "differs: the physics at the end of tick 0 (0 s): number 4 of "),
    (in_fact("sources", "Scene(", "Scene(gravity=(0, 0, -9), "), "; it compiles to another scene than then"),
    (in_fact("sources", "Scene(", "Scene(gravity=(0, 0, -9), "), "differs: the physics at the end of tick 1 (0.01 s): number "),
    (in_fact("sources", "times", "counts"), "error: Parameters has no parameter 'times'"),
    (in_fact("versions", '"mujoco": "', '"mujoco": "1'), "error: the recording was made with other versions"),
    (
        """UPDATE events SET data = replace(data, '"watch"', '"wait"')""",
        'recorded: {"time": 0.0, "source": "watcher.goal", "kind": "buffer", "data": {"chunk": {"0": "wait"}}}; now: {',
    ),
]


@pytest.mark.daily(2)
@pytest.mark.parametrize(("change", "message"), CHANGES)
def test_a_replay_reports_where_it_differs(change: str, message: str, file: Path) -> None:
    path = recorded_run(file)
    forge(path, change)
    report = verdict(path)
    assert report.code == (2 if "error" in message else 1)
    assert message in report.text


def test_other_versions_may_be_tried(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = recorded_run(file)
    forge(path, """UPDATE facts SET value = '{"python": "2.7"}' WHERE name = 'versions'""")
    capsys.readouterr()
    assert main(["replay", str(path)]) == 2
    assert "python 2.7 then, 3." in capsys.readouterr().err
    assert main(["replay", str(path), "--any-version"]) == 0


def test_a_damaged_recording_is_distinguished_from_one_that_differs(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = recorded_run(file)
    data = bytearray(path.read_bytes())
    with closing(sqlite3.connect(path)) as connection, connection:
        (page,) = connection.execute("SELECT rootpage FROM sqlite_schema WHERE name = 'events'").fetchone()
        (size,) = connection.execute("PRAGMA page_size").fetchone()
    connection.close()
    data[(page - 1) * size : (page - 1) * size + 8] = b"XXXXXXXX"
    path.write_bytes(data)
    capsys.readouterr()
    assert main(["replay", str(path)]) == 2
    assert f"error: the recording '{path}' is damaged: " in capsys.readouterr().err


@pytest.mark.parametrize("table", ["events", "answers", "commands"])
def test_damaged_texts_are_reported(table: str, tmp_path: Path) -> None:
    simulation = driving()
    with simulation.record(tmp_path / "run"):
        simulation.command("aperture", 0.5)
        simulation.run(0.3)
    forge(tmp_path / "run", f"UPDATE {table} SET data = substr(data, 1, length(data) - 9) || 'XXXXXXXXX'")
    with Recorded(tmp_path / "run") as recorded, pytest.raises(RecordingError, match="is damaged: "):
        replay(recorded, driving)


def test_a_recording_that_was_killed_before_anything_was_written_cannot_be_compared(file: Path) -> None:
    path = recorded_run(file)
    forge(path, "DELETE FROM events", "DELETE FROM states", "DELETE FROM facts WHERE name IN ('ended', 'whole')")
    message = "holds nothing to compare: its run was left or interrupted before anything was written"
    with Recorded(path) as recorded, pytest.raises(RecordingError, match=message):
        replay(recorded)


def test_a_recording_without_its_facts_is_reported(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = recorded_run(file)
    forge(path, "DELETE FROM facts WHERE name IN ('kind', 'versions')")
    capsys.readouterr()
    assert main(["replay", str(path)]) == 2
    assert "is not a recording: it lacks the fact 'kind' and the fact 'versions'" in capsys.readouterr().err


def test_a_program_that_ends_earlier_or_later_differs(tmp_path: Path) -> None:
    file = tmp_path / "noisy.py"
    file.write_text(NOISY.replace("python_actr", "actr3d.actr"), encoding="utf-8")
    path = recorded_run(file)
    for before, after, message in ((2, 1, "differs: the run ended after "), (1, 3, "recorded: nothing; now: ")):
        forge(path, in_fact("sources", f"range({before})", f"range({after})"))
        report = verdict(path)
        assert report.code == 1
        assert message in report.text


CUT = """UPDATE events SET count = count - 1, data = json_remove(data, '$[#-1]') WHERE first = (SELECT max(first) FROM events)"""


INTERRUPTED = "the recording says that the run was not over at 0.25 s, which cannot be checked"


def test_a_recording_that_was_broken_off_agrees_as_far_as_it_goes(tmp_path: Path) -> None:
    file = tmp_path / "noisy.py"
    file.write_text(NOISY, encoding="utf-8")
    path = recorded_run(file)
    forge(path, "DELETE FROM facts WHERE name = 'ended'", CUT)
    with Recorded(path) as recorded:
        comparison = replay(recorded)
    assert comparison.events > 20
    assert str(comparison) == f"agrees up to the end of the recording: {comparison.events} events; {INTERRUPTED}"


def test_a_recording_made_by_another_program_is_replayed_by_that_program(tmp_path: Path) -> None:
    simulation = driving()
    with simulation.record(tmp_path / "run"):
        simulation.run(0.3)
        simulation.command("stop", body="walker")
        simulation.run(0.3)
        simulation.command("aperture", 0.5)
    with Recorded(tmp_path / "run") as recorded:
        with pytest.raises(RecordingError, match="was made by a program that is not recorded with it"):
            replay(recorded)
        same = replay(recorded, driving)
        assert (same.difference, same.ticks, same.unfinished) == (None, 60, 0)
        assert same.events == recorded.event_count
        other = replay(recorded, lambda: driving(seed=2))
        assert other.difference is not None
        assert re.match(r'event 1 at 0 s; recorded: .*"seed": 1, .*; now: .*"seed": 2, ', other.difference)


def test_a_run_that_fails_is_recorded_until_then(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "failing.py"
    file.write_text(BUILT.replace("self.stop()", "self.halt()"), encoding="utf-8")
    path = tmp_path / "run"
    assert main(["run", str(file), "--seed", "1", "--record", str(path)]) == 1
    assert "has no attribute 'halt'" in capsys.readouterr().err
    report = verdict(path)
    assert report.code == 0
    assert re.fullmatch(
        r"agrees up to the end of the recording: 14 ticks, \d+ events; the run failed after 0.14 s \(AttributeError: .*'halt'\)\n",
        report.text,
    )


@pytest.mark.parametrize("code", [0, 3])
def test_a_program_that_exits_is_replayed_to_its_end(code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, path = tmp_path / "exiting.py", tmp_path / "run"
    file.write_text(f"{NOISY}print('over', end='')\nraise SystemExit({code})\n", encoding="utf-8")
    with pytest.raises(SystemExit) as left:
        main(["run", str(file), "--seed", "1", "--record", str(path)])
    assert left.value.code == code
    capsys.readouterr()
    assert main(["replay", str(path)]) == 0
    assert capsys.readouterr().out.startswith("every byte agrees: ")
    forge(path, "UPDATE facts SET value = replace(value, 'over', 'more') WHERE name = 'sources'")
    report = verdict(path)
    assert report.code == 1
    assert '"text": "moreend..."' in report.text


@pytest.mark.daily(1)
@pytest.mark.parametrize("leave", ["1 / 0", "raise SystemExit(0)", "raise BaseException"])
def test_a_replay_that_fails_differs(leave: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "fallen.py"
    fail = f"if os.environ.get('FAIL') == '%s': {leave}\n"
    text = BUILT.replace("    scene = ", f"    {fail % 'build'}    scene = ")
    text = text.replace("        print(side", f"        if self.times == 2:\n            {fail % 'run'}        print(side")
    file.write_text("import os\n" + text, encoding="utf-8")
    path = recorded_run(file)
    what = {"1 / 0": "ZeroDivisionError: division by zero", "raise BaseException": "BaseException: "}.get(leave, "SystemExit: 0")
    monkeypatch.setenv("FAIL", "run")
    assert verdict(path) == ReplayResult(code=1, text=f"differs: the run failed after 0.09 s ({what})\n")
    monkeypatch.setenv("FAIL", "build")
    report = verdict(path)
    assert report.code == 2
    assert f"error: what '{path}' holds cannot be built here: {what}\n" in report.text


@pytest.mark.parametrize(
    ("code", "words", "message"),
    [
        (2, ["--set", "tims=4"], "Parameters has no parameter 'tims'; did you mean 'times'? It has: times, height, word"),
        (2, ["--set", "times"], "a parameter is set by name=value (got 'times')"),
        (1, ["--record", "falling.py"], "cannot write the recording 'falling.py': it exists already"),
        (1, ["--record", "nowhere/run"], "cannot write the recording 'nowhere/run': No such file or directory"),
    ],
)
def test_wrong_options_of_run_are_reported(
    code: int, words: list[str], message: str, file: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(file.parent)
    assert main(["run", "falling.py", *words]) == code
    assert f"error: {message}" in capsys.readouterr().err
    assert file.read_text(encoding="utf-8") == BUILT


def test_wrong_uses_with_a_program_are_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "noisy.py"
    file.write_text(NOISY, encoding="utf-8")
    assert main(["run", str(file), "--set", "a=1"]) == 2
    assert "so there are no parameters to set" in capsys.readouterr().err
    with pytest.raises(ParameterError, match=r"a recording holds every event: trace 'all', or none \(got 'production'\)"):
        run_model(file, RunLimits(trace=Trace("production")), record=tmp_path / "run")
    assert main(["replay", str(file)]) == 2
    assert "is not a recording" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("def build(a, b) -> Simulation: pass", r":2: build\(a, b\) takes 2 arguments; write `def build\(parameters: Parameters\)"),
        ("def build(a: int, b: int = 3) -> Simulation: pass", r":2: build\(a: int, b: int=3\) takes 2 arguments"),
        ("def build(*, a: int) -> Simulation: pass", r":2: build\(\*, a: int\) takes arguments by name only"),
        ("def build(*a) -> Simulation: pass", "any number of them"),
        ("def build(a) -> Simulation: pass", r":2: build\(a\) does not say which dataclass its parameters are of"),
        ("def build(a: int) -> Simulation: pass", "takes int, which is not a dataclass"),
        ("class P: pass\ndef build(a: P) -> Simulation: pass", ":3: .* takes P, which is not a dataclass"),
        (
            "from enum import Enum\nclass P(Enum): pass\ndef build(a: P) -> Simulation: pass",
            r":4: build\(a: P\): its parameter must be a dataclass",
        ),
        (
            "def build(): return 3",
            r":2: build must be declared to return a Simulation \(got `def build\(\)`, without a return type\); write "
            r"`def build\(parameters: Parameters\) -> Simulation`, .*, or "
            r"`def build\(\) -> Simulation`; rename it if it is not to build the model; "
            r"an agent without a body .* plain assignments at the top of the file",
        ),
        ("def build(a, b): return 3", r":2: build must be declared to return a Simulation \(got `def build\(a, b\)`, without"),
        ("def build() -> int: return 3", r":2: build must be declared to return a Simulation \(got `def build\(\) -> int`\); write"),
        ("async def build() -> Simulation: pass", ":2: build is an async function"),
        ("class build: pass", ":2: build is a class"),
        ("build = lambda p: Simulation(p)", ":2: build is a value"),
        ("from elsewhere import build", ":2: build is imported"),
        ("try:\n    def build(a) -> Simulation: pass\nexcept ImportError: pass", r":3: build\(a\) does not say which dataclass"),
        ("(build, x) = (1, 2)", ":2: build is a value"),
        ("def build() -> Simulation: pass\ndel build", r":2: build is not a function when the file has run \(there is none\); write"),
        ("@lambda _: None\ndef build() -> Simulation: pass", r":3: build is not a function when the file has run \(it is None\)"),
        (
            "from dataclasses import dataclass\n@dataclass\nclass P: pass\ndef build(a: P | None) -> Simulation: pass",
            r":5: build\(a: P \| None\): its parameter must be a dataclass",
        ),
        ("\ndef build() -> Simulation: return 3", r":3: build must return a Simulation \(returned 3\)"),
    ],
)
def test_a_wrong_build_is_reported_with_its_line(tmp_path: Path, capsys: pytest.CaptureFixture[str], line: str, message: str) -> None:
    text = f"from actr3d.simulation import Simulation\n{line}\n"
    (tmp_path / "wrong.py").write_text(text, encoding="utf-8")
    with pytest.raises(ModelFileError, match=f"wrong.py{message}" if message[0] == ":" else message):
        Blueprint(text, "wrong.py").build({})
    assert main(["run", str(tmp_path / "wrong.py")]) == 1
    assert re.search(message, capsys.readouterr().err)


def test_a_build_below_a_condition_is_used() -> None:
    text = "from actr3d.simulation import Simulation\nfrom actr3d.world import Scene\n"
    text += "if True:\n    def build() -> Simulation:\n        return Simulation(Scene())\n"
    assert has_build(text)
    assert Blueprint(text, "plain.py").build({})[0].ticks == 0


def test_a_build_without_parameters() -> None:
    text = "import actr3d.simulation\nfrom actr3d.world import Scene\n"
    text += "def build() -> 'actr3d.simulation.Simulation':\n    return actr3d.simulation.Simulation(Scene())\n"
    assert has_build(text)
    simulation, parameters = Blueprint(text, "plain.py").build({})
    assert (simulation.ticks, parameters) == (0, {})
    with pytest.raises(ConfigurationError, match="build takes no parameters"):
        Blueprint(text, "plain.py").build({"a": 1})


@pytest.mark.parametrize(
    "text",
    ["def build(model):\n    return model\nprint(build(3))", "class A:\n    def build(self) -> Simulation: pass", "not python (", ""],
)
def test_other_functions_called_build_are_ignored(text: str) -> None:
    assert not has_build(text)
    assert problem_of_build(text) is None


def test_settings_are_values_or_texts() -> None:
    given: dict[str, Any] = read_settings(["a=1", "b=0.5", "c=None", "d=(1, 2)", "e=box", "f=x=y", "g="], ())
    assert given == {"a": 1, "b": 0.5, "c": None, "d": (1, 2), "e": "box", "f": "x=y", "g": ""}


PRINTING = BUILT + "print('loaded', end=' ')\nprint('and ready')\n"


def printed_lines(path: Path) -> list[tuple[float, str]]:
    with Recorded(path) as recorded:
        return [(event.time, event.data["text"]) for event in recorded.events() if event.kind == "output"]


def test_printed_lines_of_a_model_are_recorded_in_order(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file.write_text(PRINTING.replace("print(side, self.times)", "print(self.times); print('end', end='')"), encoding="utf-8")
    path = recorded_run(file)
    assert capsys.readouterr().out == "loaded and ready\n1\nend2\nend3\nend"
    assert printed_lines(path) == [(0.0, "loaded and ready"), (0.05, "1"), (0.1, "end2"), (0.15, "end3"), (0.15, "end")]
    assert verdict(path).code == 0
    forge(path, "UPDATE events SET data = replace(data, 'end2', 'end7')")
    report = verdict(path)
    assert report.code == 1
    assert '"text": "end7"' in report.text


def test_printed_lines_of_a_program_are_recorded_in_order(tmp_path: Path) -> None:
    file = tmp_path / "talking.py"
    text = NOISY + "import sys\nsys.stdout.buffer.write('größe\\n'.encode())\nsys.stdout.writelines(['a', 'b\\n'])\nprint('c', end='')\n"
    file.write_text("print('first')\n" + text.replace("Noisy().run()", "Noisy().run(0.22)\n    print('run')"), encoding="utf-8")
    path = recorded_run(file)
    expected = [(0.0, "first"), (0.22, "run"), (0.22, "run"), (0.22, "größe"), (0.22, "ab"), (0.22, "cend...")]
    assert printed_lines(path) == expected
    assert "every byte agrees" in verdict(path).text


def test_shown_events_hold_each_printed_line_once(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = recorded_run(file, "--json")
    shown = capsys.readouterr().out.splitlines()
    assert sum('"output"' in line for line in shown) == 3 == len(printed_lines(path))
    (file.parent / "run").unlink()
    recorded_run(file, "--trace", "production")
    shown = capsys.readouterr().out.splitlines()
    assert sum("left" in line.split()[:1] or "right" in line.split()[:1] for line in shown) == 3
    assert not any(" output " in line for line in shown)


ENDS = [
    ("print(1)\n", "ended", "end", "exit"),
    ("import sys\nprint(1, end='')\nsys.exit(3)\n", "ended", "exit", "end"),
    ("print(1)\nraise ValueError('too far')\n", "failed", "ValueError: too far", "ValueError: too near"),
    (BUILT, "ended", "stop", "done"),
    (BUILT.replace("self.stop()", "self.goal.clear()"), "ended", "done", "limits"),
    (BUILT.replace("self.stop()", "1 / 0"), "failed", "ZeroDivisionError: division by zero", "ZeroDivisionError: another"),
    (BUILT.replace("self.stop()", "raise SystemExit(3)"), "failed", "SystemExit: 3", "SystemExit: 4"),
]


@pytest.mark.daily(2)
@pytest.mark.parametrize(("text", "name", "then", "other"), ENDS)
def test_a_replay_compares_how_the_run_ended(text: str, name: str, then: str, other: str, tmp_path: Path) -> None:
    file, path = tmp_path / "model.py", tmp_path / "run"
    file.write_text(text, encoding="utf-8")
    with suppress(SystemExit):
        main(["run", str(file), "--seed", "1", "--record", str(path)])
    with Recorded(path) as recorded:
        assert recorded.facts[name] == (then if name == "failed" else {"by": then})
        assert ("ended" in recorded.facts) != ("failed" in recorded.facts)
        events = recorded.event_count
    agrees = verdict(path)
    assert agrees.code == 0
    assert f"{events} events" in agrees.text
    assert agrees.text.startswith("every byte agrees" if name == "ended" else "agrees up to the end of the recording")
    forge(path, in_fact(name, then, other))
    differs = verdict(path)
    assert differs.code == 1
    assert f"differs: the fact '{name}'; recorded: " in differs.text
    assert then in differs.text
    assert other in differs.text


def test_a_replay_without_the_recorded_failure_differs(tmp_path: Path) -> None:
    for text in (BUILT, "print(1)\n"):
        file = tmp_path / "model.py"
        file.write_text(text, encoding="utf-8")
        path = recorded_run(file)
        forge(path, "UPDATE facts SET name = 'failed', value = '\"ValueError: no\"' WHERE name = 'ended'")
        assert verdict(path) == ReplayResult(code=1, text="differs: the fact 'failed'; recorded: \"ValueError: no\"; now: null\n")
        path.unlink()


def test_the_same_limits_serve_one_recording_after_another(tmp_path: Path) -> None:
    file = tmp_path / "noisy.py"
    file.write_text(NOISY, encoding="utf-8")
    trace = Trace()
    limits = [RunLimits(), RunLimits(seed=1), RunLimits(seed=1, trace=trace)]
    for number, one in enumerate(limits):
        for name in "ab":
            run_model(file, one, record=tmp_path / f"{name}{number}")
        run_model(file, one)
        assert one.recorder is None
    assert [(one.seed, one.trace) for one in limits] == [(None, None), (1, None), (1, trace)]
    counts: list[int] = []
    for path in ("a1", "b1"):
        with Recorded(tmp_path / path) as recorded:
            counts.append(recorded.event_count)
    assert counts[0] == counts[1] > 0
