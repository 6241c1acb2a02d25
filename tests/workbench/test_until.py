"""«Run until» and breakpoints by name: what there is not is refused before anything runs, and what does not come is told at the end."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.helpers.sessions import Desk, RefusedError
from tests.helpers.workbench_server import MODELS
from workbench.time_text import time_text

DOORWAY = (MODELS / "doorway.py").read_text(encoding="utf-8")
COUNTING = (MODELS / "counting.py").read_text(encoding="utf-8")


@pytest.mark.daily(3)
@pytest.mark.parametrize(
    ("wanted", "told"),
    [
        ({"production": "trun"}, "production: no production 'trun'; did you mean 'turn'?"),
        ({"production": "zzz"}, "no production 'zzz'; there are: feel, judge, look, stop_behind, turn, walk_on"),
        ({"production": "turn-trun-1"}, "no production 'turn-trun-1'"),
        ({"buffer": "walker.gaol", "pattern": "pass"}, "buffer: no buffer 'walker.gaol'; did you mean 'walker.goal'?"),
        ({"buffer": "walker.goal", "pattern": "a:b c"}, "pattern: 'c' without a slot's name after the named slot 'a' in pattern 'a:b c'"),
        ({"buffer": "walker.goal", "pattern": "a:"}, "no value for slot 'a' in pattern 'a:'"),
        ({"buffer": "gaol", "pattern": "pass"}, "no buffer 'gaol'; did you mean 'goal'?"),
        ({"buffer": "nosuch", "pattern": "pass"}, "no buffer 'nosuch'; there are: felt, goal, seen"),
        ({"contact": "waker"}, "contact: no body 'waker'; did you mean 'walker'?"),
    ],
)
def test_what_there_is_not_is_refused_before_anything_runs(desk: Desk, tmp_path: Path, wanted: dict[str, Any], told: str) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    with pytest.raises(RefusedError) as error:
        talk.say("until", **wanted)
    assert told in str(error.value)
    assert (talk.state["status"], talk.state["time"]) == ("paused", 0.0)
    talk.say("until", time=0.02)  # and it goes on
    talk.until("paused", tick=2)


@pytest.mark.daily(2)
@pytest.mark.parametrize(
    ("wanted", "told"),
    [
        ({"production": "turn"}, "turn did not fire"),
        ({"buffer": "walker.goal", "pattern": "never"}, "walker.goal did not come to match 'never'"),
        ({"buffer": "goal", "pattern": "never"}, "goal did not come to match 'never'"),
        ({"contact": ""}, "no body touched anything more"),
        ({"contact": "walker"}, "walker touched nothing more"),
    ],
)
def test_a_condition_that_was_not_met_is_reported_at_the_end(desk: Desk, tmp_path: Path, wanted: dict[str, Any], told: str) -> None:
    talk = desk.begin(tmp_path, DOORWAY, settings={"width": 0.9})
    talk.say("until", **wanted)
    assert talk.until("ended")["reason"] == f"the model called stop(); {told}"
    talk.say("seek", time=1.0)
    talk.until("paused", time=1.0)
    talk.say("run")
    assert talk.until("ended")["reason"] == "the model called stop()"


def test_names_are_read_from_the_text_of_a_program_that_has_not_begun(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING)
    with pytest.raises(RefusedError, match="no production 'count_no'; did you mean 'count_on'"):
        talk.say("until", production="count_no")
    with pytest.raises(RefusedError, match="no body in this run"):
        talk.say("until", contact="")
    talk.say("until", production="count_on")
    talk.wait(lambda: talk.state["reason"] == "count_on fired")
    with pytest.raises(RefusedError, match="no buffer 'gaol'; did you mean 'goal'"):
        talk.say("until", buffer="gaol", pattern="x")
    talk.say("until", buffer="goal", pattern="task:count number:4")
    talk.wait(lambda: talk.state["reason"] == "goal matches 'task:count number:4'")
    talk.say("until", buffer="goal#2", pattern="x")  # of a model that may come
    assert talk.until("ended")["reason"] == "the program is over; goal#2 did not come to match 'x'"


def test_models_of_helper_modules_may_come_later(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "agents.py").write_text(COUNTING.partition("if __name__")[0], encoding="utf-8")
    talk = desk.begin(tmp_path, "from agents import Counting\n\nCounting().run(5)\n")
    talk.say("until", production="count_on")
    talk.wait(lambda: talk.state["reason"] == "count_on fired")


@pytest.mark.parametrize("name", ["start_counting-count_on-1", "count_on"])
def test_what_is_learned_has_a_name_before_it_is_there(desk: Desk, tmp_path: Path, name: str) -> None:
    talk = desk.begin(tmp_path, COUNTING)
    talk.say("breakpoints", productions=[name])
    assert talk.facts["breakpoints"] == [name]


def test_a_breakpoint_on_what_there_is_not_is_refused_and_one_that_an_edit_has_lost_is_kept(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    with pytest.raises(RefusedError, match="no production 'trun'; did you mean 'turn'"):
        talk.say("breakpoints", productions=["look", "trun"])
    assert talk.facts["breakpoints"] == []
    talk.say("breakpoints", productions=["turn"])
    (tmp_path / "model.py").write_text(DOORWAY.replace("def turn(", "def turn_now("), encoding="utf-8")
    talk.say("restart")
    told = talk.wait_for_notice("the breakpoint on turn is kept")
    assert "no production 'turn'; did you mean 'turn_now'?" in told["text"]
    assert told["level"] == "warning"
    talk.wait(lambda: talk.facts["run"] == 2)
    talk.say("breakpoints", productions=["turn", "turn_now"])  # the lost one is no hindrance
    assert talk.facts["breakpoints"] == ["turn", "turn_now"]
    talk.say("run")
    talk.wait(lambda: talk.state["reason"] == "breakpoint: turn_now fired")
    assert talk.state["breakpoint"] == "turn_now"
    time = talk.state["time"]
    talk.say("seek", time=0)
    talk.until("paused", time=0)
    assert talk.state["breakpoint"] is None
    talk.say("until", time=time + 0.01)
    talk.wait(lambda: talk.state["breakpoint"] == "turn_now")
    talk.say("command", word="set_buffer", named={"buffer": "walker.goal", "chunk": "other"})
    talk.wait(lambda: talk.state["breakpoint"] is None)


SLOTS = """
from actr3d.actr import *

