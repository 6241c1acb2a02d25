"""Unchanged model files print the same, at the same times, as under python_actr 1.9.5.

What python_actr prints is recorded (`tests/golden/compat.py`); a slow test checks that it still prints that.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from golden.compat import PROGRAMS, TUTORIAL_PROGRAMS, Program, files_written, run_peer

from tests.helpers.commands import run_command


def cases(*programs: Program) -> list[object]:
    return [pytest.param(program, seed, id=f"{program.name}-{seed}") for program in programs for seed in program.seeds]


@pytest.mark.daily(18)
@pytest.mark.parametrize(("program", "seed"), cases(*PROGRAMS))
def test_prints_what_python_actr_prints(program: Program, seed: int, tmp_path: Path) -> None:
    folder = tmp_path / "library"  # a model's log goes into a folder beside its file
    folder.mkdir()
    file = folder / program.file.name
    file.write_text(program.text, encoding="utf-8")
    done = run_command("run", str(file), "--seed", str(seed), folder=tmp_path)
    assert done.returncode == 0, done.stderr
    peers = program.recorded(seed)
    assert done.stdout.splitlines() == peers["printed"].splitlines()
    assert done.stdout == peers["printed"]
    assert files_written(folder) == peers["files"]
    assert len(done.stdout.splitlines()) > 3, f"{program.name} prints too little to compare"


@pytest.mark.daily(13)
@pytest.mark.parametrize(("program", "seed"), cases(*TUTORIAL_PROGRAMS))
def test_tutorial_models_print_what_they_print_under_python_actr(program: Program, seed: int, tmp_path: Path) -> None:
    assert program.text != program.file.read_text(encoding="utf-8")
    done = run_command("run", str(program.file), "--seed", str(seed), folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout
    # python_actr prints a last line when a program that imports it ends.
    assert done.stdout + "end...\n" == program.recorded(seed)["printed"]


@pytest.mark.slow
@pytest.mark.parametrize("program", [*PROGRAMS, *TUTORIAL_PROGRAMS], ids=lambda program: program.name)
def test_python_actr_prints_what_is_recorded(program: Program) -> None:
    seed = program.seeds[-1]
    assert run_peer(program.text, seed, program.file.name) == program.recorded(seed)
