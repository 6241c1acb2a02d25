"""Every model repeats its golden trace, each time it is run.

After an intended change of behaviour, `uv run python tests/golden/make.py` records the golden traces again.
"""

from __future__ import annotations

from itertools import zip_longest

import pytest
from golden.make import GOLDEN, MODELS, ROOT, command, golden_file, golden_names, is_embodied, model_file, model_names, options

from actr3d.actr.loading.sweep import parameters
from actr3d.cli import main
from tests.helpers.commands import run_command

NAMES = model_names()
TUTORIAL = [name for name in NAMES if name.startswith("tutorial/")]
NOISY = {
    "predictive_walker",
    "aperture_passage",
    "aperture_passage@predictive",
    "aperture_passage@replication",
    "fan_effect",
    "paired_associates",
    "tutorial/partial_matching",
    "tutorial/sos_vision",
    "tutorial/utility_learning",
    "utility_learning",
}
"""The models that draw random numbers which make a difference."""
QUICK_FIRST = sorted(NAMES, key=lambda name: (is_embodied(name), name not in NOISY))
"""Models with a body, which take seconds, come last: the daily cases are others."""
LARGEST = 300_000
"""No golden trace is larger [bytes]."""


def record(name: str, *words: str) -> bytes:
    """Runs a model in a separate process, and returns its output."""
    done = run_command(*command(name, *words), folder=ROOT)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout.encode()


def compare(name: str, found: bytes) -> None:
    """Fails at the first event that differs from the golden trace."""
    lines, golden = found.split(b"\n"), golden_file(name).read_bytes().split(b"\n")
    for number, (line, expected) in enumerate(zip_longest(lines, golden), start=1):
        if line != expected:
            before = (golden[number - 2] if number > 1 else b"(the beginning)").decode()
            shown = [repr(None) if event is None else event.decode() or "(the end)" for event in (expected, line)]
            pytest.fail(
                f"models/{name}.py differs from {golden_file(name).relative_to(ROOT)} at event {number}\n"
                f"  after     {before}\n  expected  {shown[0]}\n  found     {shown[1]}\n"
                f"If that is right: python {(GOLDEN / 'make.py').relative_to(ROOT)} {name}",
                pytrace=False,
            )


def without_start(trace: bytes) -> list[bytes]:
    """Returns a trace's events but the first, which names the seed."""
    first, *rest = trace.split(b"\n")
    assert b'"kind": "start"' in first
    return rest


def test_every_model_has_a_golden_trace_and_every_trace_a_model() -> None:
    assert golden_names() == NAMES
    assert [name for name in NAMES if golden_file(name).stat().st_size > LARGEST] == []


@pytest.mark.daily(12)
@pytest.mark.parametrize("name", NAMES)
def test_does_what_its_golden_trace_says(name: str) -> None:
    compare(name, record(name))


@pytest.mark.daily(2)
@pytest.mark.parametrize("name", QUICK_FIRST)
def test_does_the_same_twice_in_one_process(name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("PYTHONHASHSEED", "0")
    for _ in range(2):
        assert main(command(name)) == 0
        compare(name, capsys.readouterr().out.encode())


@pytest.mark.daily(3)
@pytest.mark.parametrize("name", QUICK_FIRST)
def test_another_seed_changes_noisy_models_only(name: str) -> None:
    same = without_start(record(name, *options(name, seed=2))) == without_start(golden_file(name).read_bytes())
    assert same == (name not in NOISY), f"{name}: it must be in NOISY, if another seed changes what it does, and only then"


@pytest.mark.daily(20)
@pytest.mark.parametrize("until", ["0.01", "0.12", "3"])
@pytest.mark.parametrize("name", NAMES)
def test_can_be_ended_early(name: str, until: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(ROOT / model_file(name)), "--seed", "1", "--until", until, "--trace", "production"]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    moments = [float(line.split()[0]) for line in printed.out.splitlines() if " select " in line]
    assert moments == sorted(moments)
    assert all(moment <= float(until) for moment in moments)


@pytest.mark.parametrize("name", TUTORIAL)
def test_sets_its_parameters_in_its_first_lines(name: str) -> None:
    assert parameters((MODELS / f"{name}.py").read_text(encoding="utf-8"))
