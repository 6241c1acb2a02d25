"""Changing something in the past of a run: the original continuation is kept as a branch, or the change is refused."""

from __future__ import annotations

import json
import re
import time
from pathlib import Path
from typing import Any

import pytest

from actr3d.recording import Recorded
from tests.helpers.full_disk import full_disk
from tests.helpers.sessions import Desk, RefusedError, Talk, workers_of
from tests.workbench.test_curves import PUSHED
from tests.workbench.test_run_changes import RUNS, reopened
from workbench import retention
from workbench.protocol import COMMAND
from workbench.recording_index import summary_json

STOPPED = PUSHED.replace(
    """        goal.set("on")

def build""",
    """        goal.set("late")
    def end(goal="late"):
        self.stop()

def build""",
)
"""The same, but over soon."""


def folder(talk: Talk) -> Path:
    start = talk.session.start
    assert start is not None
    assert start.record is not None
    return Path(start.record).parent


def found(talk: Talk) -> list[Path]:
    return sorted(path for path in folder(talk).glob("*.sqlite") if retention.copied_from(path.stem) is not None)


def there(talk: Talk, tick: int) -> None:
    """Goes on to a tick."""
    talk.say("until", time=tick / 100)
    talk.until("paused", tick=tick)


def test_what_lies_ahead_is_kept_as_a_branch_before_the_run_goes_another_way(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED, record=True)
    there(talk, 40)
    before = talk.say("curves", names=["walker x"])
    talk.say("seek", time=0.1)
    with pytest.raises(RefusedError):
        talk.say("command", word="wlak", values=[1.0])
    assert found(talk) == []  # nothing was changed
    assert talk.say("curves", names=["walker x"]) == before
    talk.say("command", word="aperture", values=[0.3])
    talk.say("command", word="aperture", values=[0.35])  # there is nothing ahead any more
    assert talk.state["reason"] == "changed at 0.10 s"
    (branch,) = found(talk)
    origin = Path(talk.session.start.record).stem  # type: ignore[union-attr]
    assert branch.stem.startswith(f"{origin}-at-0.100s-")
    told = talk.session.branched
    assert told is not None
    assert (told.recording, told.at, told.until) == (branch.stem, 0.1, 0.4)
    shown = json.loads(talk.session.facts_json())["branched"]
    assert (shown["recording"], shown["kept"]) == (branch.stem, True)
    with Recorded(branch) as recorded:
        recorded.check()
        assert recorded.ticks == 40
        assert list(recorded.commands()) == []
    renamed = branch.rename(branch.with_name("tidy.sqlite"))
    assert json.loads(talk.session.facts_json())["branched"]["kept"] is False
    models = talk.sessions.folder
    assert b'"branched":0.1' in summary_json(renamed, models)
    renamed.rename(branch)
    assert b'"change":null' in summary_json(branch, models)
    assert b'"branched":null' in summary_json(branch.with_name(f"{origin}.sqlite"), models)
    assert retention.is_unnamed(branch)  # so that it goes, one day
    there(talk, 50)
    assert talk.say("curves", names=["walker x"])["times"][-1] == 0.5
    with Recorded(branch) as recorded:
        assert recorded.ticks == 40
    talk.say("seek", time=0.2)
    talk.say("command", word="aperture", values=[0.4])
    first, second = found(talk)
    changes = [json.loads(summary_json(path, models))["change"] for path in (first, second)]
    assert [change and (change["command"], change["data"]["values"]) for change in changes] == [None, None]


def test_a_branch_is_over_only_where_its_run_was_over(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, STOPPED, record=True)
    there(talk, 10)
    talk.say("seek", time=0.05)
    talk.say("command", word="aperture", values=[0.3])  # the first branch: of a run that was paused
    talk.say("run")
    talk.until("ended")
    talk.say("seek", time=0.05)
    talk.say("command", word="aperture", values=[0.4])  # the second: of a run that was over
    there(talk, 12)
    talk.say("seek", time=0.05)
    talk.say("command", word="aperture", values=[0.5])  # the third: it was over once, but then went another way, and was paused
    ends = {round(summary.time, 2): summary.ended for summary in (talk.summary(path.stem) for path in found(talk))}
    assert ends == {0.1: "left", 0.15: "stop", 0.12: "left"}


def test_what_is_not_recorded_is_lost_only_where_that_is_allowed(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED)
    there(talk, 40)
    talk.say("seek", time=0.1)
    with pytest.raises(RefusedError, match=r"what lies ahead, from 0.1 s to 0.4 s, would be lost: the run is not recorded"):
        talk.say("command", word="aperture", values=[0.3])
    assert talk.say("curves", names=["walker x"])["times"][-1] == 0.4
    talk.say("command", word="aperture", values=[0.3], drop=True)
    assert talk.say("curves", names=["walker x"])["times"][-1] == 0.1
    assert talk.session.branched is None
    assert talk.state["reason"] == "changed at 0.10 s; the rest was lost"


