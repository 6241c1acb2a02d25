"""A recording that is opened is known whole at once, can be sent to any time of it, and does again what it did."""

from __future__ import annotations

import json
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from actr3d.errors import Actr3dError, RecordingError
from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from tests.helpers.recording_forgery import forge
from tests.helpers.sessions import Desk, Talk
from tests.helpers.workbench_server import MODELS
from workbench.trash import OWN
from workbench.worker import known_run

BUILT = """
from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Aperture, Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    felt = Buffer()
    skin = BodyPort(felt)
    def init():
        goal.set('walk')
        skin.set('walk', 1.0)
    def feel(goal='walk', felt=None, skin='busy:False'):
        skin.request('pose')
    def look(goal='walk', felt='pose x:?x'):
        felt.clear()
        print(round(float(x), 3))
        if float(x) > 0.8:
            self.stop()

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Aperture(width=0.9), Mannequin(name='walker'))), {'walker': Walker})
"""
COUNTING = (MODELS / "tutorial" / "counting.py").read_text(encoding="utf-8")


def reopened(talk: Talk, recording: str | None = None) -> Talk:
    """Opens the recording of a session, which is over then."""
    name = recording or talk.facts["recording"]
    talk.desk.do(talk.sessions.close(talk.session.name))
    session = talk.desk.do(talk.sessions.reopen(name))
    again = Talk(talk.desk, session, talk.sessions)
    again.until("paused")
    return again


def whole(talk: Talk) -> list[list[Any]]:
    return [json.loads(event) for event in list(talk.session.log._events)]


@pytest.mark.parametrize("source", [BUILT, COUNTING], ids=["built", "program"])
def test_a_recording_shows_all_its_time_at_its_start_and_does_again_what_it_did(desk: Desk, tmp_path: Path, source: str) -> None:
    talk = desk.begin(tmp_path, source, record=True)
    if source == BUILT:
        talk.say("until", time=0.3)
        talk.until("paused", time=0.3)
        talk.say("command", word="aperture", values=[0.7])
    talk.say("run")
    talk.until("ended")
    end, events = talk.state, talk.events
    middle = round(end["time"] / 2, 2)
    talk.say("seek", time=middle)
    talk.until("paused", time=middle)
    at_middle = talk.state
    curves = talk.say("curves") if source == BUILT else None
    again = reopened(talk)
    assert again.session.log.first == 0
    assert whole(again) == events
    assert again.say("events", most=20_000)["events"] == events[: again.state["events"]]
    known = again.say("events", most=20_000, ahead=True)
    assert (known["events"], known["next"], known["total"]) == (events, len(events), again.state["events"])
    assert again.say("events", first=len(events) - 2, most=20_000, ahead=True)["events"] == events[-2:]
    assert (again.state["time"], again.state["furthest"], again.state["reason"]) == (0, end["furthest"], "at its start")
    assert again.facts["recorded"] == talk.facts["recording"]
    if curves is not None:
        assert again.say("curves") == curves
    again.say("seek", time=middle)
    again.until("paused", time=middle)
    assert {**again.state, "wanted": None} == at_middle
    again.say("seek", time=0)
    again.until("paused", time=0)
    again.say("run")
    again.until("ended")
    assert whole(again) == events
    assert {name: again.state[name] for name in ("time", "furthest", "reason", "result", "events")} == {
        name: end[name] for name in ("time", "furthest", "reason", "result", "events")
    }
    assert again.facts["cuts"] == []
    assert again.notices == []


