"""Unchanged model files print the same, at the same times, as under python_actr itself.

Each file in `tests/models` runs in a process of its own under both; what they print is compared byte for byte. A line
`# seeds: 1 2 3` in a file names the seeds it is run with (1 unless it has one).
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pytest

HERE = Path(__file__).parent
FILES = sorted((HERE / "models").glob("*.py"))


def seeds(file: Path) -> list[int]:
    found = re.search(r"^# seeds: ([\d ]+)$", file.read_text(encoding="utf-8"), re.MULTILINE)
    return [int(word) for word in found[1].split()] if found else [1]


CASES = [pytest.param(file, seed, id=f"{file.stem}-{seed}") for file in FILES for seed in seeds(file)]


def files_written(folder: Path) -> list[tuple[str, str]]:
    """Returns what a program wrote into its folder, by the kind of file; of a table only that there is one.

    Times are compared to the millisecond: here they are exact, in python_actr sums of floats.
    """
    files = [path for path in folder.rglob("*") if path.is_file() and path.suffix not in (".py", ".pyc")]
    texts = [(path.suffix, path.read_text(encoding="utf-8") if path.suffix == ".data" else "") for path in files]
    return sorted((kind, re.sub(r"^time=(.*)$", lambda m: f"time={float(m[1]):.3f}", text, flags=re.MULTILINE)) for kind, text in texts)


def printed(*arguments: str, folder: Path) -> str:
    """Runs Python with these arguments and returns what it printed; fails with its errors where it fails."""
    environment = {**os.environ, "PYTHONHASHSEED": "0", "PYTHONPATH": str(HERE.parent), "PYTHONIOENCODING": "utf-8"}
    command = [sys.executable, "-W", "ignore", *arguments]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", env=environment, cwd=folder, timeout=60, check=False)
    assert done.returncode == 0, f"{' '.join(arguments)} ended with {done.returncode}:\n{done.stdout[-500:]}\n{done.stderr[-2000:]}"
    return done.stdout


def test_the_peer_is_python_actr_1_9_5() -> None:
    try:
        found = version("python_actr")
    except PackageNotFoundError:
        pytest.fail("python_actr is not installed: it is in the dependency group 'bench'")
    assert found == "1.9.5"


@pytest.mark.parametrize(("file", "seed"), CASES)
def test_prints_what_python_actr_prints(file: Path, seed: int, tmp_path: Path) -> None:
    programs: list[str] = []
    for folder in (tmp_path / "ours", tmp_path / "peers"):  # a model's log goes into a folder beside its file
        folder.mkdir()
        programs.append(str(shutil.copy(file, folder)))
    ours = printed("-m", "actr3d.cli", "run", programs[0], "--seed", str(seed), folder=tmp_path)
    peers = printed(str(HERE / "peer.py"), programs[1], str(seed), folder=tmp_path)
    assert ours.splitlines() == peers.splitlines()
    assert ours == peers
    assert files_written(tmp_path / "ours") == files_written(tmp_path / "peers")
    assert len(ours.splitlines()) > 3, f"{file.name} prints next to nothing: it shows nothing"
