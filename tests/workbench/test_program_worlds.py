"""Programs that make their own simulations, as the examples of the README do: they are shown, and go back, like any other."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from tests.helpers.sessions import Desk, RefusedError, Talk
from tests.workbench.html_replay.test_html_replay import inside, numbers
from workbench.csv_files import write_states_csv
from workbench.exports import curves_of
from workbench.html_replay.make import write_replay
from workbench.recording_diff import compare
from workbench.recording_index import summary_json
from workbench.retention import copied_from

EXAMPLE = """from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.vision import Vision
from actr3d.world import Aperture, Floor, Mannequin, Scene, Wall

class Walker(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual, horizontal_fov=1.2)
    body = BodyPort()
    def init():
        goal.set("judge")
    def ask(goal="judge"):
        vision.request("feature:opening", width=">0.5")
        goal.set("wait")
    def go(goal="wait", visual="feature:opening width:?w"):
        print(f"{w} m wide")
        body.set("walk", 1.2)
        goal.set("walk")
    def walk(goal="walk", visual="feature:opening"):
        vision.request("feature:opening", width=">0.5")
        visual.clear()
"""
ONE = (
    EXAMPLE
    + """
print("begins")
scene = Scene(parts=(Floor(), Aperture(width=0.7), Mannequin(name="walker")))
Simulation(scene, {"walker": Walker}, seed=1).run(1.5)
print("is over")
"""
)
TRIALS = (
    EXAMPLE
    + """
class Silent(ACTR):
    goal = Buffer()
    def init():
        goal.set("x")
    def once(goal="x"):
        goal.set("y")
Silent().run(0.1)
for width in (0.6, 0.9):
    walls = [Wall(name=f"wall{n}", start=(8, n), end=(9, n)) for n in range(int(10 * width) - 5)]
    parts = (Floor(), Aperture(width=width), Mannequin(name="walker"), *walls)
    Simulation(Scene(parts=parts), {"walker": Walker}).run(0.4)
"""
)
MANY = """
for _ in range(6):
    Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker}).run(0.04)