def test_any_events_of_a_recorded_run_are_read_from_their_blocks(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    talk = desk.begin(tmp_path, COUNTING, record=True, run=True, wait="ended")
    desk.do(talk.sessions.close(talk.session.name))
    monkeypatch.setattr(known_run, "BLOCK", 5)
    known = known_run.KnownRun(talk.sessions.recordings.path(talk.facts["recording"]))
    assert known.count > 20
    events = [tuple(json.loads(event)) for event in known.events]
    for first, end in ((0, known.count + 9), (0, 5), (4, 6), (5, 10), (7, 8), (9, 9), (known.count, known.count + 1)):
        assert known.between(first, end) == events[first:end]


def test_a_recording_with_values_that_no_worker_receives_is_refused(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING, record=True, run=True, wait="ended")
    name = talk.facts["recording"]
    desk.do(talk.sessions.close(talk.session.name))
    path = talk.sessions.recordings.path(name)
    change = "INSERT OR REPLACE INTO facts VALUES ('{}', '{}')"
    for fact, value, problem in (
        ("helpers", '{"helper": ["helper.py", "\\ud800"]}', "a text in it cannot be encoded"),
        ("seed", str(2**64), "a whole number in it has more than 64 bits"),
    ):
        forge(path, change.format(fact, value))
        with pytest.raises(RecordingError, match=problem):
            desk.do(talk.sessions.reopen(name))


def test_the_end_of_a_recording_is_where_it_ended(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, BUILT, record=True, run=True, wait="ended")
    end = talk.state["time"]
    again = reopened(talk)
    again.say("seek", time=end)
    again.until("ended", time=end)
    assert again.state["result"] == talk.state["result"]


def test_another_way_than_the_recorded_one_leaves_what_was_recorded_ahead(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, BUILT, record=True, run=True, wait="ended")
    events = talk.events
    again = reopened(talk)
    again.say("seek", time=0.2)
    again.until("paused", time=0.2)
    again.say("command", word="aperture", values=[0.5])
    again.until("paused", time=0.2, furthest=0.2)
    assert len(whole(again)) < len(events)
    assert again.facts["cuts"] != []
    assert again.say("events", most=20_000, ahead=True)["next"] == again.state["events"]
    again.say("step")
    again.until("paused", time=0.21, furthest=0.21)
    assert again.notices == []


def test_a_run_that_differs_from_its_recording_says_from_when_on(desk: Desk, tmp_path: Path) -> None:
    source = "from pathlib import Path\nprint('one')\nprint(Path('said.txt').read_text())\nprint('three')\n"
    said = tmp_path / "said.txt"
    said.write_text("two", encoding="utf-8")
    source = source.replace("'said.txt'", repr(str(said)))
    talk = desk.begin(tmp_path, source, record=True, run=True, wait="ended")
    name = talk.facts["recording"]
    said.write_text("another", encoding="utf-8")
    again = reopened(talk, name)
    assert [event[3]["text"] for event in whole(again) if event[2] == "output"] == ["one", "two", "three"]
    again.say("run")
    again.until("ended")
    assert "differs from its recording" in again.wait_for_notice("differs")["text"]
    assert [event[3]["text"] for event in whole(again) if event[2] == "output"] == ["one", "another", "three"]
    branch = again.session.recording
    assert branch is not None
    assert again.facts["recorded"] == branch != name  # what happens now is kept
    assert talk.summary(branch).origin == name


def test_a_run_that_ends_before_its_recording_says_so(desk: Desk, tmp_path: Path) -> None:
    many = tmp_path / "many.txt"
    many.write_text("3", encoding="utf-8")
    source = f"from pathlib import Path\nfor n in range(int(Path({str(many)!r}).read_text())):\n    print(n)\n"
    talk = desk.begin(tmp_path, source, record=True, run=True, wait="ended")
    name = talk.facts["recording"]
    many.write_text("1", encoding="utf-8")
    again = reopened(talk, name)
    assert len(whole(again)) == 3
    again.say("run")
    again.until("ended")
    assert "it ends, but the recording continues" in again.wait_for_notice("differs")["text"]
    assert len(whole(again)) == 1


def test_a_recording_that_is_still_being_opened_goes_to_a_moment_at_once(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, BUILT, record=True)
    talk.say("until", time=0.2)
    talk.until("paused", time=0.2)
    name = talk.facts["recording"]
    desk.do(talk.sessions.close(talk.session.name))
    again = Talk(desk, desk.do(talk.sessions.reopen(name)), talk.sessions)
    again.say("seek", time=0.1)
    assert (again.state["time"], again.state["status"]) == (0.1, "paused")


def test_who_opens_a_recording_twice_gets_one_session(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING, record=True, run=True, wait="ended")
    again = reopened(talk)
    name = again.facts["recorded"]
    assert desk.do(talk.sessions.reopen(name)) is again.session
    again.say("restart")
    again.wait(lambda: again.session.run == 2)
    assert again.facts["recorded"] is None
    assert desk.do(talk.sessions.reopen(name)) is not again.session


def test_a_changed_recording_goes_by_what_it_writes_and_the_recording_is_opened_as_it_was(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, BUILT, record=True, run=True, wait="ended")
    again = reopened(talk)
    name = again.facts["recorded"]
    assert again.facts["recording"] is None
    again.say("seek", time=0.2)
    again.until("paused", time=0.2)
    again.say("command", word="aperture", values=[0.5])
    again.until("paused", furthest=0.2)
    branch = again.session.recording
    assert branch is not None
    assert again.facts["recorded"] == branch != name
    assert desk.do(talk.sessions.reopen(branch)) is again.session
    unchanged = desk.do(talk.sessions.reopen(name))
    assert unchanged is not again.session
    assert Talk(desk, unchanged, talk.sessions).until("paused")["furthest"] == talk.state["furthest"]
    assert again.state["furthest"] == 0.2
    assert talk.summary(branch).origin == name


@pytest.mark.daily(1)
@pytest.mark.parametrize("source", [BUILT, COUNTING], ids=["built", "program"])
def test_what_runs_past_the_end_of_a_recording_is_kept_as_a_branch_of_it(desk: Desk, tmp_path: Path, source: str) -> None:
    talk = desk.begin(tmp_path, source, record=True)
    talk.say("until", time=0.3)
    talk.until("paused", time=0.3)
    again = reopened(talk)
    name = again.facts["recorded"]
    again.say("until", time=0.3)
    again.until("paused", time=0.3)
    assert (again.facts["recorded"], again.facts["recording"]) == (name, None)
    again.say("until", time=0.5)
    again.until("paused", time=0.5)
    branch = again.session.recording
    assert branch is not None
    assert again.facts["recorded"] == branch != name
    assert {key: again.facts["branched"][key] for key in ("recording", "at", "until")} == {"recording": name, "at": 0.3, "until": 0.3}
    events = whole(again)
    unchanged = Talk(desk, desk.do(talk.sessions.reopen(name)), talk.sessions)
    assert unchanged.until("paused")["furthest"] == 0.3
    further = reopened(again, branch)
    assert (further.state["furthest"], whole(further)) == (0.5, events)
    assert (talk.summary(branch).branched, talk.summary(branch).origin, talk.summary(branch).ancestors) == (0.3, name, ())
    further.say("until", time=0.6)
    further.until("paused", time=0.6)
    last = talk.summary(further.session.recording or "")
    assert (last.branched, last.origin, last.ancestors) == (0.5, branch, ((name, 0.3),))


def test_a_branch_that_is_changed_before_it_left_its_origin_has_left_it_earlier(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, BUILT, record=True)
    talk.say("until", time=0.6)
    talk.until("paused", time=0.6)
    origin = talk.facts["recording"]
    again = reopened(talk)
    for at, width in ((0.4, 0.5), (0.1, 0.7)):
        again.say("seek", time=at)
        again.until("paused", time=at)
        again.say("command", word="aperture", values=[width])
        again.wait(lambda at=at: again.facts["branched"] is not None and again.facts["branched"]["at"] == at)
        again.say("until", time=0.6)
        again.until("paused", time=0.6)
    branch, kept = again.session.recording or "", again.facts["branched"]["recording"]
    before, now = talk.summary(kept), talk.summary(branch)
    assert (before.branched, before.origin, before.ancestors) == (0.4, origin, ())
    assert (now.branched, now.origin, now.ancestors) == (0.1, kept, ((origin, 0.4),))


@pytest.mark.parametrize("source", [BUILT, COUNTING], ids=["built", "program"])
def test_a_renamed_recording_is_known_to_its_branches_by_its_first_name(desk: Desk, tmp_path: Path, source: str) -> None:
    talk = desk.begin(tmp_path, source, record=True)
    talk.say("until", time=0.3)
    talk.until("paused", time=0.3)
    first = str(talk.facts["recording"])
    if source == BUILT:
        talk.say("seek", time=0.2)
        talk.say("command", word="aperture", values=[0.5])
    kept = talk.facts["branched"]["recording"] if source == BUILT else None
    desk.do(talk.sessions.close(talk.session.name))
    recordings = tmp_path / OWN / "recordings"
    (recordings / f"{first}.sqlite").rename(recordings / "renamed.sqlite")
    again = Talk(desk, desk.do(talk.sessions.reopen("renamed")), talk.sessions)
    again.say("until", time=0.5)
    again.until("paused", time=0.5)
    branch = talk.summary(again.session.recording or "")
    assert (talk.summary("renamed").named, branch.origin, branch.named) == (first, first, branch.id)
    if kept is not None:
        before = talk.summary(kept)
        (recordings / f"{kept}.sqlite").rename(recordings / "kept.sqlite")
        renamed = talk.summary("kept")
        assert (renamed.named, renamed.origin, renamed.kept) == (kept, first, before.kept)
    with Recorded(talk.sessions.recordings.path("renamed")) as recorded:
        compared = replay(recorded)
    assert (compared.difference, [note for note in compared.notes if "named" in note]) == (None, [])


@pytest.mark.parametrize("ahead", [False, True], ids=["at its end", "in its past"])
def test_a_recording_that_is_deleted_while_it_is_open_is_open_still_and_a_change_of_it_is_kept(
    desk: Desk, tmp_path: Path, ahead: bool
) -> None:
    talk = desk.begin(tmp_path, BUILT, record=True)
    talk.say("until", time=0.3)
    talk.until("paused", time=0.3)
    again = reopened(talk)
    name = again.facts["recorded"]
    assert again.facts["made"] > 0
    talk.sessions.recordings.delete(name)
    talk.sessions.announce_recordings()
    again.wait(lambda: again.facts["made"] is None)
    assert desk.do(talk.sessions.reopen(name)) is again.session
    again.say("seek", time=0.2 if ahead else 0.3)
    again.until("paused", time=0.2 if ahead else 0.3)
    again.say("command", word="aperture", values=[0.5], drop=ahead)
    again.wait(lambda: again.facts["recording"] is not None)
    branch = again.session.recording
    assert branch is not None
    assert again.facts["recorded"] == branch != name
    assert again.facts["branched"]["kept"] is False
    assert desk.do(talk.sessions.reopen(branch)) is again.session
    desk.do(talk.sessions.close(again.session.name))
    assert talk.summary(branch).branched == (0.2 if ahead else 0.3)
    with pytest.raises(Actr3dError, match="there is no such recording"):
        desk.do(talk.sessions.reopen(name))


def test_a_damaged_recording_is_not_opened(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTING, record=True, run=True, wait="ended")
    name = talk.facts["recording"]
    path = talk.sessions.recordings.path(name)
    desk.do(talk.sessions.close(talk.session.name))
    with closing(sqlite3.connect(path)) as file, file:
        file.execute('UPDATE events SET data = \'[["soon", "top", "start", {}]]\'')
    file.close()
    with pytest.raises(Actr3dError, match="is damaged"):
        desk.do(talk.sessions.reopen(name))
