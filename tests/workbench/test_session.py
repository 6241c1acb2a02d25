"""Runs in workers: on, hold, step, back, another way; and what a user is told."""

from __future__ import annotations

import asyncio
import inspect
from pathlib import Path
from time import sleep
from typing import Any

import msgspec
import pytest
from fastapi.routing import APIRoute

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import run_text
from actr3d.runner.model_factory import Blueprint
from actr3d.runner.model_stdout import ProgramOutput
from actr3d.trace import Trace
from tests.helpers.paths import MODELS
from tests.helpers.sessions import Desk, RefusedError, Talk
from workbench.files import ModelFile, ModelFolder, NoSuchFileError
from workbench.overlays import OVERLAYS
from workbench.routes import router
from workbench.session import Session
from workbench.worker.messages import FromWorker
from workbench.worker.workers import Worker

DOORWAY = (MODELS / "doorway.py").read_text(encoding="utf-8")
COUNTING = (MODELS / "tutorial" / "counting.py").read_text(encoding="utf-8")


def fires(events: list[list[Any]]) -> list[tuple[float, str]]:
    return [(time / 1e6, data["production"]) for time, _, kind, data in events if kind == "fire"]


def traced_doorway(**settings: float) -> list[list[Any]]:
    """Returns the events of a run without any workbench."""
    with RunLimits(seed=1):
        simulation, _ = Blueprint(DOORWAY, "model.py").build(settings)
    simulation.traced()
    simulation.run()
    assert simulation.trace is not None
    return [[event.time_us, event.source, event.kind] for event in simulation.trace]


def bare(events: list[list[Any]]) -> list[list[Any]]:
    """Returns events without their data."""
    return [event[:3] for event in events]


def ended(talk: Talk) -> dict[str, Any]:
    talk.say("run")
    state = talk.until("ended")
    talk.wait(lambda: talk.session.log.next == state["events"])
    return state


