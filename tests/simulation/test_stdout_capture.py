"""Prints of agents become events in every kind of recording, and are printed once although a seek repeats the run."""

from __future__ import annotations

import io
import sys
import threading
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr.loading import load_text
from actr3d.cli import main
from actr3d.recording import Recorded
from actr3d.runner.model_factory import Blueprint
from actr3d.runner.replay import replay
from actr3d.simulation import Simulation
from actr3d.trace import TraceEvent
from actr3d.world import Floor, Scene, SimpleObject

TALKER = """
import sys
from contextlib import redirect_stdout
from sys import stdout as kept
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Scene

class Talker(Model):
    most = 6
    aside = None
    def __init__(self):
        Model.__init__(self)
        print("made")
    def start(self):
        for number in range(self.most):
            yield 0.01
            print("number", number, self.random.randrange(100), end="")
            yield 0.005
            if self.aside is not None:
                with redirect_stdout(self.aside):
                    print("aside")
                    yield 0.01
                    print("aside")
            print()
            sys.stdout.buffer.write(b"bytes\\n")
        print("over", end="")

def build() -> Simulation:
    return Simulation(Scene(), bodiless={"talker": Talker}, seed=1)
"""
THREADED = """
import threading
from actr3d.actr import *
class Threaded(Model):
    def start(self):
        other = threading.Thread(target=print, args=("elsewhere",))
        other.start()
        other.join()
        yield 0.01
"""
Talker: Any = load_text(TALKER, "talker.py").Talker


def talking(trace: str = "all", seed: int = 1) -> Simulation:
    return Simulation(Scene(parts=(Floor(), SimpleObject(name="box"))), bodiless={"talker": Talker}, seed=seed, trace=trace)


def lines_in(events: Any) -> list[tuple[float, str]]:
    return [(event.time, event.data["text"]) for event in events if event.kind == "output"]


def recorded(path: Path) -> list[str]:
    with Recorded(path) as file:
        return [event.to_json() for event in file.events()]