class {name}(ACTR):
    goal = Buffer()
    def init():
        goal.set({chunk})
    def go_on(goal="state:begin"):
        goal.set("state:middle")
    def end(goal="state:middle"):
        goal.set("state:end")

{name}().run()
"""


def test_a_slot_that_no_chunk_can_have_is_refused_with_what_is_like_it(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOTS.format(name="Plain", chunk="'state:begin'"))
    talk.say("step")
    talk.until("paused", tick=1)
    for wrong in ("stat:end", "state:end stat:?x", "statt:!end"):
        with pytest.raises(RefusedError, match=r"no chunk of this model can have a slot 'statt?'; did you mean 'state'\?"):
            talk.say("until", buffer="goal", pattern=wrong)
    with pytest.raises(RefusedError, match=r"no chunk of this model can have a slot 'zzz'; there are: state"):
        talk.say("until", buffer="goal", pattern="zzz:1")
    talk.say("until", buffer="goal", pattern="state:end")
    assert talk.until("ended")["reason"] == "the program is over; goal matches 'state:end'"  # both at once


def test_a_state_of_a_module_is_no_slot(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    with pytest.raises(RefusedError, match="no chunk of this model can have a slot 'busy'") as caught:
        talk.say("until", buffer="goal", pattern="busy:True")
    assert "there are: busy" not in str(caught.value)
    talk.say("until", buffer="seen", pattern="seen:!x")  # a port puts what it was answered there


def test_of_many_slots_it_is_said_how_many_are_not_named(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOTS.format(name="Many", chunk="'state:begin " + " ".join(f"s{n}:1" for n in range(20)) + "'"))
    talk.say("step")
    talk.until("paused", tick=1)
    with pytest.raises(RefusedError, match=r"there are: s0, s1, .*, s8 and 9 more|there are: s0, .* and 9 more"):
        talk.say("until", buffer="goal", pattern="zzz:1")


def test_a_slot_whose_name_is_computed_is_let_through(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOTS.format(name="Computes", chunk="'state:begin ' + ' '.join(f'{a}{b}:1' for a, b in [('al', 'pha')])"))
    talk.say("until", buffer="goal", pattern="alpha:1")
    talk.wait(lambda: talk.state["reason"] == "goal matches 'alpha:1'")


IDLE = """from actr3d.actr import *

class Idle(ACTR):
    goal = Buffer()

Idle().run(8000)
"""


def test_from_an_hour_on_times_are_in_hours_minutes_and_seconds(desk: Desk, tmp_path: Path) -> None:
    assert [time_text(time) for time in (0.5, 2.0, 3599.9, 3600.0, 4512.3)] == ["0.5 s", "2 s", "3599.9 s", "1:00:00", "1:15:12.30"]
    assert [time_text(time, 2) for time in (0.5, 3600.0)] == ["0.50 s", "1:00:00.00"]
    assert time_text(62.5, longest=3600.0) == "0:01:02.50"
    talk = desk.begin(tmp_path, IDLE)
    talk.say("until", time=4512.3)
    talk.wait(lambda: talk.state["reason"] == "at 1:15:12.30")
    with pytest.raises(RefusedError, match=r"time: must be after the present one, 1:15:12\.30;"):
        talk.say("until", time=7)


def test_what_a_run_goes_on_for_is_shown_while_it_goes_on(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY, settings={"width": 0.9})
    talk.say("speed", factor=0.05)
    talk.say("until", buffer="goal", pattern="never")
    talk.wait(lambda: (talk.state["status"], talk.state["reason"]) == ("running", "until goal matches 'never'"))
    talk.say("until", time=1.5, production="turn")
    talk.wait(lambda: (talk.state["status"], talk.state["reason"]) == ("running", "until 1.5 s or turn fires"))
    talk.say("run")
    talk.wait(lambda: (talk.state["status"], talk.state["reason"]) == ("running", ""))