"""
UNSTEPPED = TRIALS.replace("Silent().run(0.1)", "Simulation(Scene(parts=(Floor(), Mannequin(name='walker'))), {'walker': Walker}).run(0)")
KINDS = ("frustum", "edges", "features", "path", "posture")


def told(talk: Talk) -> dict[str, Any]:
    """Returns what is shown of the present."""
    state, session = talk.state, talk.session
    assert session.state is not None
    assert session.facts is not None
    now = {name: state[name] for name in ("tick", "time", "apertures", "parts", "events")}
    drawn = {kind: repr(value) for kind, value in session.state.overlay_data.items()}
    now |= {"physics": session.state.physics, "drawn": drawn, "world": session.facts.world, "mj_model": session.facts.mj_model}
    asked: list[dict[str, Any]] = [{"type": "explain"}, {"type": "events"}]
    asked += [{"type": kind, "body": "walker"} for kind in ("view", "body")] if session.state.physics is not None else []
    answers = {str(one): talk.say(one["type"], **{name: value for name, value in one.items() if name != "type"}) for one in asked}
    curves = talk.say("curves", most=5_000)
    upto = [n for n, at in enumerate(curves["times"]) if at <= state["time"]]
    known = {name: [values[n] for n in upto] for name, values in curves["curves"].items()}
    return now | answers | {"curves": {name: values for name, values in known.items() if any(value is not None for value in values)}}


def draw(talk: Talk) -> None:
    async def ask() -> None:
        talk.sessions._views[talk.session.name]._task.cancel()
        talk.session.draw(KINDS)

    talk.desk.do(ask())


def test_a_program_that_makes_a_simulation_stands_at_its_start_with_its_scene(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, ONE)
    assert talk.session.facts is not None
    assert talk.session.facts.mj_model is not None
    assert (talk.facts["kind"], list(talk.facts["world"]["bodies"]), talk.facts["world"]["widths"]) == (
        "program",
        ["walker"],
        {"aperture": [0, 300]},
    )
    assert (talk.state["time"], talk.state["apertures"]) == (0, {"aperture": pytest.approx(0.7)})
    assert [event[3]["text"] for event in talk.events if event[2] == "output"] == ["begins"]
    assert talk.say("view")["extents"]
    assert talk.say("body")["joints"]
    assert [*talk.state["parts"]][:2] == ["walker", "walker.body"]


def test_pages_know_the_widths_at_the_start_of_every_simulation(desk: Desk, tmp_path: Path) -> None:
    widths = TRIALS.replace("(0.6, 0.9)", "(0.6, 0.6, 0.9)").replace("run(0.4)", "run(0.01)")
    talk = desk.begin(tmp_path, widths, run=True, wait="ended")
    known = [[2, {"aperture": 0.6}], [4, {"aperture": 0.9}]]
    assert talk.facts["initial_widths"] == known
    talk.say("seek", time=0.1)
    talk.until("paused", time=0.1)
    assert talk.facts["initial_widths"] == known, "events that lie ahead are shown, too"


def test_its_steps_are_ticks_and_what_it_was_is_shown_again_where_it_goes_back(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, ONE)
    draw(talk)
    talk.wait(lambda: talk.session.state is not None and talk.session.state.overlay_data)
    seen = {0.0: told(talk)}
    for ticks in (1, 20, 7):
        talk.say("step", ticks=ticks)
        now = talk.until("paused", time=round(max(seen) + ticks / 100, 6))
        seen[now["time"]] = told(talk)
    talk.say("until", time=1.2)
    talk.until("paused", time=1.2)
    seen[1.2] = told(talk)
    assert seen[1.2]["drawn"]["path"] != seen[0.28]["drawn"]["path"]
    talk.say("run")
    assert talk.until("ended", time=1.5)["reason"] == "the program is over"
    assert [event[3]["text"] for event in talk.events if event[2] == "output"] == ["begins", "0.7 m wide", "is over"]
    for time in (0.28, 1.2, 0.0, 0.01):
        talk.say("seek", time=time)
        talk.until("paused", time=time)
        now = told(talk)
        assert [name for name in now if now[name] != seen[time][name]] == [], f"at {time} s"
    talk.say("step", ticks=20)
    talk.until("paused", time=0.21)
    talk.say("back", ticks=20)
    talk.until("paused", time=0.01)
    assert told(talk) == seen[0.01]


@pytest.mark.slow
@pytest.mark.parametrize(("source", "begun"), [(ONE, [0]), (TRIALS, [0.1, 0.5]), (UNSTEPPED, [0, 0.4])], ids=["one", "trials", "unstepped"])
def test_a_recording_has_the_curves_of_the_simulations_of_its_program_opened_or_not(
    desk: Desk, tmp_path: Path, source: str, begun: list[float]
) -> None:
    talk = desk.begin(tmp_path, source, record=True)
    talk.say("run")
    talk.until("ended")
    curves = talk.say("curves", most=5_000)
    path = talk.sessions.recordings.path(talk.session.recording or "")
    assert curves_of(path, names=None, first=0.0, most=5_000) == curves
    write_replay(path, tmp_path / "replay.html")
    scenes = inside((tmp_path / "replay.html").read_text(encoding="utf-8"))["scenes"]
    times = [numbers(scene["times"]) for scene in scenes]
    assert [time[0] for time in times] == pytest.approx(begun)
    walked = [value for value in curves["curves"]["walker x"] if value is not None]
    poses = numbers(scenes[-1]["poses"]).reshape(len(times[-1]), -1, 7)
    assert (times[-1][-1], poses[-1, scenes[-1]["stage"]["follow"], 0]) == pytest.approx((curves["times"][-1], walked[-1]), abs=1e-4)
    write_states_csv(path, tmp_path / "states.csv")
    with (tmp_path / "states.csv").open(encoding="utf-8", newline="") as file:
        heads = [row for row in csv.reader(file) if row[0] == "run"]
    assert len(heads) == len(begun) + (source is UNSTEPPED)
    assert [name for head in heads for name in head if name.startswith("state_")] == []  # every number has a name
    opened = Talk(desk, desk.do(talk.sessions.reopen(talk.session.recording or "")), talk.sessions)
    opened.until("paused", time=0)
    opened.say("until", time=0.12)
    opened.until("paused", time=0.12)
    known = opened.say("curves", most=5_000)
    many = len(known["times"])
    assert many == (151 if source is ONE else 41)
    assert known["times"] == curves["times"][:many]
    assert known["curves"] == {name: curves["curves"][name][:many] for name in known["curves"]}
    opened.say("run")
    opened.until("ended")
    assert opened.say("curves", most=5_000) == curves


def test_what_a_recording_knew_is_forgotten_where_its_program_goes_another_way(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "walking.txt").write_text("1.2", encoding="utf-8")
    source = ONE.replace('body.set("walk", 1.2)', f'body.set("walk", float(open({str(tmp_path / "walking.txt")!r}).read()))')
    talk = desk.begin(tmp_path, source, record=True)
    talk.say("run")
    talk.until("ended")
    curves = talk.say("curves", most=5_000)["curves"]
    (tmp_path / "walking.txt").write_text("0.6", encoding="utf-8")
    opened = Talk(desk, desk.do(talk.sessions.reopen(talk.session.recording or "")), talk.sessions)
    opened.until("paused", time=0)
    opened.say("run")
    opened.until("ended")
    now = opened.say("curves", most=5_000)["curves"]
    assert now["walker x"][:15] == curves["walker x"][:15]
    assert now["walker x"][-1] < 0.7 * curves["walker x"][-1]


def test_a_program_stops_where_a_body_touches_something(desk: Desk, tmp_path: Path) -> None:
    source = ONE.replace("Scene(parts=(", "Scene(parts=(Wall(name='w', start=(0.6, -2), end=(0.6, 2)), ")
    talk = desk.begin(tmp_path, source.replace('goal.set("wait")', 'goal.set("wait")\n        body.set("walk", 1.2)'))
    talk.say("until", contact="walker")
    talk.wait(lambda: "touches w" in talk.state["reason"])
    with pytest.raises(RefusedError, match="no body 'walkr'; did you mean 'walker'"):
        talk.say("until", contact="walkr")


def test_of_several_simulations_the_latest_is_shown_and_the_scene_changes_with_the_time(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, TRIALS)
    seen: dict[float, Any] = {}
    for time in (0.05, 0.3, 0.5, 0.55, 0.8):
        talk.say("until", time=time)
        talk.until("paused", time=time)
        seen[time] = told(talk)
    widths = [[round(width, 6) for width in now["apertures"].values()] for now in seen.values()]
    assert widths == [[], [0.6], [0.6], [0.9], [0.9]]
    assert len({seen[time]["mj_model"] for time in seen}) == 3
    parts, sources = talk.state["parts"], {event[1] for event in talk.events}
    assert {"top#3.walker.goal", "top#2.walker.goal", "goal"} < parts.keys() & sources
    assert talk.say("explain", agent="top#3.walker")[0]["agent"] == "top#3.walker"
    curves = talk.say("curves", most=5_000)
    for time in (0.3, 0.8, 0.05, 0.55):
        talk.say("seek", time=time)
        talk.until("paused", time=time)
        now = told(talk)
        assert [name for name in now if now[name] != seen[time][name]] == [], f"at {time} s"
        assert talk.say("curves", most=5_000) == curves  # of all simulations, also of those that are not there yet


def test_of_more_simulations_than_are_kept_those_near_the_present_keep_their_past_and_future(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, EXAMPLE + MANY)
    talk.say("run")
    talk.until("ended", time=0.24)

    def third() -> dict[float, float | None]:
        curves = talk.say("curves", most=5_000)
        return {time: x for time, x in zip(curves["times"], curves["curves"]["walker x"], strict=True) if 0.081 < time < 0.119}

    before = third()
    assert len(before) >= 3
    assert None not in before.values()
    talk.say("seek", time=0.09)
    talk.until("paused", time=0.09)
    assert third() == before


def recorded_commands(path: Path) -> list[Any]:
    """Returns the commands of a recording, which its replay repeats exactly."""
    with Recorded(path) as recorded:
        assert replay(recorded).difference is None
        return [(command.run, command.tick, command.data["command"], command.data.get("by")) for command in recorded.commands()]


def test_the_world_of_a_program_is_changed_by_hand_and_the_change_is_repeated_and_undone(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, ONE, record=True)
    assert talk.facts["world"]["objects"] == ["walker"]
    assert {one["of"] for one in talk.facts["changes"]} > {"object", "aperture", "buffer"}
    draw(talk)
    seen: dict[float, Any] = {}
    for time, word, values in ((0.0, "aperture", [0.9]), (0.2, "move", ["walker", 0.5, 0.25]), (0.4, "push", ["walker", 90, 0.1])):
        if time > 0:
            talk.say("until", time=time)
            talk.until("paused", time=time)
        talk.say("command", word=word, values=values)
    assert talk.state["apertures"] == {"aperture": pytest.approx(0.9)}
    for time in (0.3, 0.7):
        talk.say("until" if time > 0.4 else "seek", time=time)
        talk.until("paused", time=time)
        seen[time] = told(talk)
    moved = dict(zip(talk.say("curves", most=5_000)["times"], talk.say("curves", most=5_000)["curves"]["walker y"], strict=True))
    assert moved[0.2] == pytest.approx(0, abs=0.02)
    assert moved[0.21] == pytest.approx(0.25, abs=0.02)
    assert [data["command"] for _, _, kind, data in talk.events if kind == "command"] == ["aperture", "move", "push"]
    for time in (0.3, 0.7, 0.3):
        talk.say("seek", time=time)
        talk.until("paused", time=time)
        now = told(talk)
        assert [name for name in now if now[name] != seen[time][name]] == [], f"at {time} s"
    talk.say("undo")
    assert talk.until("paused", time=0.2, furthest=0.2)["reason"] == "undone at 0.20 s"
    assert [data["command"] for _, _, kind, data in talk.say("events")["events"] if kind == "command"] == ["aperture"]
    talk.say("until", time=0.3)
    talk.until("paused", time=0.3)
    assert max(value for value in talk.say("curves", most=5_000)["curves"]["walker y"] if value is not None) < 0.1
    path = talk.sessions.recordings.path(talk.session.recording or "")
    desk.do(talk.session.close())
    (branch,) = [one for one in path.parent.glob("*.sqlite") if copied_from(one.stem) is not None]
    assert recorded_commands(path) == [(1, 0, "aperture", "user")]
    assert recorded_commands(branch) == [(1, 0, "aperture", "user"), (1, 20, "move", "user"), (1, 40, "push", "user")]
    assert json.loads(summary_json(branch, talk.sessions.folder))["change"]["command"] == "move"  # the first one from 0.2 s on


def test_of_several_simulations_the_agents_of_the_present_one_are_changed_by_their_names_in_the_program(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, TRIALS, record=True)
    talk.say("until", time=0.5)
    talk.until("paused", time=0.5)  # at the end of the first simulation
    talk.say("command", word="aperture", values=[0.65])
    talk.say("step", ticks=1)
    talk.until("paused", time=0.51)
    with pytest.raises(RefusedError, match=r"'walker\.goal' is not in the simulation that runs at this moment, 'top#3'"):
        talk.say("command", word="set_buffer", values=["walker.goal", "other"])
    with pytest.raises(RefusedError, match=r"'top#2\.walker\.goal' is not in the simulation that runs at this moment, 'top#3'"):
        talk.say("command", word="set_buffer", named={"buffer": "top#2.walker.goal", "chunk": "other"})
    talk.say("command", word="set_buffer", named={"buffer": "top#3.walker.goal", "chunk": "other"})
    assert [talk.state["parts"][f"top#{n}.walker.goal"]["chunk"] for n in (2, 3)] == [{"0": "walk"}, {"0": "other"}]
    talk.say("run")
    talk.until("ended")
    first = talk.say("events", most=20_000)["events"]
    assert [(source, data["data"]["named"]) for _, source, kind, data in first if kind == "command"] == [
        ("top#2", {}), ("top#3", {"buffer": "top#3.walker.goal", "chunk": "other"})
    ]  # fmt: skip
    talk.say("seek", time=0.2)
    talk.until("paused", time=0.2)
    talk.say("run")
    talk.until("ended")
    assert talk.say("events", most=20_000)["events"] == first
    path = talk.sessions.recordings.path(talk.session.recording or "")
    desk.do(talk.session.close())
    assert recorded_commands(path) == [(2, 40, "aperture", "user"), (3, 1, "set_buffer", "user")]


def test_changes_at_the_start_of_a_simulation_come_after_those_at_the_end_of_the_one_before(desk: Desk, tmp_path: Path) -> None:
    walls = "Simulation(Scene(parts=(Floor(), Mannequin(name='walker')))).run(0.04)\n"
    minds = "Simulation(Scene(parts=(Floor(), Aperture(width=0.9))), bodiless={'mind': Walker}).run(0.04)\n"
    talk = desk.begin(tmp_path, EXAMPLE.replace("BodyPort()", "Buffer()") + walls + minds, record=True)
    talk.say("until", time=0.04)
    talk.until("paused", time=0.04)
    talk.say("command", word="move", values=["walker", 0.5, 0.5])
    talk.say("until", buffer="top#2.mind.goal")
    talk.wait(lambda: talk.state["status"] == "paused" and talk.state["apertures"])
    assert (talk.state["time"], talk.state["apertures"]) == (0.04, {"aperture": pytest.approx(0.9)})
    for width in (0.8, 0.7):
        talk.say("command", word="aperture", values=[width])
    talk.say("run")
    talk.until("ended", time=0.08)

    def given() -> list[list[Any]]:
        return [data["data"]["values"] for _, _, kind, data in talk.say("events")["events"] if kind == "command"]

    move = ["walker", 0.5, 0.5]
    assert given() == [move, [0.8], [0.7]]
    talk.say("undo")
    talk.until("paused", time=0.04, furthest=0.04)
    assert (talk.state["apertures"], given()) == ({"aperture": pytest.approx(0.8)}, [move, [0.8]])
    talk.say("undo")
    talk.wait(lambda: talk.state["apertures"] == {})  # at the end of the simulation before
    assert given() == [move]
    talk.say("run")
    talk.until("ended", time=0.08)
    assert talk.state["apertures"] == {"aperture": pytest.approx(0.9)}
    path = talk.sessions.recordings.path(talk.session.recording or "")
    desk.do(talk.session.close())
    assert recorded_commands(path) == [(1, 4, "move", "user")]


@pytest.mark.slow
def test_commands_of_a_program_itself_are_repeated_by_the_program_and_are_not_undone(desk: Desk, tmp_path: Path) -> None:
    source = (
        EXAMPLE
        + """
