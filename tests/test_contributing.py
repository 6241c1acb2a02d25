"""The files of CONTRIBUTING.md: each is written to a copy of the project, and is known there without any other change."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.helpers.manual import FENCE, ROOT

CHECKS = {
    "actr3d/world/sensors/top.py": """
        from actr3d.world import Car, Floor, Scene, World
        assert World(Scene(parts=(Floor(), Car()))).bodies["car"].get("top") > 1.4
    """,
    "actr3d/world/actuators/stride.py": """
        from actr3d.world import Car, Floor, Mannequin, Scene, World
        bodies = World(Scene(parts=(Floor(), Car(position=(9, 9)), Mannequin(name="walker")))).bodies
        assert "stride" not in bodies["car"].actuators
        bodies["walker"].set("stride", 1.0)
    """,
    "actr3d/world/bodies/ball.py": """
        from actr3d.world import Ball, Floor, Scene, World
        assert World(Scene(parts=(Floor(), Ball(radius=0.2)))).bodies["ball"].get("top") == 0.4
    """,
    "actr3d/world/changes/open_wide.py": """
        from actr3d.simulation import Simulation
        from actr3d.world import Aperture, Floor, Scene
        simulation = Simulation(Scene(parts=(Floor(), Aperture())), seed=1)
        simulation.command("open_wide")
        assert abs(simulation.world.aperture_width() - 3.0) < 1e-9
    """,
    "actr3d/actr/modules/alarm.py": """
        from actr3d.actr import *
        from actr3d.trace_kinds import KINDS
        class Sleeper(ACTR):
            goal = Buffer()
            alarm = Alarm(0.3)
            def init():
                goal.set("sleep")
            def wake(goal="sleep", alarm="ringing:True"):
                goal.clear()
        sleeper = Sleeper()
        trace = sleeper.traced()
        sleeper.run()
        (ring,) = trace.select("ring")
        assert (ring.time, ring.source, ring.data) == (0.3, "alarm", {"after": 0.3})
        assert KINDS["ring"].group == "other"
    """,
    "actr3d/experiment/distance.py": """
        from actr3d.experiment import find_measures
        from actr3d.simulation import Simulation
        from actr3d.world import Floor, Mannequin, Scene
        simulation = Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), seed=1)
        simulation.measure(find_measures()["Distance"]("walker"))
        simulation.command("walk", 1.0, body="walker")
        simulation.run(1)
        assert simulation.result().distance_m > 0.8
    """,
    "actr3d/experiment/designs/careless.py": """
        import shutil
        from actr3d.experiment.specification import library_designs, specify
        shutil.copytree(MODELS, "models", dirs_exist_ok=True)
        assert "careless" in library_designs()
        assert len(specify("careless").design) == 100
    """,
    "actr3d/experiment/analysis.py": """
        from types import SimpleNamespace
        from actr3d.experiment.report.analyses import find_analyses
        (slowest,) = find_analyses(["rt", "n"])
        (section,) = slowest(SimpleNamespace(rows={"rt": SimpleNamespace(max=lambda: 1.5)}), [])
        assert (section.title, section.parts) == ("The slowest trial", ["It took 1.50 s."])
    """,
    "workbench/page_commands/firings.py": """
        from types import SimpleNamespace
        from actr3d.trace import TraceEvent
        from workbench.protocol import COMMAND
        question = COMMAND.validate_python({"type": "firings"})
        events = [TraceEvent(0, "agent", "fire", {"production": name}) for name in ("go", "go", "stop")]
        assert question.answer(SimpleNamespace(trace=events)) == {"go": 2, "stop": 1}
        assert not question.takes_control
    """,
    "workbench/overlays/heads.py": """
        from types import SimpleNamespace
        from actr3d.camera import CameraParameters
        from actr3d.simulation import Simulation
        from actr3d.world import Car, Floor, Scene
        from workbench.overlays import OVERLAYS, Observed
        from workbench.protocol import COMMAND
        COMMAND.validate_python({"type": "overlay", "name": "heads", "shown": True})
        observed = Observed(Simulation(Scene(parts=(Floor(), Car()))), lambda body: CameraParameters(), dict)
        data = OVERLAYS["heads"].data(observed)
        assert data["car"][3] > 1.4
        lines = []
        server = SimpleNamespace(scene=SimpleNamespace(add_line_segments=lambda name, points, **_: lines.append((name, points.shape))))
        OVERLAYS["heads"](SimpleNamespace(server=server)).draw(None, data)
        assert lines == [("/overlays/heads", (1, 2, 3))]
    """,
    "actr3d/bench/copying.py": """
        from actr3d.cli import main
        assert main(["bench", "copying"]) == 0
    """,
    "static/panels/clock.js": """
        from workbench.page_files import panels
        assert 'from "./panels/clock.js"' in panels()
    """,
}
"""By file: what is true with it, in a process of its own."""


def files() -> dict[str, str]:
    """Returns the files of the page by path."""
    blocks = FENCE.findall((ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    return {match[1]: text for _, _, rest, text in blocks if (match := re.search(r'title="(.+/.+)"', rest))}


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Returns a copy of the project, with what of it is compiled, and with the files of the page."""
    folder = tmp_path_factory.mktemp("contributing")
    being_written = shutil.ignore_patterns("*.pyc.*", "*.tmp.*")
    for package in ("actr3d", "workbench", "static"):
        shutil.copytree(ROOT / package, folder / package, ignore=being_written)
    for name, text in files().items():
        assert not (folder / name).exists()
        (folder / name).write_text(text, encoding="utf-8")
    return folder


@pytest.mark.slow
def test_the_tests_of_all_registries_pass_with_them(copy: Path) -> None:
    shutil.copytree(ROOT / "tests", copy / "tests", ignore=shutil.ignore_patterns("*.pyc*"))
    shutil.copytree(ROOT / "models", copy / "models")
    shutil.copy(ROOT / "pyproject.toml", copy)
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-n",
        "0",
        "-q",
        "tests/test_registries.py",
        "tests/world/test_world_state.py",
        "tests/test_cli.py",
    ]
    done = subprocess.run(command, cwd=copy, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


def test_every_file_of_the_page_is_checked() -> None:
    assert files().keys() == CHECKS.keys()


@pytest.mark.daily(3)
@pytest.mark.parametrize("file", CHECKS)
def test_a_new_thing_is_one_file(file: str, copy: Path) -> None:
    lines = CHECKS[file].strip("\n").splitlines()
    text = "\n".join(line[8:] for line in lines)
    head = f"MODELS = {str(ROOT / 'models')!r}\nimport actr3d\nassert actr3d.__path__[0] == {str(copy / 'actr3d')!r}\n"
    (copy / "check.py").write_text(f"{head}{text}\n", encoding="utf-8")
    done = subprocess.run([sys.executable, "check.py"], cwd=copy, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
