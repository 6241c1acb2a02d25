"""What lists tell of recordings, and how two are compared."""

from __future__ import annotations

import asyncio
import os
import sqlite3
import time
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager, closing
from pathlib import Path
from typing import Any

import pytest

from actr3d.errors import RecordingError
from actr3d.recording import Recorded, Recording
from actr3d.trace import TraceEvent
from tests.helpers.paths import MODELS
from tests.helpers.sessions import Desk
from workbench import listing
from workbench.jobs import Job, doing
from workbench.recording_diff import CONTEXT, compare
from workbench.recording_index import Summary
from workbench.worker.messages import Reply, Start
from workbench.worker.workers import Workers

APERTURE = (MODELS / "aperture_passage.py").read_text(encoding="utf-8")


def written(folder: Path, name: str, events: list[TraceEvent], **facts: object) -> Path:
    """Writes a recording of a program into a models folder."""
    path = folder / ".workbench" / "recordings" / f"{name}.sqlite"
    path.parent.mkdir(parents=True, exist_ok=True)
    with Recording(path, {"kind": "program", "seed": 1, "file": "m.py", "sources": {"m.py": "x = 1\ny = 2\n"}, **facts}) as recording:
        for event in events:
            recording.event(event)
    return path


def firing(count: int, last: str = "go", data: object = None) -> list[TraceEvent]:
    names = ["go"] * (count - 1) + [last]
    return [TraceEvent(50_000 * n, "agent", "fire", {"production": name, "bound": data}) for n, name in enumerate(names)]


def test_a_list_shows_the_result_and_values_that_differ_from_the_defaults(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.2}, run=True, wait="ended")
    name = talk.facts["recording"]
    assert talk.sessions.writing() == {name: talk.session.name}
    desk.do(talk.session.stop())
    assert talk.sessions.writing() == {}
    total, (summary,) = desk.listed(tmp_path)
    assert (total, summary.id, summary.model, summary.seed, summary.problem) == (1, name, "model.py", 1, None)
    assert summary.different == ("aperture",)
    assert summary.parameters["condition"] == "normal"
    assert summary.result is not None
    assert (summary.result["outcome"], summary.ended) == ("declined", "stop")
    with Recorded(talk.sessions.recordings.path(name)) as recorded:
        assert summary.time == pytest.approx(sum(1 for state in recorded.states() if state.tick) / 100)


def test_a_list_shows_the_last_values_that_a_user_gave_by_hand(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.25})
    for aperture in (0.26, 0.27):
        talk.say("command", word="aperture", values=[aperture])
    desk.do(talk.session.stop())
    _, (summary,) = desk.listed(tmp_path)
    assert (summary.parameters["aperture"], summary.changed) == (0.25, {"aperture": 0.27})


def test_a_seed_that_a_browser_would_round_is_sent_as_text(desk: Desk, tmp_path: Path) -> None:
    seeds = {"one": 2**53 + 1, "other": 2**53, "small": 7, "text": "a 1"}
    paths = {name: written(tmp_path, name, firing(1), seed=seed) for name, seed in seeds.items()}
    _, summaries = desk.listed(tmp_path)
    assert {one.id: one.seed for one in summaries} == {"one": str(2**53 + 1), "other": str(2**53), "small": 7, "text": "a 1"}
    assert compare(paths["one"], paths["other"])["parameters"] == {"seed": [str(2**53 + 1), str(2**53)]}


FAILING = """from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    def init():
        goal.set("begin")
    def fail(goal="begin"):
        raise ValueError("too far")

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker}, seed=1)
"""


@pytest.mark.parametrize("source", [FAILING, "print('begun')\nraise ValueError('too far')\n"], ids=["built", "program"])
def test_a_list_shows_the_exception_of_a_model(desk: Desk, tmp_path: Path, source: str) -> None:
    talk = desk.begin(tmp_path, source, record=True, run=True, wait="failed")
    desk.do(talk.session.stop())
    summary = desk.listed(tmp_path)[1][0]
    assert summary.ended is None
    assert "ValueError: too far" in str(summary.failed)


def test_a_run_that_goes_another_way_before_it_failed_has_not_failed(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, FAILING, record=True, run=True, wait="failed")
    talk.say("seek", time=0.01)
    talk.until("paused", time=0.01)
    talk.say("command", body="walker", word="walk", values=[1.0])
    desk.do(talk.session.stop())
    assert desk.listed(tmp_path)[1][0].failed is None


def test_a_list_has_the_newest_first_and_names_what_cannot_be_read(desk: Desk, tmp_path: Path) -> None:
    written(tmp_path, "m-20260102-000000-aaaa", firing(3))
    written(tmp_path, "m-20260103-000000-aaaa", firing(2))
    old = written(tmp_path, "m-20260101-000000-aaaa", [], form="actr3d recording 1")
    torn = written(tmp_path, "m-20251231-000000-aaaa", firing(3))
    torn.write_bytes(b"no recording at all" * 100)
    os.utime(old)
    total, found = desk.listed(tmp_path)
    assert (total, [summary.id[2:10] for summary in found]) == (4, ["20260103", "20260102", "20260101", "20251231"])
    assert [summary.events for summary in found] == [2, 3, 0, 0]
    assert "it says 'actr3d recording 1'" in str(found[2].problem)
    assert "a file of another kind" in str(found[3].problem)
    assert [summary.id for summary in desk.listed(tmp_path, 1, 2)[1]] == [summary.id for summary in found[1:3]]