simulation = Simulation(Scene(parts=(Floor(), Aperture(width=0.7), Mannequin(name="walker"))), {"walker": Walker}, seed=1)
simulation.run(0.1)
simulation.command("aperture", 0.8)
simulation.run(0.1)
"""
    )
    talk = desk.begin(tmp_path, source, record=True)
    talk.say("until", time=0.1)
    talk.until("paused", time=0.1)
    talk.say("command", word="aperture", values=[0.5])
    talk.say("run")
    talk.until("ended")
    assert talk.state["apertures"] == {"aperture": pytest.approx(0.8)}
    path = talk.sessions.recordings.path(talk.session.recording or "")
    assert recorded_commands(path) == [(1, 10, "aperture", "user"), (1, 10, "aperture", None)]
    compared = compare(path, path)
    assert (compared["changed"], compared["units"]) == ([{"aperture": [[0.1, 0.5]]}] * 2, {"aperture": "m"})
    opened = Talk(desk, desk.do(talk.sessions.reopen(path.stem)), talk.sessions)
    opened.until("paused", time=0)
    opened.say("run")
    opened.until("ended")
    assert not [notice for notice in opened.notices if "differ" in notice["text"]]
    opened.say("undo")
    opened.until("paused", time=0.1, furthest=0.1)
    with pytest.raises(RefusedError, match=r"undo: nothing was changed by hand up to 0\.1 s"):
        opened.say("undo")


def test_a_simulation_that_its_program_has_taken_back_is_not_changed_by_hand(desk: Desk, tmp_path: Path) -> None:
    source = (
        EXAMPLE
        + """
