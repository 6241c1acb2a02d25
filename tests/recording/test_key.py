"""Each installation seals its recordings with its own key, and recognizes them by it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.recording.key import SIZE, key_file, make_key, own_key
from tests.helpers.recording_forgery import Change, change, forge
from tests.helpers.walkers import driving


@pytest.fixture(autouse=True)
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    return tmp_path / "data"


def recorded(path: Path) -> Path:
    simulation = driving()
    with simulation.record(path):
        simulation.run(0.1)
    return path


def made_here(path: Path) -> bool:
    with Recorded(path) as read:
        return read.made_here


def test_a_recording_is_recognized_by_the_installation_that_made_it(tmp_path: Path, data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = recorded(tmp_path / "run")
    assert made_here(path)
    assert key_file() == data / "actr3d" / "key"
    assert key_file().stat().st_mode & 0o777 == 0o600
    assert [file.name for file in key_file().parent.iterdir()] == ["key"]
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "elsewhere"))
    assert not made_here(path)
    assert not key_file().exists()  # reading makes no key
    make_key()
    assert not made_here(path)


@pytest.mark.parametrize(
    "changed",
    [
        "UPDATE facts SET value = replace(value, 'class Driver', 'class  Driver') WHERE name = 'sources'",
        "INSERT INTO facts VALUES ('built', 'true')",
        "DELETE FROM events",
        "UPDATE seal SET checksum = zeroblob(32)",
        "DELETE FROM seal",
    ],
)
def test_a_changed_recording_is_damaged_and_with_new_checksums_foreign(changed: Change, tmp_path: Path) -> None:
    path = recorded(tmp_path / "run")
    change(path, changed)
    with pytest.raises(RecordingError, match="is damaged: "):
        made_here(path)
    if changed != "DELETE FROM seal":
        forge(path, key=b"another key")
        assert not made_here(path)


def test_a_killed_rewound_or_copied_run_is_recognized_too(tmp_path: Path) -> None:
    simulation = driving()
    recording = simulation.record(tmp_path / "run")
    simulation.run(0.3)
    recording._writer.flush()
    assert made_here(tmp_path / "run")  # as a kill would leave it
    simulation.seek(0.17)
    recording.copy_to(tmp_path / "copy")
    simulation.command("aperture", 0.5)
    assert made_here(tmp_path / "run")
    simulation.run(0.2)
    recording.close()
    assert made_here(tmp_path / "run")
    assert made_here(tmp_path / "copy")


def test_many_processes_that_need_the_first_key_have_the_same(data: Path) -> None:
    code = "import sys; from actr3d.recording.key import make_key; sys.stdin.read(); print(make_key().hex())"
    pipe = subprocess.PIPE
    many = [subprocess.Popen([sys.executable, "-c", code], text=True, stdin=pipe, stdout=pipe) for _ in range(4)]
    for one in many:
        assert one.stdin is not None
        one.stdin.close()
    keys = {one.stdout.read().strip() for one in many if one.stdout is not None}
    for one in many:
        assert one.stdout is not None
        one.stdout.close()
        assert one.wait() == 0
    key = own_key()
    assert key is not None
    assert keys == {key.hex()}


def test_an_invalid_key_is_replaced(tmp_path: Path) -> None:
    path = recorded(tmp_path / "run")
    key_file().write_bytes(b"")
    assert not made_here(path)
    assert made_here(recorded(tmp_path / "other"))
    assert len(key_file().read_bytes()) == SIZE


def test_without_a_key_no_recording_is_of_this_installation(tmp_path: Path, data: Path) -> None:
    data.write_text("no folder", encoding="utf-8")
    path = recorded(tmp_path / "run")
    assert not made_here(path)
    data.unlink()
    make_key()
    assert not made_here(path)
