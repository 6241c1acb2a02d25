"""Changes by hand in sessions: of simulations and of programs, while they run, are paused, go back, and in opened recordings."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from time import sleep
from typing import Any

import pytest

from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from tests.helpers.asgi_client import COOKIE, GATE, HOST, JSON, ORIGIN, OURS, Answer, call
from tests.helpers.counters import counter_text
from tests.helpers.paths import MODELS
from tests.helpers.sessions import Desk, RefusedError, Talk
from workbench.app import make_app
from workbench.exports import curves_of
from workbench.labels import Label
from workbench.program_time import timed_events
from workbench.recordings import Recordings
from workbench.retention import RetentionLimits, copied_from

AGENT = counter_text("PMNoise(noise=0.3)")
PROGRAM = AGENT + "\nfirst = Counter()\nfirst.run(0.4)\nsecond = Counter()\nsecond.run(3)\nprint('over')\n"
COUNTING = (MODELS / "tutorial" / "counting.py").read_text(encoding="utf-8")
BUILT = (
    AGENT
    + """
from actr3d.simulation import Simulation
from actr3d.world import Floor, Scene

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(),)), bodiless={"mind": Counter})
"""
)
JUDGING = """from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Mannequin, Scene

class Judge(ACTR):
    goal = Buffer()
    def init():
        goal.set("wide")

judge = Judge()
judge.run(0.2)
apertures = [Aperture(name=f"aperture{n}", position=(3 + n, 0)) for n in range(2)]
for some in ([apertures] if "narrow" in str(judge.goal.chunk) else [apertures[:1]] * 2):
    Simulation(Scene(parts=(Floor(), Mannequin(name="walker"), *some))).run(0.1)
