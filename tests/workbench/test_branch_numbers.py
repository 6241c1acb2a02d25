"""The number of a branch among those of one moment: it is given once, and stays whatever happens to the others."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.asgi_client import COOKIE, GATE, HOST, JSON, ORIGIN, OURS, call
from tests.helpers.sessions import Desk, Talk
from tests.workbench.test_curves import PUSHED
from workbench.app import make_app
from workbench.recordings import Recordings
from workbench.sessions import Sessions


class Client:
    """Sends requests about the recordings of a folder."""

    def __init__(self, desk: Desk, folder: Path, sessions: Sessions | None = None) -> None:
        self._desk, self._app = desk, make_app(folder, GATE)
        self._app.state.sessions = sessions or desk.sessions(folder)

    def post(self, path: str, body: dict[str, Any]) -> dict[str, Any]:
        sent = json.dumps(body).encode()
        answer = self._desk.do(call(self._app, f"/api/{path}", HOST, COOKIE, ORIGIN, JSON, OURS, method="POST", body=sent))
        assert answer.status == 200, answer.body
        return json.loads(answer.body)

    def numbers(self) -> dict[str, int]:
        """Returns the numbers of all recordings by name."""
        found = self.listed()
        for name, number in found.items():
            assert json.loads(self._desk.do(call(self._app, f"/api/recordings/{name}", HOST, COOKIE)).body)["number"] == number
        return found

    def listed(self) -> dict[str, int]:
        """Returns the numbers that one list has."""
        answer = json.loads(self._desk.do(call(self._app, "/api/recordings", HOST, COOKIE)).body)
        return {one["id"]: one["number"] for one in answer["recordings"]}


def branch_at(talk: Talk, client: Client, time: float) -> str:
    """Changes the run at a time in its past; returns the name of the branch that is kept."""
    before = client.numbers().keys()
    talk.say("until", time=time + 0.2)
    talk.until("paused", tick=round(100 * time) + 20)
    talk.say("seek", time=time)
    talk.say("command", word="aperture", values=[0.3])
    (new,) = client.numbers().keys() - before
    return new


@pytest.mark.slow
def test_a_branch_keeps_its_number_when_others_of_its_moment_are_deleted_and_restored(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED, record=True)
    client = Client(desk, tmp_path, talk.sessions)
    talk.say("step", ticks=1)
    first, second, third = (branch_at(talk, client, 0.1) for _ in range(3))
    elsewhere = branch_at(talk, client, 0.05)
    begun = talk.session.recording
    assert client.numbers() == {begun: 1, first: 1, second: 2, third: 3, elsewhere: 1}
    trash = client.post(f"recordings/{third}/delete", {})["trash"]
    client.post(f"recordings/{first}/delete", {})
    assert client.numbers() == {begun: 1, second: 2, elsewhere: 1}
    talk.say("until", time=0.1)
    talk.until("paused", tick=10)
    fourth = branch_at(talk, client, 0.1)
    assert client.numbers() == {begun: 1, second: 2, fourth: 4, elsewhere: 1}
    client.post("restore", {"trash": trash})
    again = Client(desk, tmp_path)  # as after a restart of the workbench
    assert again.numbers() == client.numbers() == {begun: 1, second: 2, third: 3, fourth: 4, elsewhere: 1}


def test_recordings_of_a_tree_that_a_user_calls_the_same_have_numbers_too(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED, record=True)
    client = Client(desk, tmp_path, talk.sessions)
    talk.say("step", ticks=1)
    first, second = (branch_at(talk, client, 0.1) for _ in range(2))
    for name in (second, first):
        client.post(f"recordings/{name}/label", {"name": "mine"})
        client.numbers()
    assert (client.numbers()[first], client.numbers()[second]) == (2, 1)
    client.post(f"recordings/{second}/label", {"name": ""})
    assert (client.numbers()[first], client.numbers()[second]) == (2, 2)  # what each had been given


def test_numbers_of_trees_that_are_gone_for_good_are_forgotten(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED, record=True)
    client = Client(desk, tmp_path, talk.sessions)
    talk.say("step", ticks=1)
    branch = branch_at(talk, client, 0.1)
    desk.do(talk.session.stop())
    recordings = Recordings(tmp_path)
    file = recordings.path(branch).with_name("numbers.json")
    (tree,) = json.loads(file.read_text("utf-8"))
    for name in client.numbers():
        client.post(f"recordings/{name}/delete", {})
    other = desk.begin(tmp_path, PUSHED, record=True)
    client = Client(desk, tmp_path, other.sessions)
    other.say("step", ticks=1)
    branch_at(other, client, 0.1)
    assert tree in json.loads(file.read_text("utf-8"))  # it may be restored
    shutil.rmtree(tmp_path / ".workbench" / "trash")
    branch_at(other, client, 0.1)
    assert list(json.loads(file.read_text("utf-8"))) == [other.session.recording]


@pytest.mark.slow
def test_a_file_of_numbers_that_is_damaged_or_cannot_be_written_is_no_obstacle(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED, record=True)
    client = Client(desk, tmp_path, talk.sessions)
    talk.say("step", ticks=1)
    first, second = (branch_at(talk, client, 0.1) for _ in range(2))
    file = Recordings(tmp_path).path(first).with_name("numbers.json")
    for damaged in ("[", "[]", '{"x": 1}'):
        file.write_text(damaged, "utf-8")
        assert (client.numbers()[first], client.numbers()[second]) == (1, 2)
    file.unlink()
    lock = file.with_name(".numbers.json.lock")
    lock.unlink()
    lock.mkdir()
    assert (client.listed()[first], client.listed()[second]) == (1, 2)
