"""A recording with any change is damaged: it never agrees, and never causes a traceback."""

from __future__ import annotations

import random
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from actr3d.cli import main
from actr3d.errors import RecordingError
from actr3d.recording import Recorded, Recording
from actr3d.recording.schema import COLUMNS
from actr3d.runner.replay import replay
from tests.helpers.recording_forgery import change, forge
from tests.helpers.walkers import driving

EDITS = 400


@pytest.fixture(name="original", scope="module")
def original_(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small recording with several rows of each kind."""
    path = tmp_path_factory.mktemp("damage") / "run"
    simulation = driving()
    with simulation.record(path, built=False) as recording:
        for turn in range(4):
            simulation.run(0.1)
            recording._writer.flush()
            simulation.command("aperture", 0.5 + turn / 10)
        recording.fact("ended", {"by": "seconds"})
    return path


def content(path: Path) -> list[Any]:
    """Returns the content of a recording without its checksums."""
    with closing(sqlite3.connect(path)) as file:
        tables = [file.execute(f"SELECT * FROM {table} ORDER BY 1").fetchall() for table in COLUMNS]
        return [file.execute("SELECT * FROM facts ORDER BY 1").fetchall(), *([row[:-1] for row in rows] for rows in tables)]


def sealed(path: Path) -> list[Any]:
    """Returns the seal of a recording, which shows that this installation made it."""
    with closing(sqlite3.connect(path)) as file:
        return file.execute("SELECT * FROM seal").fetchall()


def altered(value: Any, choose: random.Random) -> Any:
    """Returns another value than one from a table."""
    if isinstance(value, int):
        return value + choose.choice([-1, 1, 777])
    at = choose.randrange(len(value))
    if isinstance(value, bytes):
        return value[:at] + bytes([value[at] ^ 1 << choose.randrange(8)]) + value[at + 1 :]
    letter = choose.choice([other for other in '0179 "xX}[' if other != value[at]])
    return value[:at] + choose.choice([letter, "", letter + value[at]]) + value[at + 1 :]


def edit(file: sqlite3.Connection, choose: random.Random) -> None:
    """Changes a database, as an editor for databases could."""
    table = choose.choice(["facts", "facts", "seal", *COLUMNS])
    key = "name" if table == "facts" else "first"
    rows = file.execute(f"SELECT * FROM {table}").fetchall()
    columns = [column[1] for column in file.execute(f"PRAGMA table_info({table})")]
    row, other = choose.sample(rows, 2) if len(rows) > 1 else rows * 2
    column = choose.randrange(len(columns) - (table in COLUMNS))  # also the checksum of the seal
    match choose.randrange(5):
        case 0:
            file.execute(f"DELETE FROM {table} WHERE {key} = ?", (row[0],))
        case 1 if row is not other:  # two rows change places
            for here, there in ((row, other), (other, row)):
                assigned = ", ".join(f"{name} = ?" for name in columns[1:])
                file.execute(f"UPDATE {table} SET {assigned} WHERE {key} = ?", (*there[1:], here[0]))
        case 2 if table == "facts":
            file.execute("INSERT OR REPLACE INTO facts VALUES (?, ?)", (f"new{choose.random()}", row[1]))
        case 2:  # one row comes twice
            file.execute(f"INSERT INTO {table} VALUES (?{', ?' * (len(columns) - 1)})", (len(rows) * 1000, *row[1:]))
        case _:
            file.execute(f"UPDATE OR REPLACE {table} SET {columns[column]} = ? WHERE {key} = ?", (altered(row[column], choose), row[0]))


def test_a_recording_with_changed_content_never_agrees(original: Path, tmp_path: Path) -> None:
    whole, before = original.read_bytes(), content(original)
    found = {"damaged": 0, "foreign": 0, "the same": 0}
    seal = sealed(original)
    path = tmp_path / "run"
    for number in range(EDITS):
        choose = random.Random(number)
        data = bytearray(whole)
        if number % 2:
            data[choose.randrange(len(data))] ^= 1 << choose.randrange(8)
            path.write_bytes(data)
        else:
            path.write_bytes(data)
            with closing(sqlite3.connect(path)) as file, file:
                file.execute("PRAGMA synchronous=OFF")
                file.execute("PRAGMA journal_mode=OFF")
                edit(file, choose)
        try:
            with Recorded(path) as recorded:
                made_here = recorded.made_here  # a replay begins with it
        except RecordingError:
            found["damaged"] += 1
            continue
        assert content(path) == before, number
        assert made_here == (sealed(path) == seal), number
        found["the same" if made_here else "foreign"] += 1
    assert found["damaged"] > EDITS / 2
    assert found["foreign"] > 0
    with Recorded(original) as recorded:
        assert str(replay(recorded, driving)).startswith("every byte agrees: 40 ticks, ")


def test_a_recording_with_new_checksums_is_still_compared(original: Path, tmp_path: Path) -> None:
    path = tmp_path / "run"
    for forged, message in [
        (["DELETE FROM answers"], "differs: answer 1; recorded: nothing"),
        (["UPDATE facts SET value = '1000' WHERE name = 'timestep_us'"], "differs: the fact 'timestep_us'; recorded: 1000; now: 2000"),
        (["""UPDATE facts SET value = '"x"' WHERE name = 'scene'"""], "differs: the fact 'scene'; recorded: \"x\"; now: "),
        (
            ["""UPDATE facts SET value = 'null' WHERE name = 'ended'""", "DELETE FROM facts WHERE name = 'whole'"],
            "agrees up to the end of the recording: 40 ",
        ),
        (["UPDATE commands SET tick = 39 WHERE first = 3"], "differs: "),
        (["UPDATE commands SET tick = 4000 WHERE first = 3"], "the recording holds 1 event, 1 command more"),
        (["UPDATE commands SET run = 2 WHERE first = 0"], "differs: command 1; recorded: [2, "),
    ]:
        path.write_bytes(original.read_bytes())
        forge(path, *forged)
        with Recorded(path) as recorded:
            assert message in str(replay(recorded, driving)), forged


FACTS = [
    ("DELETE FROM facts WHERE name = 'file'", "cannot be run again: it lacks 'file'"),
    ("DELETE FROM facts WHERE name = 'seed'", "cannot be run again: it lacks 'seed'"),
    ("DELETE FROM facts WHERE name IN ('until', 'sources')", "it lacks 'sources', 'until'"),
    ("UPDATE facts SET value = '{}' WHERE name = 'sources'", "it lacks the source of "),
    (
        "UPDATE facts SET value = '[1]' WHERE name = 'versions'",
        "the fact 'versions' of a recording must be texts by their names, without NUL characters (got [1])",
    ),
    ("UPDATE facts SET value = '7' WHERE name = 'kind'", "must be 'simulation' or 'program' (got 7)"),
    ("UPDATE facts SET value = '[[]]' WHERE name = 'seed'", "must be a whole number or a text"),
    ("UPDATE facts SET value = 'NaN' WHERE name = 'until'", "must be a number > 0, or null"),
    ("INSERT OR REPLACE INTO facts VALUES ('helpers', '{\"a\": [1, 2]}')", "must be a file and a text by the names of modules"),
    (
        r"""UPDATE facts SET value = '"a\u0000b"' WHERE name = 'file'""",
        r"the fact 'file' of a recording must be a text without NUL characters (got 'a\x00b')",
    ),
    (r"""UPDATE facts SET value = '{"a\u0000b": "pass"}' WHERE name = 'sources'""", "must be texts by their names, without NUL characters"),
    (
        r"""INSERT OR REPLACE INTO facts VALUES ('helpers', '{"a": ["b\u0000", "pass"]}')""",
        "must be a file and a text by the names of modules",
    ),
    ("UPDATE seal SET first = 7", "is damaged: it has no checksum"),
    ("UPDATE facts SET value = '\"now\"' WHERE name = 'ended'", "the fact 'ended' of a recording must be"),
    (
        "INSERT INTO facts VALUES ('period_us', '\"soon\"')",
        "the fact 'period_us' of a recording must be a whole number > 0 (got 'soon')",
    ),
    (f"UPDATE facts SET value = '{'[' * 200_000}' WHERE name = 'seed'", "nested too deeply"),
    (f"UPDATE events SET data = '{'[' * 200_000}'", "is damaged: something in it is nested too deeply"),
    ("UPDATE events SET data = '[[0, 1, 2, 3]]', count = 1", "is damaged: "),
    ("UPDATE events SET data = '{}', count = 1", "is damaged: "),
    ("UPDATE events SET data = '7', count = 1", "is damaged: "),
    ("INSERT INTO commands VALUES (0, 1, 0, '{}', x'')", "is damaged: {} is not a command"),
    ('INSERT INTO commands VALUES (0, 1, 0, \'{"command": "x", "data": {"values": [], "named": {}}}\', x\'\')', "is not a command"),
    ('INSERT INTO commands VALUES (0, 1, 0, \'{"command": 1, "data": {"values": 1, "named": 2, "body": 3}}\', x\'\')', "is not a command"),
    ("INSERT INTO states VALUES (0, 1, x'00', x'00', '[]', x'')", "is damaged: "),
    ("CREATE VIEW more AS SELECT 1", "it has other tables than a recording"),
    (f"INSERT INTO facts VALUES ('reached', '1{'0' * 400}')", "the fact 'reached' of a recording must be"),
    ("DROP TABLE answers", "it has other tables than a recording"),
    ("UPDATE facts SET value = '\"actr3d recording 2\"' WHERE name = 'form'", "it has another format: it says 'actr3d recording 2'"),
]


@pytest.fixture(name="program", scope="module")
def program_(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("program")
    (folder / "model.py").write_text("print('one')\nprint('two')\n", encoding="utf-8")
    assert main(["run", str(folder / "model.py"), "--seed", "1", "--record", str(folder / "run")]) == 0
    return folder / "run"


@pytest.mark.parametrize(("statement", "message"), FACTS)
def test_errors_in_a_recording_are_reported(
    statement: str, message: str, program: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "run"
    path.write_bytes(program.read_bytes())
    if statement.startswith(("CREATE", "DROP")):
        change(path, lambda file: file.execute(statement))
    else:
        forge(path, statement)
    assert main(["replay", str(path)]) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("error: ")
    assert message in captured.err
    assert len(captured.err) < 1_000


def test_a_file_that_would_keep_a_reader_busy_for_ever_is_refused_immediately(program: Path, tmp_path: Path) -> None:
    path = tmp_path / "run"
    path.write_bytes(program.read_bytes())
    endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i, i FROM n"

    def spoil(file: sqlite3.Connection) -> None:
        file.execute("DROP TABLE facts")
        file.execute(f"CREATE VIEW facts (name, value) AS {endless}")

    change(path, spoil)
    with pytest.raises(RecordingError, match="it has other tables than a recording"):
        Recorded(path)


def test_a_fact_that_no_reader_understands_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"the fact 'file' of a recording must be a text without NUL characters \(got 7\)"):
        Recording(tmp_path / "run", {"kind": "program", "file": 7})
    assert not (tmp_path / "run").exists()
