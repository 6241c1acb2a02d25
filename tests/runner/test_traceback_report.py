"""Errors are reported at the line that caused them, even if another line was running."""

from __future__ import annotations

import pytest

from actr3d.actr.loading import load_text, run_text
from actr3d.errors import Actr3dError, WorldError
from actr3d.runner.traceback_report import TracebackReport, traceback_report
from actr3d.world.body import Body

WALKER = """
from actr3d.actr import *
from actr3d.motor import Motor
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    felt = Buffer()
    skin = BodyPort(felt)
    motor = Motor()

    def init():
        goal.set("go")
        {first}

    def go(goal="go"):
        goal.set("gone")
        {statement}

    def later(self):
        yield 0.1
        self.skin.set("hop")

    def hop(self):
        self.skin.set("hop")

simulation = Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {{"walker": Walker}})
"""
RESPONDER = """
from actr3d.actr import *

class Responder(ACTR):
    goal = Buffer()

    def init():
        goal.set("task:wait")

    def respond({head}):
        {statement}

Responder().run()
"""


def reported(text: str, kind: type[Exception] = Actr3dError) -> TracebackReport:
    """Returns the report of the error of a program."""
    with pytest.raises(kind) as caught:
        run_text(text, "mine.py")
    return traceback_report(caught.value)


def line_of(text: str, part: str) -> int:
    """Returns the number of the line that contains a text."""
    return 1 + next(n for n, line in enumerate(text.split("\n")) if part in line)


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ('skin.set("walk_to", 3, 1.5)', "no actuator 'walk_to'"),
        ('skin.set("walk", "fast")', "speed: must be a number"),
        ('skin.set("heading", 40)', "did you mean 40 degrees"),
        ('skin.request("psoe")', "no sensor 'psoe'; did you mean 'pose'"),
        ('skin.get("view", azimuth=1)', "no field 'azimuth'"),
        ('motor.rotate("elbwo", 1)', "no jointed part 'elbwo'"),
    ],
)
def test_a_wrong_request_is_reported_at_the_statement_of_its_production(statement: str, message: str) -> None:
    text = WALKER.format(first="pass", statement=statement) + "simulation.run(0.2)\n"
    report = reported(text)
    assert (report.file, report.line) == ("mine.py", line_of(text, statement))
    assert message in report.message
    assert "in production 'go' (mine.py:" in report.message


def test_an_unknown_name_is_reported_with_a_similar_one_that_names_the_same_kind_of_thing() -> None:
    with pytest.raises(NameError) as caught:
        run_text("from actr3d.actr import *\nx = MemoryNoise\n", "mine.py")
    report = traceback_report(caught.value)
    assert report.message == "NameError: name 'MemoryNoise' is not defined; did you mean 'DMNoise'?"
    assert report.text.endswith(f"\n{report.message}\n")


@pytest.mark.parametrize(
    ("statement", "message", "package"),
    [
        ("Vision(Buffer())", "Vision(visual, location): missing a required argument: 'location'", "vision"),
        ("Vision(Buffer(), Buffer()).request('feature:obstacle')", "'Vision' object has no attribute 'request'", "vision"),
        ("Motor().walk(1.2)", "'Motor' object has no attribute 'walk'", "motor"),
    ],
)
def test_a_module_for_agents_without_a_body_names_the_one_for_agents_with_a_body(statement: str, message: str, package: str) -> None:
    with pytest.raises((AttributeError, Actr3dError)) as caught:
        run_text(f"from actr3d.actr import *\n{statement}\n", "mine.py")
    report = traceback_report(caught.value)
    kind = statement.partition("(")[0]
    assert f"{message}; for an agent with a body: from actr3d.{package} import {kind}, after from actr3d.actr import *" in report.message
    assert report.text.endswith(f"{report.message}\n")


TAKES_TIME = """from actr3d.actr import *


class Reader(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    imaginal = Buffer()
    picture = ImaginalModule(imaginal)

    def init():
        goal.set("look")

    def look(goal="look"):
        goal.set("wait")
        {call}


Reader().run()
"""