"""
"""What its agent has in mind decides which simulations it makes."""
OWN = BUILT.partition("def build")[0] + 'Simulation(Scene(parts=(Floor(),)), bodiless={"mind": Counter}).run(3)\n'
RUNS = {"program": (PROGRAM, "top", ""), "simulation": (BUILT, "mind", "mind."), "own simulation": (OWN, "mind", "mind.")}
"""By kind of model: its text, the path of its agent, and the start of the paths of its parts."""


def change(talk: Talk, word: str, **named: Any) -> None:
    talk.say("command", word=word, named=named)


def events(talk: Talk) -> list[Any]:
    return talk.say("events", most=20_000)["events"]


def there(talk: Talk, time: float) -> None:
    talk.say("until", time=time)
    talk.until("paused", time=time)


def recording(talk: Talk) -> Path:
    assert talk.session.start is not None
    assert talk.session.start.record is not None
    return Path(talk.session.start.record)


def reopened(desk: Desk, folder: Path, source: str) -> tuple[Path, Talk]:
    """Runs a model for 0.3 s; returns its recording, and a session that has opened it."""
    talk = desk.begin(folder, source, record=True)
    there(talk, 0.3)
    path = recording(talk)
    desk.do(talk.session.close())
    opened = Talk(desk, desk.do(talk.sessions.reopen(path.stem)), talk.sessions)
    opened.until("paused", furthest=0.3)
    return path, opened


@pytest.mark.parametrize("kind", RUNS)
def test_changes_are_repeated_exactly_by_going_back_by_a_replay_and_by_opening(kind: str, desk: Desk, tmp_path: Path) -> None:
    source, agent, below = RUNS[kind]
    talk = desk.begin(tmp_path, source, record=True)
    there(talk, 0.12)
    change(talk, "forbid_once", system=agent, production="up")
    change(talk, "set_buffer", buffer=f"{below}goal", chunk="rest 5")
    assert talk.state["parts"][f"{below}goal"]["chunk"] == {"0": "rest", "1": "5"}
    there(talk, 0.17)
    change(talk, "add_chunk", memory=f"{below}memory", chunk="next 5 6")
    there(talk, 0.3)
    change(talk, "strengthen", memory=f"{below}memory", chunk="next 5 6")
    change(talk, "clear_buffer", buffer=f"{below}retrieval")
    there(talk, 0.9)
    first = events(talk)
    assert [data["command"] for _, _, kind, data in first if kind == "command"] == [
        "forbid_once", "set_buffer", "add_chunk", "strengthen", "clear_buffer",
    ]  # fmt: skip
    for time in (0.5, 0.12, 0.17, 0.0, 0.29):
        talk.say("seek", time=time)
        talk.until("paused", time=time)
        talk.say("until", time=0.9)
        talk.until("paused", time=0.9)
        assert events(talk) == first
    path = recording(talk)
    desk.do(talk.session.close())
    with Recorded(path) as recorded:
        assert replay(recorded).difference is None
    opened = Talk(desk, desk.do(talk.sessions.reopen(path.stem)), talk.sessions)
    opened.until("paused", furthest=0.9)
    opened.say("until", time=0.9)
    opened.until("paused", time=0.9)
    assert events(opened) == first
    opened.say("seek", time=0.2)
    change(opened, "set_buffer", buffer=f"{below}goal", chunk="count 9")
    assert opened.state["reason"] == "changed at 0.20 s"
    there(opened, 0.5)
    now = events(opened)
    own = recording(opened)
    desk.do(opened.sessions.close(opened.session.name))
    with Recorded(path) as recorded:
        recorded.check()  # it is as it was
        assert len(list(recorded.commands())) == 5
    with Recorded(own) as recorded:  # what followed is a branch of it
        assert (recorded.facts["branched"], recorded.facts["origin"]) == (0.2, path.stem)
        assert [event.time_us for event in timed_events(recorded)][: len(now)] == [time for time, *_ in now]
        assert replay(recorded).difference is None


@pytest.mark.daily(1)
@pytest.mark.parametrize("kind", RUNS)
def test_an_undone_change_is_not_repeated_and_its_future_is_kept(kind: str, desk: Desk, tmp_path: Path) -> None:
    source, agent, below = RUNS[kind]
    talk = desk.begin(tmp_path, source, record=True)
    there(talk, 0.3)
    first = events(talk)
    talk.say("seek", time=0.12)
    talk.until("paused", time=0.12)
    change(talk, "forbid_once", system=agent, production="up")
    change(talk, "set_buffer", buffer=f"{below}goal", chunk="rest 5")
    there(talk, 0.3)
    before = {path for path in recording(talk).parent.glob("*.sqlite") if copied_from(path.stem)}
    talk.say("undo")
    state = talk.until("paused", time=0.12)
    assert (state["furthest"], state["reason"]) == (0.12, "undone at 0.12 s")
    assert [data["command"] for _, _, kind, data in events(talk) if kind == "command"] == ["forbid_once"]
    (branch,) = {path for path in recording(talk).parent.glob("*.sqlite") if copied_from(path.stem)} - before
    with Recorded(branch) as recorded:
        assert [command.data["command"] for command in recorded.commands()] == ["forbid_once", "set_buffer"]
    there(talk, 0.3)
    assert "rest" not in talk.state["parts"][f"{below}goal"]["chunk"].values()
    talk.say("seek", time=0.12)  # the other change is yet to be repeated here
    talk.until("paused", time=0.12)
    talk.say("undo")
    talk.until("paused", furthest=0.12)
    there(talk, 0.3)
    assert events(talk) == first
    with pytest.raises(RefusedError, match=r"undo: nothing was changed by hand up to 0\.3 s"):
        talk.say("undo")
    path = recording(talk)
    desk.do(talk.session.close())
    with Recorded(path) as recorded:
        assert list(recorded.commands()) == []
        assert replay(recorded).difference is None


@pytest.mark.parametrize("kind", RUNS)
def test_a_change_can_be_undone_where_it_was_made_and_in_an_opened_recording(kind: str, desk: Desk, tmp_path: Path) -> None:
    source, _, below = RUNS[kind]
    talk = desk.begin(tmp_path, source, record=True)
    there(talk, 0.1)
    first = talk.state["parts"][f"{below}goal"]["chunk"]
    change(talk, "set_buffer", buffer=f"{below}goal", chunk="rest 5")
    talk.say("undo")
    state = talk.wait(lambda: talk.state["reason"] == "undone at 0.10 s")
    assert state["parts"][f"{below}goal"]["chunk"] == first
    change(talk, "set_buffer", buffer=f"{below}goal", chunk="rest 5")
    there(talk, 0.3)
    path = recording(talk)
    desk.do(talk.session.close())
    opened = Talk(desk, desk.do(talk.sessions.reopen(path.stem)), talk.sessions)
    there(opened, 0.3)
    opened.say("undo")
    state = opened.until("paused", time=0.1, furthest=0.1)
    assert state["reason"] == "undone at 0.10 s"
    assert state["parts"][f"{below}goal"]["chunk"] == first
    there(opened, 0.3)
    own = recording(opened)
    desk.do(opened.sessions.close(opened.session.name))
    with Recorded(own) as recorded:
        assert list(recorded.commands()) == []
        assert (recorded.facts["branched"], recorded.facts["origin"]) == (0.1, path.stem)
        assert replay(recorded).difference is None


def test_a_change_says_what_is_lost_if_the_opened_recording_has_been_deleted(desk: Desk, tmp_path: Path) -> None:
    path, opened = reopened(desk, tmp_path, PROGRAM)
    there(opened, 0.1)
    path.unlink()
    with pytest.raises(RefusedError, match=r"what lies ahead, from 0\.1 s to 0\.3 s, would be lost: the recording .* has been deleted"):
        opened.say("command", word="set_buffer", named={"buffer": "goal", "chunk": "count 9"})
    opened.say("command", word="set_buffer", named={"buffer": "goal", "chunk": "count 9"}, drop=True)
    assert opened.state["reason"] == "changed at 0.10 s; the rest was lost"


def test_an_opened_recording_without_changes_leaves_no_other(desk: Desk, tmp_path: Path) -> None:
    path, opened = reopened(desk, tmp_path, BUILT)
    there(opened, 0.2)
    assert recording(opened).exists()
    assert [one.stem for one in opened.sessions.recordings.all()] == [path.stem]  # it is not listed
    assert opened.facts["recording"] is None
    desk.do(opened.sessions.close(opened.session.name))
    assert list(path.parent.glob("*.sqlite*")) == [path]


def test_recordings_have_names_notes_and_tags(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, BUILT, record=True)
    there(talk, 0.1)
    name = recording(talk).stem
    desk.do(talk.session.close())

    recordings = talk.sessions.recordings

    def post(recording: str, body: Any) -> Answer:
        sent = json.dumps(body).encode()
        app = make_app(tmp_path, GATE)
        app.state.sessions = desk.sessions(tmp_path)
        return desk.do(call(app, f"/api/recordings/{recording}/label", HOST, COOKIE, ORIGIN, JSON, OURS, method="POST", body=sent))

    def label(**body: Any) -> Answer:
        return post(name, body)

    hostile = {"name": "  <script>\ud800 ../..  ", "note": "a\nb", "tags": ["x", " x ", "", "y"]}
    assert label(**hostile).status in (200, 422)
    assert desk.ask(tmp_path, "/api/recordings").status == 200
    answer = label(name=" to five ", note="kept", tags=["x", " x ", "", "y"])
    assert json.loads(answer.body) == {"label": {"name": "to five", "note": "kept", "tags": ["x", "y"]}}
    listed = json.loads(desk.ask(tmp_path, f"/api/recordings/{name}").body)
    assert listed["label"] == {"name": "to five", "note": "kept", "tags": ["x", "y"]}
    assert label(note="other").status == 200  # what is not sent stays
    assert recordings.labels.all()[name] == Label(name="to five", note="other", tags=("x", "y"))
    known = {"name": "to five", "note": "kept", "tags": ["x", "y"]}  # as another browser has seen it
    assert label(tags=["z"], known=known).status == 200
    answer = label(name="mine", note="mine", known=known)
    assert answer.status == 409
    assert json.loads(answer.body)["error"] == "another browser has changed the note to 'other' in the meantime"
    assert recordings.labels.all()[name] == Label(name="to five", note="other", tags=("z",))
    for wrong in ({"name": "x" * 101}, {"note": "x" * 2001}, {"tags": ["x"] * 21}, {"tags": ["x" * 41]}, {"names": "x"}):
        assert label(**wrong).status == 422
    assert post("nothing", {}).status == 404
    recordings.tidy(RetentionLimits(number=0, megabytes=0))
    recordings.tidy(RetentionLimits(number=1))
    assert name in recordings.labels.all()
    recordings.delete(name)
    assert recordings.labels.all() == {}


def test_all_browsers_hear_that_a_recording_was_labelled_or_deleted(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, BUILT, record=True)
    there(talk, 0.1)
    name = recording(talk).stem
    desk.do(talk.session.stop())
    app = make_app(tmp_path, GATE)
    app.state.sessions = talk.sessions

    def post(path: str, body: dict[str, str]) -> int:
        sent = json.dumps(body).encode()
        return desk.do(call(app, f"/api/recordings/{path}", HOST, COOKIE, ORIGIN, JSON, OURS, method="POST", body=sent)).status

    for path, body in ((f"{name}/label", {"name": "x"}), (f"{name}/delete", {})):
        before, heard = talk.session.facts_version, talk.facts["recording_changes"]
        assert post(path, body) == 200
        assert talk.session.facts_version > before
        assert talk.facts["recording_changes"] == heard + 1


def test_browsers_hear_that_a_run_of_another_session_has_begun_and_ended(desk: Desk, tmp_path: Path) -> None:
    watching = desk.begin(tmp_path, BUILT)
    (tmp_path / "counting.py").write_text(COUNTING, encoding="utf-8")
    other: list[Talk] = []

    def begins() -> None:
        other.append(Talk(desk, desk.do(watching.sessions.open("counting.py", {}, seed=1, record=True, run=False)), watching.sessions))

    def is_left() -> None:
        other[0].say("restart")
        other[0].wait(lambda: other[0].facts["run"] == 2)

    for change in (begins, lambda: other[0].say("run"), is_left, lambda: desk.do(other[0].session.stop())):
        heard = watching.facts["recording_changes"]
        change()
        watching.wait(lambda before=heard: watching.facts["recording_changes"] > before)
        sleep(0.2)  # in which the rest of what this change tells arrives


def test_a_damaged_file_of_labels_is_kept_and_nothing_is_deleted_without_it(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    recordings = Recordings(tmp_path)
    path, other = recordings.new("model"), recordings.new("model")
    path.touch()
    other.touch()
    recordings.labels.change(path.stem, {"name": "kept"})
    assert recordings.labels.problem is None
    file = path.with_name("labels.json")
    damaged = file.read_text(encoding="utf-8")[:-5]
    file.write_text(damaged, encoding="utf-8")
    assert recordings.labels.all() == {}
    assert str(recordings.labels.problem).startswith(
        "The names, notes and tags of recordings cannot be read from labels.json (it is damaged: "
    )
    recordings.tidy(RetentionLimits(number=1))
    recordings.labels.change(other.stem, {"note": "new"})
    recordings.tidy(RetentionLimits(number=1))
    assert (path.exists(), other.exists()) == (True, True)
    (aside,) = path.parent.glob("labels-damaged-*.json")
    assert aside.read_text(encoding="utf-8") == damaged
    assert f"kept as {aside.name} in {path.parent}" in str(recordings.labels.problem)
    assert aside.name in caplog.text
    assert recordings.labels.all() == {other.stem: Label(note="new")}
    aside.unlink()
    assert recordings.labels.problem is None
    recordings.tidy(RetentionLimits(number=1))
    assert (path.exists(), other.exists()) == (False, True)


@pytest.mark.parametrize("kind", RUNS)
def test_a_change_in_the_past_of_any_run_keeps_what_had_come_as_a_branch(kind: str, desk: Desk, tmp_path: Path) -> None:
    source, _, below = RUNS[kind]
    talk = desk.begin(tmp_path, source, record=True)
    there(talk, 0.2)
    change(talk, "set_buffer", buffer=f"{below}goal", chunk="rest 1")
    there(talk, 0.8)
    talk.say("seek", time=0.3)
    talk.until("paused", time=0.3)
    with pytest.raises(RefusedError, match="no buffer"):
        change(talk, "set_buffer", buffer="nothing", chunk="count 9")
    assert not [path for path in recording(talk).parent.glob("*.sqlite") if copied_from(path.stem) is not None]
    change(talk, "set_buffer", buffer=f"{below}goal", chunk="count 90")
    assert talk.state["reason"] == "changed at 0.30 s"
    there(talk, 0.7)
    now = events(talk)
    (branch,) = [path for path in recording(talk).parent.glob("*.sqlite") if copied_from(path.stem) is not None]
    path = recording(talk)
    assert talk.summary(branch.stem).copied == (path.stem, 0.3)
    assert talk.summary(path.stem).copied is None
    desk.do(talk.session.close())
    for one, goals in ((branch, ["rest 1"]), (path, ["rest 1", "count 90"])):
        with Recorded(one) as recorded:
            recorded.check()
            assert [command.data["data"]["named"]["chunk"] for command in recorded.commands()] == goals
            assert replay(recorded).difference is None
    with Recorded(path) as recorded:
        assert [event.time_us for event in timed_events(recorded)][: len(now)] == [time for time, *_ in now]


def test_a_branch_of_a_program_is_known_as_far_as_its_run_has_come_even_if_nothing_happened_there(desk: Desk, tmp_path: Path) -> None:
    rests = AGENT.replace("count 0", "rest 0").replace('goal.set("count ?n")', 'goal.set("over")')
    talk = desk.begin(tmp_path, rests + "\nCounter().run(0.2)\nCounter().run(3)\n", record=True)
    there(talk, 0.6)
    assert max(time for time, *_ in events(talk)) == 0.25e6  # in the second run, which goes on until then
    talk.say("seek", time=0.05)
    change(talk, "set_buffer", buffer="goal", chunk="none")
    told = talk.session.branched
    assert told is not None
    path = recording(talk)
    assert (talk.summary(told.recording).time, talk.summary(path.stem).time) == (told.until, 0.05) == (0.6, 0.05)
    talk.say("run")
    talk.until("ended")
    desk.do(talk.session.close())
    assert talk.summary(path.stem).time == 3.2
    for name, reached, said in ((told.recording, 0.6, "the run was left at 0.6 s"), (path.stem, 3.2, "every byte agrees")):
        with Recorded(path.with_name(f"{name}.sqlite")) as recorded:
            assert said in str(replay(recorded))
        opened = Talk(desk, desk.do(talk.sessions.reopen(name)), talk.sessions)
        assert opened.until("paused", furthest=reached)["time"] == 0


@pytest.mark.daily(1)
@pytest.mark.parametrize("kind", RUNS)
def test_changes_during_a_run_and_while_it_goes_back_are_repeated_exactly(kind: str, desk: Desk, tmp_path: Path) -> None:
    source, agent, below = RUNS[kind]
    talk = desk.begin(tmp_path, source.replace("first.run(0.4)", "first.run(5)"), record=True)
    talk.say("speed", factor=2.0)
    talk.say("run")
    for number in range(12):
        talk.wait(lambda number=number: talk.state["time"] > 0.05 * number)
        change(talk, "set_buffer", buffer=f"{below}goal", chunk=f"count {100 * number}")
        with suppress(RefusedError):  # it may be forbidden already
            change(talk, "forbid_once", system=agent, production="recall")
        change(talk, "add_chunk", memory=f"{below}memory", chunk=f"next {number} {number + 1}")
        if number == 6:
            talk.say("seek", time=0.1)
            change(talk, "clear_buffer", buffer=f"{below}retrieval")
            talk.say("run")
    talk.say("pause")
    talk.say("speed", factor=None)
    end = round(talk.until("paused")["time"] + 0.3, 2)
    there(talk, end)
    first = events(talk)
    for time in (0.0, 0.11):
        talk.say("seek", time=time)
        talk.say("until", time=end)
        talk.until("paused", time=end)
        assert events(talk) == first
    path = recording(talk)
    desk.do(talk.session.close())
    with Recorded(path) as recorded:
        assert replay(recorded).difference is None


def test_a_changed_program_has_the_scenes_of_the_simulations_that_it_makes_now(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, JUDGING, record=True)
    talk.say("run")
    talk.until("ended")
    path = recording(talk)
    curves = talk.say("curves", names=["walker x"])
    assert list(curves["curves"]) == ["walker x"]
    talk.say("seek", time=0.1)
    talk.until("paused", time=0.1)
    change(talk, "set_buffer", buffer="goal", chunk="narrow")
    assert talk.say("curves", names=["walker x"])["curves"] == {}
    (kept,) = [one for one in path.parent.glob("*.sqlite") if copied_from(one.stem) is not None]
    talk.say("run")
    talk.until("ended")
    changed = talk.say("curves", names=["walker x"])
    desk.do(talk.session.close())
    widths: list[list[float]] = []
    for one in (kept, path):
        with Recorded(one) as recorded:
            worlds = [recorded.facts[name]["world"] for name in ("simulation 2", "simulation 3") if recorded.facts.get(name)]
            widths.append([len(world["apertures"]) for world in worlds])
            assert replay(recorded).difference is None
    assert widths == [[1, 1], [2]]
    assert [curves_of(one, names=["walker x"], first=0.0, most=5_000) for one in (kept, path)] == [curves, changed]


def test_a_program_says_what_cannot_be_changed(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PROGRAM, record=True)
    with pytest.raises(RefusedError, match="the program has not begun, so there is no agent yet; step once first"):
        change(talk, "set_buffer", buffer="goal", chunk="a")
    there(talk, 0.1)
    with pytest.raises(RefusedError, match="no change 'aperture' for the agents of a program; there are: add_chunk, clear_buffer"):
        talk.say("command", word="aperture", values=[0.5])
    with pytest.raises(RefusedError, match=r"no buffer 'goa'; did you mean 'goal'\? There are: goal, retrieval"):
        change(talk, "set_buffer", buffer="goa", chunk="a")
    there(talk, 0.5)  # the second agent of the program
    with pytest.raises(RefusedError, match=r"no buffer 'goal'; there are: top#2.goal"):
        change(talk, "set_buffer", buffer="goal", chunk="a")
    change(talk, "set_buffer", buffer="top#2.goal", chunk="rest 7")
    assert talk.state["parts"]["top#2.goal"]["chunk"] == {"0": "rest", "1": "7"}
    talk.say("run")
    talk.until("ended")
    with pytest.raises(RefusedError, match="the run is over: go back to an earlier time"):
        change(talk, "clear_buffer", buffer="top#2.goal")


@pytest.mark.daily(1)
@pytest.mark.parametrize("kind", RUNS)
def test_a_paused_run_that_is_changed_says_when_also_after_an_undo(kind: str, desk: Desk, tmp_path: Path) -> None:
    source, _, below = RUNS[kind]
    talk = desk.begin(tmp_path, source)
    there(talk, 0.1)
    for chunk in ("rest 5", "rest 6"):
        change(talk, "set_buffer", buffer=f"{below}goal", chunk=chunk)
        talk.wait(lambda: talk.state["reason"] == "changed at 0.10 s")
        talk.say("undo")
        talk.wait(lambda: talk.state["reason"] == "undone at 0.10 s")
