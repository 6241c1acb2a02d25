"""A replay runs only the files in the recording, and only if the recording is trusted."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from actr3d.cli import main
from actr3d.errors import UntrustedError
from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from tests.helpers.recording_forgery import forge
from tests.helpers.walkers import driving

LOOKING = """
import importlib, importlib.util, os, sys, traceback
from pathlib import Path
import helper
sys.path.append(str(Path(__file__).parent / "lib"))
import inside
for name in ("extra", "package.late", "helper_too", "beside_it"):
    try:
        importlib.import_module(name)
        print("found", name)
    except ImportError as error:
        print(error)
try:
    import extra
except ImportError as error:
    print(error)
print(importlib.util.find_spec("extra"))
import package
try:
    from package import late
except ImportError as error:
    print(error)
print(__file__, helper.__file__, inside.__file__, package.__path__ and "package")
try:
    helper.fail()
except ZeroDivisionError:
    traceback.print_exc(file=sys.stdout)
"""
BUILT = """
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Scene
class Idle(ACTR):
    goal = Buffer()
    def init():
        goal.set("a")
    def go(goal="a"):
        print("went")
        goal.set("b")
def build() -> Simulation:
    return Simulation(Scene(), bodiless={"idle": Idle})
"""
FILES = {"helper.py": "def fail():\n    return 1 / 0\n", "lib/inside.py": "", "package/__init__.py": ""}
TRAP = "import os, pathlib; pathlib.Path(os.environ['TRAP']).touch()\n"
"""A module that must not run."""


@pytest.fixture(autouse=True)
def _path(monkeypatch: pytest.MonkeyPatch) -> None:
    """Removes what models add to the path."""
    monkeypatch.setattr(sys, "path", list(sys.path))


@pytest.fixture(name="trap")
def trap_(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("TRAP", str(tmp_path / "trap"))
    return tmp_path / "trap"


def recorded(folder: Path, text: str) -> Path:
    for name, content in {**FILES, "model.py": text}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content, encoding="utf-8")
    assert main(["run", str(folder / "model.py"), "--seed", "1", "--record", str(folder / "run")]) == 0
    return folder / "run"


@pytest.mark.daily(1)
@pytest.mark.parametrize("text", [LOOKING + "from python_actr import *\nclass A(ACTR): pass\nA().run()\n", LOOKING + BUILT])
def test_no_module_that_is_not_recorded_comes_from_the_folder_of_the_file(
    text: str, tmp_path: Path, trap: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = recorded(tmp_path / "own", text)
    printed = capsys.readouterr().out
    assert "No module named 'extra'" in printed
    assert f"{tmp_path / 'own' / 'helper.py'}" in printed
    for name in ("extra.py", "package/late.py", "lib/extra.py", "helper_too.py", "beside_it/__init__.py", "helper.py"):
        (tmp_path / "own" / name).parent.mkdir(exist_ok=True)
        (tmp_path / "own" / name).write_text(TRAP, encoding="utf-8")
    monkeypatch.chdir(tmp_path / "own")
    sys.path[:0] = ["", str(tmp_path / "own")]
    before = list(sys.path), list(sys.meta_path), set(sys.modules)
    assert main(["replay", str(path)]) == 0, capsys.readouterr().out
    assert not trap.exists()
    assert (sys.path, sys.meta_path) == before[:2]
    assert not {name for name in set(sys.modules) ^ before[2] if "extra" in name or "helper" in name or "package" in name}


def test_a_file_fact_that_points_into_a_folder_does_not_open_it(tmp_path: Path, trap: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = recorded(tmp_path / "own", "try:\n    import secret\nexcept ImportError:\n    print('none')\n")
    (tmp_path / "victim").mkdir()
    (tmp_path / "victim" / "secret.py").write_text(TRAP, encoding="utf-8")
    old, new = str(tmp_path / "own"), str(tmp_path / "victim")
    forge(path, f"UPDATE facts SET value = replace(value, '{old}', '{new}')", key=b"somebody")
    capsys.readouterr()
    assert main(["replay", str(path), "--trust"]) == 0
    assert capsys.readouterr().out.startswith("every byte agrees: 1 events")
    assert not trap.exists()


def test_modules_with_names_that_lead_elsewhere_write_nothing_there(tmp_path: Path) -> None:
    path = recorded(tmp_path / "own", "import helper\nprint(1)\n")
    for name in ("../../evil.py", str(tmp_path / "evil.py"), "x" * 5000, ".", ""):
        forge(path, f"""UPDATE facts SET value = '{{"helper": ["{name}", "print(2)"]}}' WHERE name = 'helpers'""")
        with Recorded(path) as read:
            assert str(replay(read)).startswith("differs: ")
    assert not list(tmp_path.rglob("evil*"))


@pytest.mark.parametrize("text", [TRAP + "print(1)\n", TRAP + BUILT])
def test_a_recording_from_elsewhere_is_run_only_where_it_is_trusted(
    text: str, tmp_path: Path, trap: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = recorded(tmp_path / "own", text)
    trap.unlink()
    forge(path, key=b"another key")
    capsys.readouterr()
    assert main(["replay", str(path)]) == 2
    captured = capsys.readouterr().err
    assert captured.startswith(f"error: '{path}' was not made by this installation")
    assert "--trust" in captured
    with Recorded(path) as read:
        assert not read.made_here
        with pytest.raises(UntrustedError, match="replay\\(recorded, trust=True\\)"):
            replay(read)
        list(read.events())
    assert not trap.exists()
    assert main(["replay", str(path), "--trust"]) == 0
    assert trap.exists()


def test_a_simulation_that_the_caller_builds_needs_no_trust(tmp_path: Path) -> None:
    simulation = driving()
    with simulation.record(tmp_path / "run"):
        simulation.run(0.1)
    forge(tmp_path / "run", key=b"another key")
    with Recorded(tmp_path / "run") as read:
        assert replay(read, driving).difference is None


def test_a_replay_from_the_folder_itself_as_a_module_does_not_import_from_it(tmp_path: Path, trap: Path) -> None:
    path = recorded(tmp_path / "own", "try:\n    import extra\nexcept ImportError:\n    print('none')\n")
    (tmp_path / "own" / "extra.py").write_text(TRAP, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "actr3d", "replay", str(path)], cwd=tmp_path / "own", capture_output=True, text=True, check=False
    )
    assert done.stdout.startswith("every byte agrees"), done.stderr
    assert not trap.exists()


@pytest.mark.daily(1)
@pytest.mark.parametrize("name", ["a\\u0000b.py", "", "/", "x" * 5000])
def test_a_file_with_an_impossible_name_ends_in_no_traceback(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = recorded(tmp_path / "own", BUILT)
    old = str(tmp_path / "own" / "model.py")
    forge(path, f"UPDATE facts SET value = replace(value, '{old}', '{name}') WHERE name IN ('file', 'sources')")
    capsys.readouterr()
    assert main(["replay", str(path)]) in (0, 2)
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize("text", ["import random\nprint(1)\n", BUILT])
def test_a_recording_cannot_replace_a_module_that_python_uses(text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = recorded(tmp_path / "own", text)
    forge(path, 'INSERT OR REPLACE INTO facts VALUES (\'helpers\', \'{"random": ["random.py", "x = 1"]}\')')
    capsys.readouterr()
    assert main(["replay", str(path)]) == 2
    assert "modules that no program can have loaded: Python uses modules of these names (random)" in capsys.readouterr().err


def test_a_module_with_the_name_of_one_of_python_that_is_not_in_use_is_replayed(tmp_path: Path) -> None:
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "this.py").write_text("value = 3\n", encoding="utf-8")
    path = recorded(tmp_path / "own", "import this\nprint(this.value)\n")
    with Recorded(path) as read:
        assert read.facts["helpers"] == {"this": ["this.py", "value = 3\n"]}
    assert main(["replay", str(path)]) == 0