def test_a_wrong_request_is_reported_at_its_line_where_no_line_of_a_model_is_running() -> None:
    text = WALKER.format(first="pass", statement='skin.set("walk_to", 3, 1.5)')
    module = load_text(text, "mine.py")
    with pytest.raises(Actr3dError) as caught:
        module.simulation.run(0.2)
    report = traceback_report(caught.value, __file__)
    assert (report.file, report.line) == ("mine.py", line_of(text, "walk_to"))


def test_a_command_to_the_motor_that_waited_for_the_body_is_reported_at_its_line() -> None:
    text = WALKER.format(first='motor.rotate("elbwo", 1)', statement="pass") + "simulation.run(0.2)\n"
    report = reported(text)
    assert (report.file, report.line) == ("mine.py", line_of(text, "elbwo"))
    assert f"requested by 'walker.motor' in production 'init' (mine.py:{report.line})" in report.message


@pytest.mark.parametrize(("statement", "nth"), [("self.later()", 0), ("self.hop()", 1)])
def test_a_wrong_request_of_a_method_is_reported_at_the_line_in_the_method(statement: str, nth: int) -> None:
    text = WALKER.format(first="pass", statement=statement) + "simulation.run(0.2)\n"
    report = reported(text)
    lines = [n for n, line in enumerate(text.split("\n"), 1) if 'self.skin.set("hop")' in line]
    assert (report.file, report.line) == ("mine.py", lines[nth])
    assert ("in production 'go'" in report.message) == (nth == 1)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        ("picture.set()", "missing 1 required positional argument: 'chunk'"),
        ("picture.modify(a=1)", "buffer 'imaginal' is empty"),
        ("memory.recall('a')", "missing 2 required positional arguments"),
    ],
)
def test_a_wrong_call_that_takes_time_is_reported_at_its_line(call: str, says: str) -> None:
    text = TAKES_TIME.format(call=call)
    report = reported(text, Exception)
    assert (report.file, report.line) == ("mine.py", line_of(text, call))
    assert says in report.message
    assert "production 'look'" in report.message


def test_a_request_of_a_module_s_own_is_reported_at_no_line_of_the_model(monkeypatch: pytest.MonkeyPatch) -> None:
    module = load_text(WALKER.format(first="pass", statement="pass"), "mine.py")

    def broken(body: Body, sensor: str, *_: object) -> None:
        raise WorldError(f"{body.name} has no {sensor}")

    monkeypatch.setattr(Body, "get", broken)
    with pytest.raises(WorldError) as caught:
        module.simulation.run(0.1)
    report = traceback_report(caught.value, __file__)
    assert report.message == "walker has no anatomy\n  requested by 'walker.motor'"
    assert (report.file, report.line) == (None, None)


@pytest.mark.parametrize(
    ("head", "statement", "message"),
    [
        ('goal="task:wait ink?ink:"', "pass", "ink?ink:"),
        ('gaol="task:wait"', "pass", "did you mean 'goal'"),
        ('goal="task:wait"', "yield 1", "production 'respond' yields"),
    ],
)
def test_an_error_in_the_head_of_a_production_is_reported_at_its_line(head: str, statement: str, message: str) -> None:
    text = RESPONDER.format(head=head, statement=statement)
    report = reported(text)
    assert (report.file, report.line) == ("mine.py", line_of(text, statement if "yield" in statement else "def respond"))
    assert message in report.message


def test_an_error_that_a_production_raises_names_the_production() -> None:
    text = RESPONDER.format(head='goal="task:wait"', statement='goal.set("a:?noth" + "ing")')
    report = reported(text)
    assert (report.file, report.line) == ("mine.py", line_of(text, "?noth"))
    assert "\nin production 'respond' (mine.py:" in report.message


def test_a_wrong_part_of_a_scene_is_reported_at_the_line_that_makes_it() -> None:
    text = 'from actr3d.world import SimpleObject\n\nbox = SimpleObject(\n    name="box", position=(3, 0)\n)\n'
    report = reported(text)
    assert (report.file, report.line) == ("mine.py", 3)
    assert "<string>" not in report.text