def test_what_cannot_be_kept_is_not_lost(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED, record=True)
    there(talk, 40)
    talk.say("seek", time=0.1)
    where = folder(talk)
    aside = where.rename(where.with_name("aside"))  # no file can be made there
    with pytest.raises(RefusedError, match=r"what lies ahead, from 0.1 s to 0.4 s, would be lost: it cannot be kept \(unable to open"):
        talk.say("command", word="aperture", values=[0.3])
    aside.rename(where)
    assert talk.say("curves", names=["walker x"])["times"][-1] == 0.4
    talk.say("command", word="aperture", values=[0.3])
    assert len(found(talk)) == 1


def test_on_a_full_disk_nothing_is_changed_and_the_known_part_of_the_run_can_still_be_seen(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED, record=True)
    there(talk, 40)
    talk.say("seek", time=0.1)
    with full_disk(lambda: workers_of(talk)):
        with pytest.raises(RefusedError, match=r"what lies ahead, from 0.1 s to 0.4 s, would be lost: it cannot be kept"):
            talk.say("command", word="aperture", values=[0.3])
        change = COMMAND.validate_python({"type": "command", "word": "aperture", "values": [0.3]})
        assert desk.do(change.submit(talk.session, "test")).loses
        talk.say("until", time=0.4)
        assert talk.until("paused", time=0.4)["furthest"] == 0.4
    talk.say("seek", time=0.1)
    talk.say("command", word="aperture", values=[0.3])
    assert len(found(talk)) == 1


ASKED = r"what lies ahead, from 0\.1 s to [0-9.]+ s, would be lost(, and what follows would not be recorded|: it cannot be kept)"


@pytest.mark.daily(1)
@pytest.mark.parametrize("undone", [False, True])
@pytest.mark.parametrize("failed", [True, False])
@pytest.mark.parametrize("kind", RUNS)
def test_a_run_that_is_changed_on_a_full_disk_goes_on_unrecorded(kind: str, failed: bool, undone: bool, desk: Desk, tmp_path: Path) -> None:
    source, agent, below = RUNS[kind]

    def changed(talk: Talk, **more: Any) -> None:
        if undone:
            talk.say("undo", **more)
        else:
            talk.say("command", word="forbid_once", named={"system": agent, "production": "up"}, **more)

    def behind(talk: Talk) -> list[Any]:
        talk.until("paused", time=0.1, furthest=0.1)
        reached: list[Any] = []
        for moment in (0.7, 0.05, 0.3, 0.1, 0.7, 1.5):
            talk.say("until" if moment > talk.state["time"] else "seek", time=moment)
            talk.until("paused", time=moment)
            reached.append([moment, talk.state["parts"], talk.say("events", most=20_000)["events"]])
        return reached

    def begun(name: str) -> Talk:
        talk = desk.begin(tmp_path, source, record=True, name=name)
        talk.say("until", time=0.1)
        talk.until("paused", time=0.1)
        if undone:
            talk.say("command", word="set_buffer", named={"buffer": f"{below}goal", "chunk": "count 5"})
        return talk

    control = begun("control.py")
    control.say("until", time=1.2)
    control.until("paused", time=1.2)
    control.say("seek", time=0.1)
    control.until("paused", time=0.1)
    changed(control)
    talk = begun("model.py")
    talk.say("until", time=1.0)
    talk.until("paused", time=1.0)
    with full_disk(lambda: workers_of(talk)):
        if failed:
            talk.say("run")
            talk.until("failed")
        talk.say("seek", time=0.1)
        talk.until("paused", time=0.1)
        with pytest.raises(RefusedError, match=ASKED):
            changed(talk)
        assert talk.state["furthest"] >= 1.0
        recorded = talk.facts["recording"]
        changed(talk, drop=True)
        done = "undone" if undone else "changed"
        talk.wait(lambda: talk.state["reason"] == f"{done} at 0.10 s; the rest was lost; what follows is not recorded")
        assert talk.facts["recording"] is None
        assert "cannot write the recording" in "".join(one["text"] for one in talk.notices)
        assert behind(talk) == behind(control)
    talk.say("seek", time=0.3)
    talk.until("paused", time=0.3)
    clear = {"word": "clear_buffer", "named": {"buffer": f"{below}goal"}}
    with pytest.raises(RefusedError, match=r"what lies ahead, from 0\.3 s to 1\.5 s, would be lost: the run is not recorded"):
        talk.say("command", **clear)
    talk.say("command", **clear, drop=True)
    assert talk.state["reason"] == "changed at 0.30 s; the rest was lost"
    desk.do(talk.session.stop())
    assert talk.facts["ending"] == "stopped"
    with Recorded(folder(control) / f"{recorded}.sqlite") as kept:
        kept.check()
        assert kept.event_count > 0, "what was recorded stays"