def test_models_are_listed_with_their_folders(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "link.py").symlink_to("a/walk.py")
    (tmp_path / "loop.py").symlink_to("loop.py")
    outside = tmp_path.parent / "outside.py"
    files = {
        "a": (tmp_path / "a" / "walk.py", "a/walk.py"),
        "b": (tmp_path / "a" / ".." / "b" / "walk.py", "b/walk.py"),
        "linked": (tmp_path / "link.py", "link.py"),
        "outside": (outside, "outside.py"),
        "loop": (tmp_path / "loop.py", "loop.py"),
        "bare": ("walk.py", "walk.py"),  # it does not say of which folder
        "none": ("", ""),
    }
    paths = {name: written(tmp_path, name, firing(1), file=str(file), sources={str(file): name}) for name, (file, _) in files.items()}
    assert {one.id: one.model for one in desk.listed(tmp_path)[1]} == {name: shown for name, (_, shown) in files.items()}
    told = compare(paths["a"], paths["b"])
    assert (told["parameters"], told["difference"]) == ({}, None)
    assert told["text"][-2:] == ["-a", "+b"]  # files of one name may be versions of one model


def test_a_summary_is_read_again_when_its_file_has_changed(desk: Desk, tmp_path: Path) -> None:
    listing = desk.sessions(tmp_path).listing
    path = tmp_path / ".workbench" / "recordings" / "m.sqlite"
    path.parent.mkdir(parents=True)

    def summary() -> Summary:
        return desk.do(listing.one("m"))

    with Recording(path, {"kind": "program", "seed": 1}) as recording:
        assert summary().events == 0
        recording.event(firing(1)[0])
        end = time.monotonic() + 10
        while summary().events == 0 and time.monotonic() < end:
            time.sleep(0.05)
        assert summary().events == 1
        beside = path.with_name("m.sqlite-wal").stat().st_size
        assert beside > 0
        assert summary().size >= path.stat().st_size + beside  # what is new lies there until the run has ended
        assert summary() is summary()


def test_a_list_asked_for_after_a_change_has_the_change_although_an_earlier_reading_is_not_over(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / ".workbench" / "recordings" / "m.sqlite"
    path.parent.mkdir(parents=True)
    sessions = desk.sessions(tmp_path)

    async def both(recording: Recording) -> tuple[Summary, Summary]:
        was_read, may_answer = asyncio.Event(), asyncio.Event()

        @asynccontextmanager
        async def first_answers_late(workers: Workers, start: Start, job: Job, **more: Any) -> AsyncGenerator[Job]:
            answers: list[Reply] = []

            def hold(message: Reply) -> None:
                answers.append(message)

            reply, job.reply = job.reply, hold
            async with doing(workers, start, job, **more):
                await job.over.wait()
                if not was_read.is_set():
                    was_read.set()
                    await may_answer.wait()
                for answer in answers:
                    reply(answer)
                yield job

        monkeypatch.setattr(listing, "doing", first_answers_late)
        first = asyncio.create_task(sessions.listing.one("m"))
        await was_read.wait()
        recording.fact("ended", {"by": "stop"})
        recording.flush()
        second = await asyncio.wait_for(sessions.listing.one("m"), 60)
        may_answer.set()
        return await first, second

    with Recording(path, {"kind": "program", "seed": 1, "file": "m.py"}) as recording:
        first, second = desk.do(both(recording))
    assert (first.ended, second.ended) == (None, "stop")


def test_the_first_difference_has_its_surroundings(tmp_path: Path) -> None:
    one = written(tmp_path, "a", [*firing(20, "left"), firing(21)[-1]], parameters={"width": 0.5, "same": 1})
    other = written(tmp_path, "b", firing(20, "right"), parameters={"width": 0.9, "same": 1}, sources={"m.py": "x = 1\ny = 3\n"})
    told = compare(one, other)
    assert told["parameters"] == {"width": [0.5, 0.9]}
    assert (told["same_events"], told["whole"]) == (19, True)
    difference = told["difference"]
    assert difference["time"] == 0.95
    assert [event[3]["production"] for event in difference["events"]] == ["left", "right"]
    assert [event[0] for event in difference["before"]] == [50_000 * n for n in range(19 - CONTEXT, 19)]
    assert difference["after"] == [[[1_000_000, "agent", "fire", {"production": "go", "bound": None}]], []]
    assert "-y = 2" in told["text"]
    assert "+y = 3" in told["text"]


def test_events_of_some_kinds_alone_are_compared(tmp_path: Path) -> None:
    one = written(tmp_path, "a", [TraceEvent(0, "agent", "output", {"text": "a"}), *firing(3)])
    other = written(tmp_path, "b", [TraceEvent(0, "agent", "output", {"text": "b"}), *firing(3)])
    assert compare(one, other)["same_events"] == 0
    told = compare(one, other, ["fire"])
    assert (told["difference"], told["same_events"], told["text"]) == (None, 3, [])
    told = compare(one, written(tmp_path, "c", firing(2)), ["fire"])
    assert told["difference"]["events"][1] is None
    assert told["same_events"] == 2


def test_where_objects_lie_is_no_difference(tmp_path: Path) -> None:
    one = written(tmp_path, "a", firing(3, data="<x at 0x7f01>"))
    assert compare(one, written(tmp_path, "b", firing(3, data="<x at 0x7f02>")))["difference"] is None


def test_damaged_recordings_are_not_compared(tmp_path: Path) -> None:
    one, other = written(tmp_path, "a", firing(3)), written(tmp_path, "b", firing(3))
    with closing(sqlite3.connect(other)) as file, file:
        file.execute("""INSERT OR REPLACE INTO facts VALUES ('parameters', '["no", "dict"]')""")
    with pytest.raises(RecordingError, match="the fact 'parameters' of a recording must be values by their names"):
        compare(one, other)
