"""Parameter sweeps: a model's first lines, with other values."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from actr3d.actr.kernel.log import LOG
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import run_file
from actr3d.actr.loading.sweep import label, parameters, run, settings, with_values
from actr3d.errors import ModelFileError, ParameterError
from actr3d.trace import Trace

MODEL = '''"""A model."""
a = 1
b = [1,
     2]; c = 'x'  # c
import ccm
log = ccm.log()

class M(ccm.Model):
    def start(self):
        yield float(a)
        log.a = a
        log.c = c
        log.chance = self.random.random()

M().run()
'''


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "model.py").write_text(MODEL, encoding="utf-8")
    return tmp_path


def values(folder: Path) -> dict[str, list[str]]:
    """Returns the contents of each setting's data files."""
    found: dict[str, list[str]] = {}
    for file in sorted(folder.rglob("*.data")):
        found.setdefault(file.parent.name, []).append(file.read_text(encoding="utf-8"))
    return found


def test_the_first_assignments_are_parameters() -> None:
    assert list(parameters(MODEL)) == ["a", "b", "c"]


def test_a_sweep_tries_every_combination() -> None:
    assert list(settings({"a": [1, 2], "c": "xy", "b": (3, 4)})) == [{"a": a, "c": "xy", "b": (3, 4)} for a in (1, 2)]


@pytest.mark.parametrize(
    ("source", "chosen", "wanted"),
    [
        ("a = 1\nb = 2\n", {"b": "x"}, "a = 1\nb = 'x'\n"),
        ("a = 1; b = 2  # two\n", {"a": 10, "b": 20}, "a = 10; b = 20  # two\n"),
        ("\u00e9 = '\u00e9\u00e9'; b = 2\n", {"b": 3}, "\u00e9 = '\u00e9\u00e9'; b = 3\n"),
        ("a = [1,\n  2]; b = 2\nc = 3", {"a": 5, "b": 6}, "a = (5\n); b = 6\nc = 3"),
    ],
)
def test_values_are_replaced_on_their_own_lines(source: str, chosen: dict[str, Any], wanted: str) -> None:
    text = with_values(source, chosen)
    assert text == wanted
    space: dict[str, Any] = {}
    exec(text, space)
    assert {name: space[name] for name in chosen} == chosen


@pytest.mark.parametrize(
    ("value", "wanted"),
    [
        (math.inf, "float('inf')"),
        ([-math.inf, {"x": (math.nan,)}], "[float('-inf'), {'x': (float('nan'),)}]"),
        ([], "[]"),
        ((1, 2), "(1, 2)"),
        ((1,), "(1,)"),
        ({"b"}, "{'b'}"),
        (set[str](), "set()"),
        (range(3), "range(0, 3)"),
        (np.float64(0.5), "0.5"),
        ([np.int64(3), True, None, b"b"], "[3, True, None, b'b']"),
    ],
)
def test_every_value_is_text_that_runs(value: Any, wanted: str) -> None:
    text = with_values("a = 1", {"a": value})
    assert text == f"a = {wanted}"
    space: dict[str, Any] = {}
    exec(text, space)
    assert repr(space["a"]) == repr(eval(wanted))


@pytest.mark.parametrize("value", [object(), [1, print], {"x": 1j}])
def test_a_value_without_a_text_form_is_refused(value: Any) -> None:
    with pytest.raises(ParameterError, match=r"parameter 'a': .* cannot be written in the model's text; use numbers, texts, lists"):
        with_values("a = 1", {"a": value})


def test_labels_name_what_differs() -> None:
    assert label(MODEL, {"a": 1, "c": "x"}) == "default"
    assert label(MODEL, {"a": 2, "c": "y"}) == "a(2) c(y)"