def test_a_recording_holds_the_same_lines_however_it_is_made(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "talker.py"
    file.write_text(TALKER, encoding="utf-8")
    assert main(["run", str(file), "--seed", "1", "--record", str(tmp_path / "by command")]) == 0
    printed = capfd.readouterr().out
    simulation, _ = Blueprint(TALKER, "talker.py").build({})
    with simulation.record(tmp_path / "by library"):
        simulation.run()
    assert capfd.readouterr().out == printed
    assert printed.startswith("made\nnumber 0 ")
    assert printed.endswith("bytes\nover")
    lines = recorded(tmp_path / "by library")
    assert lines == recorded(tmp_path / "by command")
    assert sum('"output"' in line for line in lines) == 1 + 2 * 6 + 1
    for way in ("by command", "by library"):
        with Recorded(tmp_path / way) as file:
            assert replay(file, lambda: Blueprint(TALKER, "talker.py").build({})[0]).difference is None
    assert capfd.readouterr().out == ""


def test_lines_are_in_the_trace_at_their_time(capsys: pytest.CaptureFixture[str]) -> None:
    simulation = talking("production")
    simulation.run(0.05)
    lines = capsys.readouterr().out.splitlines()
    assert simulation.trace is not None
    times = [0.0, *(time for number in range(3) for time in [0.015 * (number + 1)] * 2)]
    assert lines_in(simulation.trace) == list(zip(times, lines, strict=True))


@pytest.mark.parametrize("trace", ["none", "all"])
def test_lines_are_not_printed_again_after_a_seek(trace: str, capsys: pytest.CaptureFixture[str]) -> None:
    simulation, other = talking(trace), talking(trace)
    other.run(0.08)
    once = capsys.readouterr().out
    simulation.run(0.06)
    for time in (0.03, 0.06, 0.0):
        simulation.seek(time)
    simulation.run(0.08)
    assert capsys.readouterr().out == once
    simulation.seek(0.02)
    simulation.command("parameter", "talker.most", 3)
    simulation.run(0.06)
    assert once.endswith(again := capsys.readouterr().out)
    assert 0 < len(again) < len(once)


def test_a_recording_holds_each_line_once_and_those_of_a_new_future(tmp_path: Path) -> None:
    simulation = talking()
    with simulation.record(tmp_path / "run"):
        simulation.run(0.06)
        simulation.seek(0.02)
        simulation.run(0.06)
        simulation.seek(0.02)
        simulation.command("parameter", "talker.most", 3)
        simulation.run(0.06)
    other = talking()
    with other.record(tmp_path / "other"):
        other.run(0.02)
        other.command("parameter", "talker.most", 3)
        other.run(0.06)
    assert recorded(tmp_path / "run") == recorded(tmp_path / "other")


def test_prints_of_observers_and_of_other_threads_are_no_events(capsys: pytest.CaptureFixture[str]) -> None:
    def listen(event: TraceEvent) -> None:
        sys.stdout.write(f"heard {event.kind}\n")
        thread = threading.Thread(target=print, args=("elsewhere",))
        thread.start()
        thread.join()

    quiet, loud = talking(), talking()
    loud.observe(lambda seen: sys.stdout.write(f"seen {seen.tick}\n"))
    loud.listen(listen)
    quiet.run(0.05)
    loud.run(0.05)
    out = capsys.readouterr().out
    assert "heard output" in out
    assert "seen 5" in out
    assert quiet.trace is not None
    assert loud.trace is not None
    assert list(loud.trace) == list(quiet.trace)


def test_another_thread_may_print_while_agents_run(capsys: pytest.CaptureFixture[str]) -> None:
    simulation = Simulation(Scene(), bodiless={"mind": load_text(THREADED, "threaded.py").Threaded}, trace="all")
    simulation.run(0.02)
    assert capsys.readouterr().out == "elsewhere\n"
    assert simulation.trace is not None
    assert lines_in(simulation.trace) == []


def test_an_agent_may_print_elsewhere(capsys: pytest.CaptureFixture[str]) -> None:
    before, aside = sys.stdout, io.StringIO()
    simulation = talking()
    simulation.agents["talker"].aside = aside
    for _ in range(20):
        simulation.step()
    assert aside.getvalue().count("aside") > 6
    assert sys.stdout is before
    assert "aside" not in capsys.readouterr().out
    assert simulation.trace is not None
    assert all("aside" not in text for _, text in lines_in(simulation.trace))


def test_output_goes_where_the_program_redirects_it(capsys: pytest.CaptureFixture[str]) -> None:
    simulation, out = talking(), io.TextIOWrapper(io.BytesIO(), write_through=True)
    simulation.step()
    with redirect_stdout(out):
        simulation.tick()
        simulation.tock()
    simulation.step()
    assert out.buffer.getvalue() == b"\nbytes\n"  # type: ignore[attr-defined]
    assert capsys.readouterr().out.startswith("made\nnumber 0")


def test_a_line_printed_to_an_output_that_the_file_has_kept_is_recorded_too(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "talker.py"
    file.write_text(TALKER.replace('print("number"', 'print("kept", file=kept); print("number"'), encoding="utf-8")
    assert main(["run", str(file), "--seed", "1", "--record", str(tmp_path / "run")]) == 0
    assert capfd.readouterr().out.count("kept") == 6
    assert sum('"text": "kept"' in line for line in recorded(tmp_path / "run")) == 6
    assert main(["replay", str(tmp_path / "run")]) == 0


def test_a_run_that_continues_after_its_recording_was_closed_keeps_nothing_for_it(tmp_path: Path) -> None:
    simulation = talking("none")
    with simulation.record(tmp_path / "run") as recording:
        simulation.run(0.05)
    simulation.run(0.05)
    simulation.seek(0.02)
    simulation.command("parameter", "talker.most", 3)
    assert recording.states == 6
    assert not recording._writer.states
    with Recorded(tmp_path / "run") as file:
        assert file.ticks == 5