def test_a_run_does_what_it_does_without_a_workbench(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    state = ended(talk)
    assert (state["reason"], state["time"]) == ("the model called stop()", 6.8)
    assert bare(talk.events) == traced_doorway()
    assert [data["text"] for _, _, kind, data in talk.events if kind == "output"][-1] == "6.80 s: is through"


def test_steps_and_stretches_make_the_same_run(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    talk.say("step")
    assert talk.until("paused", tick=1)["reason"] == "after a step"
    talk.say("step", ticks=9)
    talk.until("paused", tick=10)
    talk.say("until", time=2.5)
    talk.until("paused", time=2.5)
    talk.say("back", ticks=3)
    talk.until("paused", tick=247)
    talk.say("seek", time=0.5)
    assert talk.until("paused", time=0.5)["furthest"] == 2.5
    ended(talk)
    assert bare(talk.events) == traced_doorway()


def test_steps_that_come_fast_add_up(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    for _ in range(20):
        talk.say("step", ticks=2)
    assert talk.wait(lambda: talk.state["tick"] == 40 and talk.state["status"] == "paused")


def test_a_pause_holds_a_run(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    talk.say("speed", factor=1)
    talk.say("run")
    talk.wait(lambda: talk.state["time"] > 0.05)
    talk.say("pause")
    state = talk.until("paused")
    assert state["reason"] == "by the user"
    assert talk.say("explain")[0]["time"] == state["time"]
    assert talk.state["time"] == state["time"] < 6


def test_a_cycle_ends_when_a_production_fires(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    times: list[float] = []
    for _ in range(3):
        talk.say("cycle")
        talk.wait(lambda: talk.state["status"] == "paused" and talk.state["time"] > (times or [0])[-1])
        times.append(talk.state["time"])
    assert times == [time for time, _ in fires(talk.events)]
    assert len(times) == 3


def test_cycles_that_come_fast_add_up(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    talk.say("speed", factor=0.05)
    for _ in range(3):
        talk.say("cycle")
    talk.say("speed", factor=None)
    talk.until("paused", tick=talk.wait(lambda: talk.state["reason"].endswith(" fired"))["tick"])
    assert [name for _, name in fires(talk.events)][2:] == [talk.state["reason"].removesuffix(" fired")]


def test_a_breakpoint_holds_the_run_where_its_production_fires(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    talk.say("breakpoints", productions=["turn"])
    talk.say("run")
    assert talk.until("paused")["reason"] in ("at its start", "breakpoint: turn fired")
    talk.wait(lambda: talk.state["reason"] == "breakpoint: turn fired")
    assert talk.state["time"] == fires(talk.events)[-1][0]
    assert talk.facts["breakpoints"] == ["turn"]


@pytest.mark.parametrize(
    ("wanted", "reason"),
    [
        ({"production": "turn"}, "turn fired"),
        ({"buffer": "walker.goal", "pattern": "pass"}, "walker.goal matches 'pass'"),
        ({"buffer": "walker.seen", "pattern": "view seen:?"}, "walker.seen matches 'view seen:?'"),
        ({"time": 1.23, "production": "turn"}, "at 1.23 s"),
    ],
)
def test_a_run_goes_on_until(desk: Desk, tmp_path: Path, wanted: dict[str, Any], reason: str) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    talk.say("until", **wanted)
    talk.wait(lambda: talk.state["reason"] == reason)


def test_a_run_goes_on_until_something_is_touched(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY, settings={"width": 0.2})
    talk.say("until", contact="")
    talk.wait(lambda: "of walker touches aperture_" in talk.state["reason"])
    assert any(touch["other"].startswith("aperture_") for touch in talk.say("body")["contacts"])


def test_until_what_must_be_said(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    with pytest.raises(RefusedError, match="until: must name a time"):
        talk.say("until", pattern="x")
    talk.say("step", ticks=10)
    talk.until("paused", tick=10)
    with pytest.raises(RefusedError, match=r"time: must be after the present one, .*; a click on the timeline goes back"):
        talk.say("until", time=0.05)


def test_the_speed_is_held_and_measured(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    talk.say("speed", factor=0.5)
    talk.say("run")
    state = talk.wait(lambda: talk.state["measured"] is not None and talk.state["time"] > 0.2)
    assert state["wanted"] == 0.5
    assert state["measured"] < 0.6  # it never goes faster than that
    talk.say("speed", factor=None)
    assert talk.until("ended")["measured"] is None


def test_speed_and_breakpoints_without_a_run_are_those_of_the_next_run(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY, real_time=True)
    assert (talk.facts["speed"], talk.facts["real_time"]) == (None, True)
    desk.do(talk.session.stop())
    talk.say("speed", factor=20)
    talk.say("breakpoints", productions=["turn"])
    assert (talk.facts["speed"], talk.facts["real_time"]) == (20, False)
    talk.say("restart", run=True)
    talk.wait(lambda: talk.state["reason"] == "breakpoint: turn fired")
    assert talk.state["wanted"] == 20


def test_overlays_speed_and_breakpoints_are_those_of_the_session_that_is_shown(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY, real_time=True, record=True)
    shown = next(name for name, overlay in OVERLAYS.items() if not overlay.shown_at_first)
    talk.say("overlay", name=shown, shown=True)
    talk.say("breakpoints", productions=["turn"])
    talk.say("step", ticks=2)
    talk.until("paused", tick=2)
    (tmp_path / "other.py").write_text(COUNTING, encoding="utf-8")

    def of(session: Session) -> tuple[bool, float | None, bool, tuple[str, ...]]:
        return shown in session.look.shown, session.speed, session.real_time, session.breakpoints

    def opened(model: str, **options: Any) -> Session:
        return desk.do(talk.sessions.open(model, {}, seed=1, record=False, run=False, **options))

    assert of(opened("other.py", real_time=True)) == (True, None, True, ())
    desk.do(joined(talk.session))  # a page shows it, so it counts, though there are newer ones
    talk.say("speed", factor=5)
    assert of(opened("other.py", real_time=True)) == (True, 5, False, ())
    assert of(opened("model.py", real_time=True)) == (True, 5, False, ("turn",))
    assert of(opened("model.py")) == (False, None, False, ())  # as programs open it
    name = talk.facts["recording"]
    desk.do(talk.session.stop())
    again = Talk(desk, desk.do(talk.sessions.reopen(name, real_time=True)), talk.sessions)
    again.say("run")
    again.wait(lambda: again.state["reason"] == "breakpoint: turn fired")
    assert again.state["wanted"] == 5


async def joined(session: Session) -> None:
    session.join("page")


def test_a_user_makes_the_run_go_another_way(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    ended(talk)
    first = talk.events
    talk.say("seek", time=2.0)
    talk.until("paused", time=2.0)
    assert talk.session.log.next == len(first)  # what is known stays known
    talk.say("command", word="aperture", values=[0.9], drop=True)
    state = talk.wait(lambda: round(talk.state["apertures"]["aperture"], 9) == 0.9)
    assert state["furthest"] == 2.0
    ended(talk)
    assert talk.events[: state["events"] - 1] == first[: state["events"] - 1]
    assert talk.events[state["events"] - 1][2:] == [
        "command",
        {"command": "aperture", "data": {"values": [0.9], "named": {}, "body": None}},
    ]
    assert "turn" in dict(map(reversed, fires(first)))  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]
    assert "turn" not in dict(map(reversed, fires(talk.events)))  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]


def test_a_live_parameter_acts_at_once_and_others_do_not(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY.replace(', Live("parameter", "walker.speed")', ""))
    talk.say("set", name="width", value=0.7)
    talk.wait(lambda: round(talk.state["apertures"]["aperture"], 9) == 0.7)
    with pytest.raises(RefusedError, match="'speed' cannot change while a run goes on"):
        talk.say("set", name="speed", value=2)
    with pytest.raises(RefusedError, match="must be <= 3"):
        talk.say("set", name="width", value=4)
    with pytest.raises(RefusedError, match="did you mean 'width'"):
        talk.say("set", name="widht", value=1)


def test_any_word_can_be_said(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    talk.say("command", word="teleport", values=[1.0, 0.5], body="walker")
    assert talk.say("body")["pose"]["y"] == 0.5
    with pytest.raises(RefusedError, match="'fly'"):
        talk.say("command", word="fly", body="walker")
    for value, right in ((None, "a number"), (True, "a number"), (-1.0, "> 0"), (4, "<= 3")):  # as with the command `set`
        for given in ({"values": ["walker.speed", value]}, {"named": {"path": "walker.speed", "value": value}}):
            with pytest.raises(RefusedError, match=rf"speed: must be {right} \(got {value}\)"):
                talk.say("command", word="parameter", **given)
    with pytest.raises(RefusedError, match=r"width: must be <= 3 \(got 4\)"):
        talk.say("command", word="aperture", values=[4])
    talk.say("command", word="parameter", values=["walker.speed", 2])


def test_parameters_make_another_run(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY, settings={"width": 0.9})
    assert talk.facts["parameters"] == {"width": 0.9, "speed": 1.2}
    talk.say("restart", settings={"width": 0.6})
    talk.wait(lambda: talk.facts["run"] == 2)
    assert talk.facts["parameters"]["width"] == 0.6
    assert talk.facts["seed"] == 1
    talk.say("restart", new_seed=True)
    talk.wait(lambda: talk.facts["run"] == 3)
    assert talk.facts["parameters"]["width"] == 0.6
    assert talk.facts["seed"] != 1


def test_why_and_what_is_seen(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    talk.say("until", production="turn")
    talk.wait(lambda: talk.state["reason"] == "turn fired")
    (then,) = talk.say("explain", at=0.01, production="turn")
    assert [(reason["name"], reason["matches"], reason["found"]) for reason in then["productions"]] == [("turn", False, "'approach'")]
    assert "turn: goal" in then["productions"][0]["text"]
    with pytest.raises(RefusedError, match="did you mean 'turn'"):
        talk.say("explain", production="trun")
    with pytest.raises(RefusedError, match="lies ahead"):
        talk.say("explain", at=100.0)
    view = talk.say("view")
    assert (view["body"], view["rows"]) == ("walker", 100)
    assert [field["name"] for field in view["fields"]] == ["row", "label", "y", "x1", "x2", "d1", "d2", "a1", "a2", "xn", "dn"]
    assert all(field["title"] and field["about"] for field in view["fields"])
    assert all(len(extent) == len(view["fields"]) for extent in view["extents"])
    assert len(view["extents"]) > 10
    assert view["colours"] == dict.fromkeys(("1", "2"), "#bfb5a8")  # both walls have the colour that they have in the scene
    parts = talk.state["parts"]
    assert parts["walker.goal"] == {"is": "buffer", "class": "Buffer", "chunk": {"0": "pass"}}
    assert parts["walker.eye"]["state"]["busy"] in (True, False)
    world = talk.facts["world"]
    assert (world["apertures"], world["bodies"]["walker"]["shoulders"]) == (["aperture"], 0.45)
    assert world["widths"] == {"aperture": [1, 300]}


def test_a_program_runs_steps_goes_back_and_is_explained(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING)
    for question in ("view", "body"):
        with pytest.raises(RefusedError, match=r"^the run has no body$"):
            talk.say(question)
    talk.say("step", ticks=15)
    talk.until("paused", time=0.15)
    talk.say("cycle")
    talk.wait(lambda: talk.state["reason"] == "count_on fired")
    assert talk.say("explain", at=0.0)[0]["agent"] == "top"
    assert talk.say("memory", memory="memory", words="number:4")["rows"][0]["chunk"] == "next:5 number:4"
    assert talk.say("memory", memory="memory")["size"] == 20
    talk.say("back", ticks=10)
    assert talk.until("paused", time=0.15)["furthest"] == 0.25
    ended(talk)
    trace = Trace("all")
    limits = RunLimits(seed=1, trace=trace)
    with ProgramOutput(limits):
        run_text(COUNTING, "model.py", limits=limits)
    assert bare(talk.events) == [[event.time_us, event.source, event.kind] for event in trace]


def test_a_program_goes_back_after_its_end_and_forth(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING)
    ended(talk)
    count = len(talk.events)
    for time in (0.2, 0.4, 0.0, 0.3):
        talk.say("seek", time=time)
        talk.until("paused", time=time)
    with pytest.raises(RefusedError, match="has only reached"):
        talk.say("seek", time=99.0)
    with pytest.raises(RefusedError, match="no change 'aperture' for the agents of a program"):
        talk.say("command", word="aperture", values=[1])
    ended(talk)
    assert len(talk.events) == count


def test_the_first_lines_of_a_program_are_its_parameters(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING, settings={"last": 3})
    assert talk.facts["parameters"] == {"first": 2, "last": 3, "latency_factor": 0.05}
    ended(talk)
    assert [data["text"] for _, _, kind, data in talk.events if kind == "output"][-1].endswith("3, and that is all")


def test_a_session_goes_at_real_time_through_a_program(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING)
    talk.say("speed", factor=1)
    talk.say("run")
    state = talk.wait(lambda: talk.state["measured"] is not None and talk.state["time"] > 0.1)
    assert state["measured"] < 1.5


def test_an_error_names_its_line_and_an_earlier_time_can_be_seen(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY.replace('goal.set("behind")', "goal.set(1 / 0)"))
    talk.say("run")
    talk.until("failed")
    notice = talk.wait_for_notice("ZeroDivisionError: division by zero")
    assert notice["file"] == "model.py"
    assert DOORWAY.splitlines()[int(notice["line"]) - 1].strip() == 'goal.set("behind")'
    assert "line " in notice["detail"]
    with pytest.raises(RefusedError, match="the run is over"):
        talk.say("run")
    talk.say("seek", time=1.0)
    talk.until("paused", time=1.0)


def test_the_error_of_a_model_is_reported_unchanged(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "raise ValueError('<img src=x onerror=alert(1)>')", wait=None, run=True)
    assert "<img src=x onerror=alert(1)>" in talk.wait_for_notice("<img")["text"]


def test_a_file_that_is_wrong_leaves_the_last_run_on_screen(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    talk.say("step", ticks=5)
    talk.until("paused", tick=5)
    (tmp_path / "model.py").write_text(DOORWAY.replace("return Simulation", "retrun Simulation"), encoding="utf-8")
    assert talk.facts["stale"]
    talk.say("restart")
    notice = talk.wait_for_notice("invalid syntax")
    assert (notice["level"], notice["file"], notice["line"] > 50) == ("error", "model.py", True)
    assert talk.state["tick"] == 5
    assert talk.say("explain")
    (tmp_path / "model.py").write_text(DOORWAY, encoding="utf-8")
    talk.say("restart", run=True)
    talk.wait(lambda: talk.facts["run"] == 2)
    assert talk.until("ended")["time"] == 6.8


def test_a_warning_is_reported_with_its_line(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING.replace("goal.clear()", "goal.clear"))
    talk.say("run")
    notice = talk.wait_for_notice("goal.clear")
    assert notice["level"] == "warning"
    assert COUNTING.splitlines()[int(notice["line"]) - 1].strip() == "goal.clear()"


def test_a_run_is_recorded_and_opened_again(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY, record=True)
    talk.say("step", ticks=50)
    talk.until("paused", tick=50)
    talk.say("command", word="aperture", values=[0.9])
    time = ended(talk)["time"]
    events = talk.events
    name = talk.facts["recording"]
    desk.do(talk.session.stop())
    summary = talk.summary(name)
    assert (summary.model, summary.kind, summary.seed, summary.ended, summary.time) == ("model.py", "simulation", 1, "stop", time)
    again = Talk(desk, desk.do(talk.sessions.reopen(name)), talk.sessions)
    again.until("paused")
    ended(again)
    assert again.events == events


def test_a_program_is_recorded_once_however_often_it_goes_back(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING, record=True)
    ended(talk)
    talk.say("seek", time=0.1)
    talk.until("paused", time=0.1)
    ended(talk)
    name = talk.facts["recording"]
    count = len(talk.events)
    desk.do(talk.session.stop())
    assert talk.summary(name).events == count


def test_a_run_that_was_stopped_is_over_also_where_its_last_messages_are_read_slowly(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    talk = desk.begin(tmp_path, COUNTING, wait="paused")
    received = Worker.receive

    async def slowly(worker: Worker) -> FromWorker | None:
        await asyncio.sleep(0.1)
        return await received(worker)

    monkeypatch.setattr(Worker, "receive", slowly)
    desk.do(talk.session.stop())
    assert not talk.session.alive


def test_two_sessions_at_once(desk: Desk, tmp_path: Path) -> None:
    one, other = desk.begin(tmp_path, DOORWAY), desk.begin(tmp_path, COUNTING, name="other.py")
    one.say("step", ticks=3)
    other.say("step", ticks=5)
    one.until("paused", tick=3)
    other.until("paused", tick=5)


def test_a_closed_session_begins_no_runs(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING)

    async def restarted_while_closing() -> list[Any]:
        restarts = [asyncio.create_task(talk.session.restart({}, 1)) for _ in range(2)]
        await asyncio.sleep(0)  # the first one waits for its worker, the second one for the first
        await talk.sessions.close(talk.session.name)
        return await asyncio.gather(*restarts, return_exceptions=True)

    first, second = desk.do(restarted_while_closing())
    assert (first, str(second)) == (None, "this session is closed, and begins no more runs: open the model again")
    assert talk.session.is_over
    with pytest.raises(RefusedError, match="this session is closed"):
        talk.say("restart")
    assert talk.session.is_over


def test_there_is_a_bound_to_sessions(desk: Desk, tmp_path: Path) -> None:
    from workbench.sessions import MAX_SESSIONS, SessionError

    sessions = desk.sessions(tmp_path)
    (tmp_path / "model.py").write_text("x = 1\n", encoding="utf-8")

    async def open_watched() -> Session:
        session = await sessions.open("model.py", {}, seed=1, record=False, run=False)
        session.join("somebody")
        return session

    opened = [desk.do(open_watched()) for _ in range(MAX_SESSIONS)]
    for session in opened:
        Talk(desk, session, sessions).until("paused")
    with pytest.raises(SessionError, match="each is shown on a page or still running"):
        desk.do(open_watched())
    # One that nobody watches any more makes room.
    opened[3].leave(opened[3].feeds[0])
    newest = desk.do(open_watched())
    ended = "the run of model.py, which no page showed, was ended; it was not recorded"
    for session in (newest, opened[0]):
        (told,) = [notice for _, text in session.notices if ended in (notice := msgspec.json.decode(text))["text"]]
        assert "attempt" not in told  # it is not of the run, whose console does not have it
    assert [session.name for session in sessions.all()] == ["s1", "s2", "s3", "s5", "s6", "s7", "s8", f"s{MAX_SESSIONS + 1}"]


def test_sessions_of_models_that_could_not_be_built_make_room(desk: Desk, tmp_path: Path) -> None:
    from workbench.sessions import MAX_SESSIONS

    sessions = desk.sessions(tmp_path)
    (tmp_path / "model.py").write_text("print 'Python 2'\n", encoding="utf-8")
    for _ in range(MAX_SESSIONS + 1):
        session = desk.do(sessions.open("model.py", {}, seed=1, record=True, run=False))
        while not session.is_over:
            sleep(0.005)
    assert len(sessions.all()) == MAX_SESSIONS


def test_there_is_a_bound_to_sessions_that_are_opened_at_once(desk: Desk, tmp_path: Path) -> None:
    from workbench.sessions import MAX_SESSIONS

    sessions = desk.sessions(tmp_path)
    (tmp_path / "model.py").write_text("x = 1\n", encoding="utf-8")

    def opening(count: int) -> list[Any]:
        async def open_all() -> list[Any]:
            one = (sessions.open("model.py", {}, seed=1, record=False, run=False) for _ in range(count))
            return await asyncio.gather(*one, return_exceptions=True)

        return desk.do(open_all())

    for session in opening(MAX_SESSIONS):
        Talk(desk, session, sessions).until("paused")
    opening(MAX_SESSIONS)
    assert len(sessions.all()) == MAX_SESSIONS


def test_where_no_run_can_be_begun_there_is_no_session(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sessions = desk.sessions(tmp_path)
    (tmp_path / "model.py").write_text("x = 1\n", encoding="utf-8")

    async def no_more() -> Any:
        raise OSError("no more processes")

    monkeypatch.setattr(desk.workers, "launch", no_more)
    with pytest.raises(OSError, match="no more processes"):
        desk.do(sessions.open("model.py", {}, seed=1, record=True, run=False))
    assert sessions.all() == []


def test_a_check_that_loads_says_what_loading_says(desk: Desk, tmp_path: Path) -> None:
    sessions = desk.sessions(tmp_path)
    path = tmp_path / "model.py"
    assert desk.do(sessions.check(path, DOORWAY)) == []
    (problem,) = desk.do(sessions.check(path, DOORWAY.replace("Floor(), ", "Flor(), ")))
    assert (problem["level"], problem["line"]) == ("error", len(DOORWAY.rstrip().split("\n")) - 1)
    assert "NameError" in problem["message"]


def test_a_check_takes_no_longer_than_it_may(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("workbench.sessions.CHECK_TIME", 0.5)
    (problem,) = desk.do(desk.sessions(tmp_path).check(tmp_path / "m.py", "while True: pass\ndef build() -> Simulation: ..."))
    assert "longer than 0.5 s" in problem["message"]


def test_a_notice_says_which_text_it_is_about(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "helper.py").write_text("def fail():\n    raise ValueError('no')\n", encoding="utf-8")
    talk = desk.begin(tmp_path, "import helper\nhelper.fail()\n")
    talk.say("run")
    notice = talk.wait_for_notice("ValueError: no")
    assert (notice["file"], notice["line"], notice["attempt"]) == ("helper.py", 2, 1)
    assert notice["version"] == ModelFolder.version(tmp_path / "model.py")
    (tmp_path / "model.py").write_text("print(\n", encoding="utf-8")
    talk.say("restart")
    notice = talk.wait_for_notice("never closed")
    assert (notice["file"], notice["line"], notice["attempt"]) == ("model.py", 1, 2)
    assert notice["version"] == ModelFolder.version(tmp_path / "model.py") != talk.facts["version"]
    assert talk.facts["attempt"] == 2
    assert talk.facts["run"] == 1


def test_a_session_goes_on_with_a_file_that_is_renamed_or_gone(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING)
    (tmp_path / "model.py").rename(tmp_path / "other.py")
    assert talk.facts["gone"]
    assert talk.facts["stale"]
    talk.sessions.renamed(tmp_path / "model.py", tmp_path / "other.py", "other.py")
    assert (talk.facts["model"], talk.facts["gone"], talk.facts["stale"]) == ("other.py", False, False)
    talk.say("restart", run=True)
    talk.wait(lambda: talk.facts["run"] == 2)
    talk.until("ended")


def test_a_session_whose_folder_cannot_be_read_is_described_all_the_same(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unreadable(path: Path) -> bool:
        raise PermissionError(path)

    talk = desk.begin(tmp_path, COUNTING)
    monkeypatch.setattr(Path, "is_file", unreadable)
    assert talk.facts["gone"]
    monkeypatch.undo()
    assert not talk.facts["gone"]


@pytest.mark.slow
def test_what_a_program_printed_before_an_endless_loop_is_shown(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING + "\nprint('done')\nwhile True:\n    pass\n", run=True, wait=None)
    talk.wait(lambda: talk.events and talk.events[-1][2] == "output" and talk.events[-1][3]["text"] == "done")
    talk.wait(lambda: talk.state["events"] == len(talk.events))
    assert next(data["production"] for _, _, kind, data in talk.events if kind == "fire") == "begin"
    assert talk.state["status"] == "running"
    assert talk.state["time"] > 0


def test_settings_of_a_parameter_that_has_another_name_now_are_said_to_be_wrong(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY, settings={"width": 0.9})
    renamed = DOORWAY.replace("    width: Annotated", "    gap: Annotated").replace("parameters.width", "parameters.gap")
    assert renamed != DOORWAY
    (tmp_path / "model.py").write_text(renamed, encoding="utf-8")
    talk.say("restart")
    assert talk.wait_for_notice("no parameter 'width'")["text"].endswith("it has: gap, speed")
    assert talk.facts["run"] == 1
    talk.say("restart", settings={"gap": 0.7})
    talk.wait(lambda: talk.session.run == 2)
    assert talk.facts["settings"] == {"gap": 0.7}


def test_a_file_that_is_deleted_while_its_session_begins_is_said_not_to_exist(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def read_and_delete(folder: ModelFolder, path: str) -> ModelFile:
        found = read(folder, path)
        (tmp_path / path).unlink()
        return found

    read = ModelFolder.read
    monkeypatch.setattr(ModelFolder, "read", read_and_delete)
    (tmp_path / "m.py").write_text("print(1)\n", encoding="utf-8")
    with pytest.raises(NoSuchFileError, match=r"'m\.py'"):
        desk.do(desk.sessions(tmp_path).open("m.py", {}, seed=1, record=False, run=False))


def test_sessions_are_described_in_the_thread_that_changes_them() -> None:
    described = [route.endpoint for route in router.routes if isinstance(route, APIRoute) and route.name in ("sessions", "session")]
    assert len(described) == 2
    assert all(inspect.iscoroutinefunction(endpoint) for endpoint in described)