simulation = Simulation(Scene(parts=(Floor(), Aperture())))
simulation.run(0.1)
simulation.seek(0.05)
simulation.run(0.1)
"""
    )
    talk = desk.begin(tmp_path, source, record=True)
    talk.say("until", time=0.08)
    talk.until("paused", time=0.08)
    talk.say("command", word="aperture", values=[0.5])
    talk.say("until", time=0.13)
    talk.until("paused", time=0.13)
    with pytest.raises(
        RefusedError, match="'aperture' cannot be done: the program has taken this simulation back to an earlier time itself"
    ):
        talk.say("command", word="aperture", values=[0.4])
    talk.say("undo")
    talk.until("paused", time=0.08)


def test_a_program_says_what_cannot_be_changed_at_this_moment(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, ONE)
    with pytest.raises(RefusedError, match="parameters of a program cannot change while it runs"):
        talk.say("set", name="speed", value=1)
    with pytest.raises(RefusedError, match="no body 'walkr'; did you mean 'walker'"):
        talk.say("command", word="walk", values=[1], body="walkr")
    with pytest.raises(RefusedError, match=r"no buffer 'walker\.goa'; did you mean 'walker\.goal'"):
        talk.say("command", word="clear_buffer", values=["walker.goa"])
    silent = TRIALS.partition("for width")[0].replace(
        "Silent().run(0.1)", "Simulation(Scene(parts=(Floor(),))).run(0.1)\nSilent().run(0.1)"
    )
    talk = desk.begin(tmp_path, silent)
    talk.say("until", time=0.15)
    talk.until("paused", time=0.15)
    with pytest.raises(RefusedError, match="'walk' cannot be done: no simulation runs at this moment, but an agent without a body"):
        talk.say("command", word="walk", values=[1], body="walker")


def test_a_program_that_makes_a_simulation_and_fails_before_that_says_so(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "from actr3d.simulation import Simulation\n1 / 0\nSimulation(1)\n", wait="failed")
    assert "division by zero" in talk.state["reason"]
    assert talk.facts["world"] is None


def test_a_wrong_build_is_reported_with_its_line(desk: Desk, tmp_path: Path) -> None:
    source = "from actr3d.simulation import Simulation\n\ndef build():\n    return Simulation(1)\n"
    talk = desk.begin(tmp_path, source, wait=None)
    notice = talk.wait_for_notice("build must")
    assert (notice["level"], notice["file"], notice["line"]) == ("error", "model.py", 3)
    assert notice["text"].startswith("build must be declared to return a Simulation (got `def build()`, without a return type); write")


HELPER = (
    EXAMPLE
    + """
