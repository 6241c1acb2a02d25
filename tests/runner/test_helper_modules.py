"""Helper modules in recordings: a replay runs the recorded texts, even if the files have changed."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.cli import main
from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from actr3d.runner.run import run_model

RULES = """
from actr3d.actr import *
from .numbers_of import LAST
class Rules(ACTR):
    goal = Buffer()
    def init():
        goal.set("count 0")
    def count(goal=f"count ?n!{LAST}"):
        from later.word import WORD
        print(WORD, n)
        goal.set(f"count {int(n) + 1}")
"""
PROGRAM = """
import sys
from pathlib import Path
sys.path.append(str(Path(__file__).resolve().parent.parent / "shared"))
from tallying.rules import Rules
import beyond
Rules().run(beyond.END)
"""
BUILT = """
from tallying import rules
from actr3d.simulation import Simulation
from actr3d.world import Scene
def build() -> Simulation:
    return Simulation(Scene(), bodiless={"counter": rules.Rules})
"""
FILES = {
    "own/tallying/__init__.py": "",
    "own/tallying/numbers_of.py": "LAST = 3\n",
    "own/tallying/rules.py": RULES,
    "own/later/word.py": "WORD = 'then'\n",
    "shared/beyond.py": "END = 1\n",
    "own/program.py": PROGRAM,
    "own/built.py": BUILT,
}


@pytest.fixture(name="folder")
def folder_(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize("name", ["program", "built"])
def test_a_run_is_replayed_while_its_own_helper_modules_are_still_loaded(name: str, folder: Path) -> None:
    run_model(folder / f"own/{name}.py", RunLimits(seed=1), record=folder / "run")
    for _ in range(2):
        with Recorded(folder / "run") as recorded:
            assert str(replay(recorded)).startswith("every byte agrees: ")


@pytest.mark.daily(1)
@pytest.mark.parametrize("name", ["program", "built"])
def test_helper_modules_are_recorded_and_replayed_as_they_were(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, known = folder / "run", set(sys.modules)
    assert main(["run", str(folder / f"own/{name}.py"), "--seed", "1", "--record", str(path)]) == 0
    assert capsys.readouterr().out == "then 0\nthen 1\nthen 2\n"
    with Recorded(path) as recorded:
        texts = dict(recorded.facts["helpers"].values())
    beside = {file.removeprefix("own/"): text for file, text in FILES.items() if file.count("/") == 2}
    beyond = {str(folder / "shared/beyond.py"): "END = 1\n"} if name == "program" else {}
    assert texts == {**beside, **beyond}
    (folder / "own/later/word.py").write_text("WORD = 'now'\n", encoding="utf-8")
    (folder / "own/tallying/numbers_of.py").write_text("LAST = 7\n", encoding="utf-8")
    assert main(["replay", str(path)]) == 0
    assert capsys.readouterr().out.startswith("every byte agrees: ")
    shutil.rmtree(folder / "own")
    shutil.rmtree(folder / "shared")
    assert main(["replay", str(path)]) == 0
    assert capsys.readouterr().out.startswith("every byte agrees: ")
    assert not {name.partition(".")[0] for name in set(sys.modules) - known} & {"tallying", "later", "beyond"}


def test_a_program_loads_what_a_file_holds_when_it_is_imported(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    again = "import sys\nfrom later import word\nprint(word.WORD)\nfrom pathlib import Path\nPath(word.__file__).write_text('WORD = 2')\n"
    again += "del sys.modules['later.word']\nfrom later.word import WORD\nprint(WORD)\n"
    (folder / "own/program.py").write_text(again, encoding="utf-8")
    assert main(["run", str(folder / "own/program.py"), "--record", str(folder / "run")]) == 0
    assert capsys.readouterr().out == "then\n2\n"
