"""Records what python_actr 1.9.5 prints and writes when it runs the models of `tests/models` and of `models/tutorial`.

Usage: `python tests/golden/compat.py` records all programs, `python tests/golden/compat.py agents tutorial/counting` only those named.
What it records of `tests/models/agents.py` is `tests/golden/compat/agents.json`. A line `# seeds: 1 2 3` in a file names the seeds
that it is run with (1 by default).
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parent
FILES = sorted((FOLDER.parent / "models").glob("*.py"))
TUTORIAL = FOLDER.parent.parent / "models" / "tutorial"
ONLY_OURS = {"tutorial/sgoms"}
"""Models that use what python_actr does not have."""
VERSION = "1.9.5"
"""The version of python_actr whose output is recorded."""


@dataclass(frozen=True, kw_only=True)
class Program:
    """A program that python_actr runs."""

    name: str
    file: Path
    seeds: tuple[int, ...]

    @property
    def text(self) -> str:
        """The program's text; a tutorial model imports python_actr in place of `actr3d.actr`."""
        source = self.file.read_text(encoding="utf-8")
        return re.sub(r"^from actr3d\.actr import \*$", "from python_actr import *", source, flags=re.MULTILINE)

    @property
    def record(self) -> Path:
        """The path of what is recorded of it."""
        return FOLDER / "compat" / f"{self.name}.json"

    def recorded(self, seed: int) -> dict[str, Any]:
        """Returns what python_actr printed and wrote with a seed."""
        return json.loads(self.record.read_text(encoding="utf-8"))[str(seed)]


def _seeds(file: Path) -> tuple[int, ...]:
    found = re.search(r"^# seeds: ([\d ]+)$", file.read_text(encoding="utf-8"), re.MULTILINE)
    return tuple(map(int, found[1].split())) if found else (1,)


PROGRAMS = [Program(name=file.stem, file=file, seeds=_seeds(file)) for file in FILES]
TUTORIAL_PROGRAMS = [
    Program(name=f"tutorial/{file.stem}", file=file, seeds=(1, 7))
    for file in sorted(TUTORIAL.glob("*.py"))
    if f"tutorial/{file.stem}" not in ONLY_OURS
]


def files_written(folder: Path) -> list[list[str]]:
    """Returns the ending and the text of each file that a program wrote; of a table (a log with the time in its name) only the ending.

    Times are rounded to the millisecond: ours are exact, those of python_actr are sums of floats.
    """
    files = [path for path in folder.rglob("*") if path.is_file() and path.suffix not in (".py", ".pyc")]
    texts = [(path.suffix, path.read_text(encoding="utf-8") if path.suffix == ".data" else "") for path in files]
    return sorted([kind, re.sub(r"^time=(.*)$", lambda m: f"time={float(m[1]):.3f}", text, flags=re.MULTILINE)] for kind, text in texts)


def run_peer(text: str, seed: int, name: str = "program.py") -> dict[str, Any]:
    """Runs a program under python_actr; returns what it printed and the files it wrote.

    Args:
        text: The program.
        seed: What its random numbers come from.
        name: What its file is called.

    Raises:
        RuntimeError: If another version of python_actr is installed, or the program fails.
    """
    if version("python_actr") != VERSION:
        raise RuntimeError(f"python_actr {VERSION} is needed (installed: {version('python_actr')})")
    environment = {**os.environ, "PYTHONHASHSEED": "0", "PYTHONIOENCODING": "utf-8"}
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place, "program")  # a model's log goes into a folder beside its file
        folder.mkdir()
        file = folder / name
        file.write_text(text, encoding="utf-8")
        command = [sys.executable, "-W", "ignore", str(FOLDER / "peer.py"), str(file), str(seed)]
        done = subprocess.run(command, capture_output=True, encoding="utf-8", env=environment, cwd=place, timeout=60, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{name} ended with {done.returncode} under python_actr:\n{done.stdout[-500:]}\n{done.stderr[-2000:]}")
        return {"printed": done.stdout, "files": files_written(folder)}


def main() -> None:
    """Records the programs named on the command line, or all; removes records of programs that are gone."""
    programs = [*PROGRAMS, *TUTORIAL_PROGRAMS]
    for program in programs:
        if not sys.argv[1:] or program.name in sys.argv[1:]:
            program.record.parent.mkdir(parents=True, exist_ok=True)
            runs = {str(seed): run_peer(program.text, seed, program.file.name) for seed in program.seeds}
            program.record.write_text(json.dumps(runs, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    for record in set((FOLDER / "compat").rglob("*.json")) - {program.record for program in programs}:
        record.unlink()


if __name__ == "__main__":
    main()
