"""Malicious files of recordings: none makes the reader compute without end, and each is refused with a reason."""

from __future__ import annotations

import shutil
import sqlite3
import struct
from collections.abc import Callable
from contextlib import closing
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from actr3d.errors import RecordingError
from actr3d.recording import Recorded, Recording, opening
from actr3d.recording.opening import opened
from actr3d.trace import TraceEvent
from workbench.exports import EXPORTS

ENDLESS = "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n)"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A recording of three events."""
    path = tmp_path / "run.sqlite"
    with Recording(path, {"kind": "program", "seed": 1}) as recording:
        for number in range(3):
            recording.event(TraceEvent(number, "top", "output", {"text": "x"}))
    return path


def altered(path: Path, script: str) -> None:
    with closing(sqlite3.connect(path)) as file:
        file.executescript(script)


@pytest.mark.parametrize(
    "script",
    [
        f"DROP TABLE facts; CREATE VIEW facts AS {ENDLESS} SELECT x AS name, x AS value FROM n",
        f"DROP TABLE events; CREATE VIEW events AS {ENDLESS} SELECT x AS first, 1 AS count, '[]' AS data, x AS checksum FROM n",
        "CREATE TRIGGER t AFTER INSERT ON facts BEGIN DELETE FROM facts; END",
        "CREATE VIRTUAL TABLE more USING fts5(x)",
        "DROP TABLE facts; CREATE TABLE facts (name TEXT, value AS (hex(zeroblob(400000000))))",
        "DROP TABLE answers",
        "CREATE TABLE more (x)",
        "CREATE INDEX more ON facts (hex(value))",
    ],
)
def test_a_file_with_other_tables_is_no_recording(path: Path, script: str) -> None:
    altered(path, script)
    with pytest.raises(RecordingError, match="it has other tables than a recording"):
        Recorded(path)


def test_no_value_is_larger_than_can_be_read(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    altered(path, f"INSERT INTO facts VALUES ('large', '{'x' * 2_000_000}')")
    monkeypatch.setattr(opening, "LARGEST_VALUE", 1_000_000)
    with pytest.raises(RecordingError, match="is not a recording: string or blob too big"):
        Recorded(path)


def link(path: Path) -> None:
    path.with_name("run.sqlite-wal").symlink_to("/dev/zero")


def gone(path: Path) -> None:
    path.unlink()


def loop(path: Path) -> None:
    path.unlink()
    path.symlink_to(path)


@pytest.mark.parametrize(("change", "problem"), [(link, "its journal is a symbolic link"), (gone, "no recording"), (loop, "no recording")])
def test_files_beside_a_recording_and_missing_ones_are_reported(path: Path, change: Callable[[Path], None], problem: str) -> None:
    kept = path.with_name("kept.sqlite")
    shutil.copy(path, kept)
    change(path)
    before = sorted(each.name for each in path.parent.iterdir())
    with pytest.raises(RecordingError, match=problem):
        opened(path)
    assert sorted(each.name for each in path.parent.iterdir()) == before  # no empty file is made in its place
    with Recorded(kept) as recorded:
        assert recorded.event_count == 3


def with_journal_of(victim: Path, path: Path) -> None:
    """Puts a rollback journal beside a recording that names a file as the journal of a larger transaction."""
    whole = path.read_bytes()
    page_size = int.from_bytes(whole[16:18], "big")
    magic = bytes.fromhex("d9d505f920a163d7")
    header = magic + struct.pack(">IIIII", 0, 0, len(whole) // page_size, 512, page_size)
    name = str(victim).encode()
    record = struct.pack(">I", 0x40000000 // page_size + 1) + name + struct.pack(">II", len(name), sum(name)) + magic
    path.with_name(f"{path.name}-journal").write_bytes(header.ljust(512, b"\0") + record)


def test_a_journal_that_names_another_file_does_not_delete_it(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    victim = tmp_path / "thesis.txt"
    victim.write_text("four years")
    monkeypatch.setattr(opening, "PATIENCE", 0.1)
    readers: list[Callable[[Path], Any]] = [opened, Recorded, lambda there: EXPORTS["sqlite"](there, tmp_path / "copy")]
    (link := tmp_path / "link.sqlite").symlink_to(path)
    for read, there in product(readers, (path, link)):
        with_journal_of(victim, path)
        with pytest.raises(RecordingError, match=r"run.sqlite' is not read: 'run.sqlite-journal' lies beside it"):
            read(there)
        assert victim.read_text() == "four years"
    path.with_name(f"{path.name}-journal").unlink()
    with Recorded(link) as recorded:
        assert recorded.event_count == 3
    with_journal_of(victim, path)
    with closing(sqlite3.connect(link)) as file:  # what SQLite does by itself
        file.execute("SELECT * FROM facts")
    assert not victim.exists()