def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker}, seed=1)

def stand():
    return build()
"""
)
USES = (
    "from walking import build\nbuild().run(0.1)",
    "from walking import stand as begin\nbegin().run(0.1)",
    "import walking\nsimulation = walking.build()\nsimulation.run(0.1)",
    "from again import *\nbuild().run(0.1)",
    "from made import simulation\nsimulation.run(0.1)",
    "from package.inner import stand\nstand().run(0.1)",
)


@pytest.mark.daily(1)
@pytest.mark.parametrize("source", USES)
def test_a_program_whose_simulation_is_made_in_another_file_stands_at_its_start_with_its_scene(
    desk: Desk, tmp_path: Path, source: str
) -> None:
    (tmp_path / "walking.py").write_text(HELPER, encoding="utf-8")
    (tmp_path / "again.py").write_text("from walking import *\n", encoding="utf-8")
    (tmp_path / "made.py").write_text("from walking import build\nsimulation = build()\n", encoding="utf-8")
    (tmp_path / "package").mkdir()
    (tmp_path / "package" / "__init__.py").write_text("", encoding="utf-8")
    (tmp_path / "package" / "inner.py").write_text(HELPER, encoding="utf-8")
    talk = desk.begin(tmp_path, source, record=True)
    assert list(talk.facts["world"]["bodies"]) == ["walker"]
    assert talk.state["time"] == 0
    talk.say("run")
    talk.until("ended")
    for file in tmp_path.rglob("*.py"):
        file.unlink()
    opened = Talk(desk, desk.do(talk.sessions.reopen(talk.session.recording or "")), talk.sessions)
    opened.until("paused", time=0)
    assert list(opened.facts["world"]["bodies"]) == ["walker"]


def test_a_program_that_uses_only_other_things_of_such_a_file_runs_nothing_before_it_is_told_to(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "walking.py").write_text("print('loaded')\n" + HELPER + "\nWIDTH = 3\n", encoding="utf-8")
    (tmp_path / "round.py").write_text("from model import nothing\nimport round\n", encoding="utf-8")
    source = "import random, round\nfrom walking import WIDTH, Silent\n" + "print('begins')\nSilent().run(0.1)\n"
    talk = desk.begin(tmp_path, source)
    assert talk.facts["world"] is None
    assert talk.events == []