@pytest.mark.daily(1)
@pytest.mark.parametrize("kind", RUNS)
def test_an_opened_recording_that_is_changed_on_a_full_disk_goes_on_unrecorded(kind: str, desk: Desk, tmp_path: Path) -> None:
    source, _, below = RUNS[kind]
    path, talk = reopened(desk, tmp_path, source)
    clear = {"word": "clear_buffer", "named": {"buffer": f"{below}goal"}}
    with full_disk(lambda: workers_of(talk)):
        talk.say("until", time=0.2)
        talk.until("paused", time=0.2)
        time.sleep(0.5)  # what was run until then has been written, or cannot be
        talk.say("until", time=0.3)
        talk.until("paused", time=0.3)
        talk.say("seek", time=0.1)
        talk.until("paused", time=0.1)
        with pytest.raises(RefusedError, match=r"^what follows would not be recorded: "):
            talk.say("command", **clear)
        talk.say("command", **clear, drop=True)
        assert talk.state["reason"] == "changed at 0.10 s; what follows is not recorded"
        talk.wait(lambda: talk.facts["recording"] is None)
        assert re.fullmatch(r"What follows is not recorded: cannot write the recording .*", talk.facts["not_kept"])
        talk.say("until", time=0.5)
        talk.until("paused", time=0.5)
    facts = talk.facts
    assert (facts["recorded"], facts["recording"], facts["branched"]["recording"]) == (path.stem, None, path.stem)


@pytest.mark.daily(1)
@pytest.mark.parametrize("kind", RUNS)
def test_a_recording_is_opened_and_looked_at_although_no_file_can_be_written(
    kind: str, desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source, _, below = RUNS[kind]
    path, first = reopened(desk, tmp_path, source)
    desk.do(first.session.close())

    def nowhere(model: str) -> Path:
        return tmp_path / "nowhere" / f"{model}.sqlite"

    monkeypatch.setattr(first.sessions.recordings, "new", nowhere)
    talk = Talk(desk, desk.do(first.sessions.reopen(path.stem)), first.sessions)
    talk.until("paused", furthest=0.3)
    talk.say("until", time=0.3)
    talk.until("paused", time=0.3)
    assert talk.notices == []
    clear = {"word": "clear_buffer", "named": {"buffer": f"{below}goal"}}
    talk.say("seek", time=0.1)
    talk.until("paused", time=0.1)
    with pytest.raises(RefusedError, match=r"^what follows would not be recorded: "):
        talk.say("command", **clear)
    talk.say("command", **clear, drop=True)
    talk.wait(lambda: talk.facts["recording"] is None)
    assert re.fullmatch(r"What follows is not recorded: cannot write the recording .*", talk.facts["not_kept"])
    talk.say("until", time=0.5)
    talk.until("paused", time=0.5)


@pytest.mark.daily(1)
@pytest.mark.parametrize("kind", RUNS)
def test_an_opened_recording_that_goes_on_beyond_its_end_is_not_kept_if_no_file_can_be_written(
    kind: str, desk: Desk, tmp_path: Path
) -> None:
    path, talk = reopened(desk, tmp_path, RUNS[kind][0])
    with full_disk(lambda: workers_of(talk)):
        talk.say("until", time=0.5)
        talk.until("paused", time=0.5)
        talk.wait(lambda: talk.facts["recording"] is None)
        assert re.fullmatch(r"What follows is not recorded: cannot write the recording .*", talk.facts["not_kept"])
    assert talk.facts["branched"]["recording"] == path.stem


def test_branches_of_one_run_are_not_without_number(tmp_path: Path) -> None:
    origin = tmp_path / "doorway-20260101-101010-abcd.sqlite"
    made = [retention.new_branch(origin, 0.01 * n) for n in range(retention.MAX_BRANCHES + 3)]
    for path in (
        *made,
        origin,
        tmp_path / "doorway-20260101-101010-abcd-at-home.sqlite",
        retention.new_branch(tmp_path / "other.sqlite", 1.0),
    ):
        path.touch()
    assert len(retention.superfluous_branches(origin)) == 3
    assert set(retention.superfluous_branches(origin)) <= set(made)
    assert retention.copied_from(made[2].stem) == (origin.stem, 0.02)
    assert retention.copied_from(origin.stem) is None