def test_a_sweep_writes_data_for_each_run(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run("model", 3, a=[1, 2], c="x")
    lines = [line for line in capsys.readouterr().out.splitlines() if line != "end..."]
    assert lines == [f"model.py {i}/3 {name}" for i in range(3) for name in ("default", "a(2)")]
    found = values(folder)
    assert {name: len(texts) for name, texts in found.items()} == {"default": 3, "a(2)": 3}
    assert all(text.startswith("a=2\nc=x\nchance=") for text in found["a(2)"])
    assert len(set(found["default"])) == 3
    assert (folder / "model" / "code.py").read_text(encoding="utf-8") == MODEL


def test_a_sweep_from_inside_a_model_beside_it(folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    program = "import ccm\nlog = ccm.log()\nlog.before = 1\nccm.run('model', 3, a=[1, 2])\nlog.after = 2\n"
    (folder / "program.py").write_text(program, encoding="utf-8")
    elsewhere = folder / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    texts: list[Any] = []
    for _ in range(2):
        run_file(folder / "program.py", limits=RunLimits(seed=3))
        texts.append({name: sorted(found) for name, found in values(folder).items()})
        for file in folder.rglob("*.data"):
            file.unlink()
    assert texts[0] == texts[1]
    assert {name: len(found) for name, found in texts[0].items()} == {"default": 3, "a(2)": 3}
    out = capsys.readouterr().out
    assert "   0.000 before 1\n" in out
    assert " after 2\n" in out
    assert not LOG.locked


def test_an_older_copy_of_the_model_is_kept(folder: Path) -> None:
    run("model.py")
    (folder / "model.py").write_text(MODEL.replace("a = 1", "a = 5"), encoding="utf-8")
    run("model.py")
    assert (folder / "model" / "code-1.py").read_text(encoding="utf-8") == MODEL
    assert "a = 5" in (folder / "model" / "code.py").read_text(encoding="utf-8")


def test_mistakes_are_named(folder: Path) -> None:
    with pytest.raises(ParameterError, match=r"the model has no parameter 'aa'; did you mean 'a'\? Its first lines set: a, b, c"):
        run("model", aa=1)
    with pytest.raises(ModelFileError, match=r"no model file 'modl\.py'; did you mean 'model\.py'"):
        run("modl")
    (folder / "old.py").write_text("a = 1\nprint a\n", encoding="utf-8")
    with pytest.raises(ModelFileError, match=r"old\.py:2: this file is written for Python 2"):
        run("old")
    (folder / "bad.py").write_text("a = 1\n1 / 0\n", encoding="utf-8")
    with pytest.raises(ZeroDivisionError):
        run("bad")
    assert not LOG.locked
    assert LOG.directory is None


def test_the_runs_of_a_sweep_are_runs_of_the_program_around_it(folder: Path) -> None:
    (folder / "clock.py").write_text("length = 0.5\nfrom actr3d.actr import Model\nModel().run(length)\n", encoding="utf-8")
    (folder / "program.py").write_text("import ccm\nccm.run('clock', length=[0.5, 0.75])\n", encoding="utf-8")
    passed: list[tuple[int, int]] = []
    limits = RunLimits(seed=1, passing=lambda sch, end: passed.append((sch.now_us, end)), trace=Trace())
    run_file(folder / "program.py", limits=limits)
    assert passed == [(0, 500_000), (0, 750_000)]
    assert limits.clock() == 750_000
    assert limits.trace is not None
    assert [event.run for event in limits.trace if event.kind == "start"] == [1, 2]


def test_a_sweep_ends_where_the_program_around_it_ends(folder: Path) -> None:
    (folder / "clock.py").write_text("length = 1\nfrom actr3d.actr import Model\nModel().run(length)\n", encoding="utf-8")
    (folder / "program.py").write_text("import ccm\nccm.run('clock', length=[1, 5, 2])\n", encoding="utf-8")
    limits = RunLimits(until=3, trace=Trace())
    run_file(folder / "program.py", limits=limits)
    assert limits.ended
    assert limits.trace is not None
    ends = [(event.time, event.data["by"]) for event in limits.trace if event.kind == "stop"]
    assert ends == [(1, "limit"), (3, "until"), (0, "until")]
