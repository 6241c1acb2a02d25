"""Contacts within ticks: a recording has those that the skin feels in each tick, and does not change the run."""

from __future__ import annotations

import csv
import json
import re
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from actr3d.actr.loading import load_text
from actr3d.cli import main
from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from actr3d.simulation import Simulation
from actr3d.world import Floor, Scene
from actr3d.world.contacts import Touch
from tests.helpers.recording_forgery import forge
from tests.helpers.replays import verdict
from tests.helpers.walkers import STRUCK
from tests.world.sensors.test_sensors import Crate
from workbench.csv_files import write_states_csv

TICKS = 400
PROGRAM = STRUCK.replace("def build()", "def made()") + "\nmade().run(1.0)\nmade().run(4.0)\n"
Contacts = dict[int, dict[tuple[str, str, str], float]]


def struck() -> Simulation:
    return load_text(STRUCK).build()


def felt(simulation: Simulation, ticks: int = TICKS) -> Contacts:
    """Runs a simulation whose agent reads the skin; returns the felt contacts by tick."""
    skin = simulation.world.bodies["walker"]
    skin.touched = tuple[Touch, ...]()
    found: Contacts = {}
    for tick in range(1, ticks + 1):
        simulation.step()
        if skin.touched:
            found[tick] = {("walker", touch.part, touch.other): touch.force for touch in skin.touched}
    return found


def contacts_of(path: Path, run: int = 1) -> Contacts:
    with Recorded(path) as recorded:
        recorded.check()
        return {state.tick: dict(state.contacts) for state in recorded.states() if state.contacts and state.run == run}


@pytest.fixture(name="known", scope="module")
def known_() -> Contacts:
    known = felt(struck())
    assert len(known) > 3
    return known


@pytest.fixture(name="original", scope="module")
def original_(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("contacts") / "run"
    simulation = struck()
    with simulation.record(path):
        simulation.step(TICKS)
    return path


def test_a_recording_has_the_contacts_within_each_tick(original: Path, known: Contacts) -> None:
    assert contacts_of(original) == known
    plain, at_ends = struck(), set[int]()
    with Recorded(original) as recorded:
        for state in recorded.states():
            assert plain.world.state_bytes() == state.data, "the run is the same without a recording"
            plain.step()
            if not plain.world.bodies["walker"].contacts.none():
                at_ends.add(state.tick + 1)
        assert replay(recorded, struck).difference is None
    assert known.keys() - at_ends, "some are over before the end of their tick"


def test_a_recording_of_a_program_has_them_of_each_simulation(known: Contacts, tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(PROGRAM, encoding="utf-8")
    path = tmp_path / "run"
    assert main(["run", str(tmp_path / "program.py"), "--seed", "1", "--record", str(path)]) == 0
    assert contacts_of(path, run=2) == known
    assert "every byte agrees: 500 ticks" in verdict(path).text
    write_states_csv(path, tmp_path / "states.csv")
    with (tmp_path / "states.csv").open(encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    table = {(row[0], int(row[1])): row[-1] for row in rows if row[0] != "run"}
    assert head[-1] == "contacts"
    assert {at: json.loads(text) for at, text in table.items() if text} == {
        ("2", tick): [[*contact, force] for contact, force in contacts.items()] for tick, contacts in known.items()
    }


def test_another_future_has_contacts_of_its_own(known: Contacts, tmp_path: Path) -> None:
    simulation = struck()
    first = min(known)
    with simulation.record(tmp_path / "run") as recording:
        simulation.step(TICKS)
        recording.flush()
        simulation.seek(first / 100)
        simulation.command("teleport", 0.0, 0.0, 0.0, body="walker")
        simulation.step(5)
    assert contacts_of(tmp_path / "run") == {first: known[first]}
    with Recorded(tmp_path / "run") as recorded:
        assert replay(recorded, struck).difference is None


def test_contacts_of_resting_objects_are_not_recorded(tmp_path: Path) -> None:
    simulation = Simulation(Scene(parts=(Floor(), Crate(height=0.2))))
    with simulation.record(tmp_path / "run"):
        simulation.step(20)
    assert {touch.other for touch in simulation.world.bodies["crate"].get("contacts")} == {"floor"}
    with closing(sqlite3.connect(tmp_path / "run")) as file:
        assert {text for (text,) in file.execute("SELECT contacts FROM states")} == {"[]"}
    assert contacts_of(tmp_path / "run") == {}


@pytest.mark.parametrize(
    ("contacts", "message"),
    [
        ("7", "is damaged: 'int' object is not iterable"),
        ("[7]", "is damaged: "),
        ("[[0, 'walker']]", "is damaged: "),
        ('[["0", "walker", "arm", "block", 1.0]]', "is not one of its contacts"),
        ('[[100000, "walker", "arm", "block", 1.0]]', "is not one of its contacts"),
        ('[[-1, "walker", "arm", "block", 1.0]]', "is not one of its contacts"),
        ('[[0, "walker", "arm", "block", 1]]', "is not one of its contacts"),
        ('[[0, "walker", "arm", "block", NaN]]', "is not one of its contacts"),
        ('[[0, "walker", "arm", 1.0]]', "is not one of its contacts"),
        ("[" * 200_000, "something in it is nested too deeply"),
    ],
)
def test_damaged_contacts_are_reported(contacts: str, message: str, original: Path, tmp_path: Path) -> None:
    path = tmp_path / "run"
    path.write_bytes(original.read_bytes())
    forge(path, lambda file: file.execute("UPDATE states SET contacts = ? WHERE first = 0", (contacts,)))
    with Recorded(path) as recorded, pytest.raises(RecordingError, match=re.escape(message)):
        list(recorded.states())


def test_forged_contacts_are_found_by_a_replay(original: Path, tmp_path: Path) -> None:
    path = tmp_path / "run"
    path.write_bytes(original.read_bytes())
    forge(path, """UPDATE states SET contacts = '[[0, "walker", "nose", "block", 2.5]]' WHERE first = 0""")
    with Recorded(path) as recorded:
        found = str(replay(recorded, struck))
    assert found == 'differs: contacts in tick 0 (0 s); recorded: [["walker", "nose", "block", 2.5]]; now: []'
