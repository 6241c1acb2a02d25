"""Loading model files: in any encoding, and with all global state restored afterwards."""

import random
import sys
import traceback
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import compile_source, load_text, read_source, run_file, run_text
from actr3d.errors import ModelFileError

MODEL = """# a comment
from python_actr import *

class A(ACTR):
    goal = Buffer()
    def init():
        goal.set('go')
    def boom(goal='go'):
        1 / 0

"""


@pytest.mark.parametrize(
    ("data", "text"),
    [
        (b"x = '\xc3\xa9'\n", "x = '\u00e9'\n"),
        (b"\xef\xbb\xbfx = 1\r\ny = 2\r\n", "x = 1\ny = 2\n"),
        (b"# -*- coding: latin-1 -*-\rx = '\xe9'\r", "# -*- coding: latin-1 -*-\nx = '\u00e9'\n"),
        (b"#!/usr/bin/python\n# coding=cp1252\nx = '\x80'\n", "#!/usr/bin/python\n# coding=cp1252\nx = '\u20ac'\n"),
        (b"", ""),
    ],
)
def test_encodings_and_ends_of_lines(tmp_path: Path, data: bytes, text: str) -> None:
    path = tmp_path / "model.py"
    path.write_bytes(data)
    assert read_source(path) == text
    run_file(path)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"y = 1\nx = '\xe9'\n", "'.*model.py' is not Python source: line 2 is not UTF-8"),
        (b"# coding: klingon\n", "is not Python source: unknown encoding"),
        (b"\x89PNG\r\n\x1a\n\x00\x00", "is not Python source"),
        (b"x = 1\n\x00\n", "model.py:2: there is a NUL character; this is not Python source"),
    ],
)
def test_a_file_that_is_no_text_is_refused(tmp_path: Path, data: bytes, message: str) -> None:
    path = tmp_path / "model.py"
    path.write_bytes(data)
    with pytest.raises(ModelFileError, match=message):
        run_file(path)


def test_missing_files_and_folders(tmp_path: Path) -> None:
    (tmp_path / "counting.py").touch()
    with pytest.raises(ModelFileError, match=r"no model file '.*contin.py'; did you mean 'counting.py'\?"):
        run_file(tmp_path / "contin.py")
    with pytest.raises(ModelFileError, match=r"no model file '.*a.py'$"):
        run_file(tmp_path / "nowhere" / "a.py")
    with pytest.raises(ModelFileError, match="is a folder; name a model file in it"):
        run_file(tmp_path)


@pytest.mark.parametrize("from_text", [False, True])
def test_tracebacks_show_the_modellers_file_and_line(tmp_path: Path, from_text: bool) -> None:
    path = tmp_path / "crash.py"
    path.write_bytes((MODEL + "A().run()\n").replace("\n", "\r\n").encode("utf-8-sig"))
    with pytest.raises(ZeroDivisionError) as caught:
        run_text(MODEL + "A().run()\n", str(path)) if from_text else run_file(path)
    own = [frame for frame in traceback.extract_tb(caught.value.__traceback__) if frame.filename == str(path)]
    assert [(frame.lineno, frame.name, frame.line) for frame in own] == [(11, "<module>", "A().run()"), (9, "boom", "1 / 0")]
    assert caught.value.__notes__ == [f"in production 'boom' ({path}:8) at 0.05 s"]


def test_a_form_feed_does_not_shift_lines() -> None:
    with pytest.raises(ZeroDivisionError) as caught:
        run_text("x = 1\n\x0c\ny = 2 / 0\n", "feed.py")
    assert traceback.extract_tb(caught.value.__traceback__)[-1].line == "y = 2 / 0"


PYTHON_2 = [
    ('print "a"', 1),
    ("x = 1\nprint x, 3", 2),
    ('if 1: print "a"', 1),
    ("print a; print b", 1),
    ("class A:\n    def f(self):\n        print self.x\n", 3),
    ("import ccm\n\n'''a text\nprint 3'''\ndef f():\n    print 'a # b' % 3\n", 6),
    ("try:\n    pass\nexcept E, e:\n    pass", 3),
    ("try:\n    pass\nexcept (A, B), e:\n    pass", 3),
    ('raise ValueError, "x"', 1),
    ('exec "a" in space', 1),
    ("if 1: exec 'a=1'", 1),
    ("x = 2; exec code", 1),
    ("if a <> b:\n    pass", 1),
    ("x = `y`", 1),
    ("x = 0777", 1),
    ("x = 10L", 1),
    ("x = 0xFFL", 1),
    ('x = ur"a"', 1),
    ("def f((a, b)):\n    pass", 1),
    ("f = lambda (a, b): a", 1),
    ("import sys\nprint >>sys.stderr, 'a', 3", 2),
    ("import sys\ndef f():\n    x = 1\n    print >> sys.stderr\n", 4),
    ("for i in x:\n\tif i:\n        y = i\n", 3),
]


@pytest.mark.parametrize(("source", "line"), PYTHON_2)
def test_a_python_2_file_is_one_clear_error(source: str, line: int) -> None:
    with pytest.raises(ModelFileError, match=rf"^old.py:{line}: this file is written for Python 2 \(.+\); convert it to Python 3$"):
        compile_source(source, "old.py")


BROKEN_PYTHON_3 = [
    ("x = (1,\n", 1),
    ('print("a"', 1),
    ("def f(:\n    pass", 1),
    ('s = "<>" +', 1),
    ("# `a` 10L\nx = = 2", 2),
    ('s = "0777 10L `x`" )', 1),
    ('x = 5  # "print x" is Python 2\ny = 3 +', 2),
    ("'''\nprint x\n''' 3", 3),
    ("print = 3 4", 1),
    ("printer x", 1),
    ("if x = 3:\n    pass", 1),
    ("x = 1\n  y = 2", 2),
    ("raise ValueError('a, b') from", 1),
]


@pytest.mark.parametrize(("source", "line"), BROKEN_PYTHON_3)
def test_a_broken_python_3_file_is_not_taken_for_python_2(source: str, line: int) -> None:
    with pytest.raises(ModelFileError, match=rf"^new.py:{line}: (?!this file is written for Python 2)"):
        compile_source(source, "new.py")


@pytest.mark.parametrize(
    "source",
    [
        "import sys\nif sys.version_info[0] == 2:\n    print >>sys.stderr, 'a'",
        "print = 8\nprint >> 2",
        "x = print and 3 >> 1",
        "'print >>f, 1'",
    ],
)
def test_valid_python_3_is_not_taken_for_python_2(source: str) -> None:
    run_text(source)


@pytest.mark.parametrize(
    ("source", "line"),
    [
        ("x = 1\n" + "(" * 100_000 + ")" * 100_000, 2),
        ("x = 1\n\nx = " + "-" * 100_000 + "1", 3),
        ("x" + ".a" * 100_000, 1),
        ("def f(" + "(" * 100_000, 1),
    ],
)
def test_code_that_is_nested_too_deeply_is_one_short_error(source: str, line: int) -> None:
    with pytest.raises(ModelFileError, match=rf"^deep.py:{line}: .*(nested|parenthes|closed)") as caught:
        compile_source(source, "deep.py")
    assert len(str(caught.value)) < 400


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "helper.py").write_text(
        "import ccm\nfrom ccm.lib.actr import *\nVALUE = 5\nclass Part(ccm.Model): pass\n", encoding="utf-8"
    )
    (tmp_path / "bare").mkdir()
    (tmp_path / "bare" / "deep.py").write_text("from python_actr import Buffer\n", encoding="utf-8")
    return tmp_path


PROGRAM = """
import sys
import ccm
import helper
from bare import deep

class Late(ccm.Model):
    def start(self):
        yield 1
        from ccm.lib import grid
        import python_actr.actr
        assert issubclass(helper.Part, ccm.Model) and grid.World and python_actr.actr.ACTR is helper.ACTR

value = 0
if __name__ == '__main__':
    Late().run()
    value = helper.VALUE
    arguments = list(sys.argv)
    sys.path.append('somewhere')
    sys.argv.append('something')
"""


def test_a_model_is_the_program_and_leaves_nothing_behind(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run_text("from ccm.lib import grid", folder=folder)  # parts of the library stay loaded after their first import
    capsys.readouterr()
    (folder / "program.py").write_text(PROGRAM, encoding="utf-8")
    real = ModuleType("python_actr")
    part = ModuleType("python_actr.actr")
    sys.modules["python_actr"], sys.modules["python_actr.actr"] = real, part
    before = (dict(sys.modules), list(sys.path), list(sys.argv), list(sys.meta_path), random.getstate())
    try:
        module: Any = run_file(folder / "program.py", limits=RunLimits(seed=1))
        assert (module.value, module.arguments) == (5, [str(folder / "program.py")])
        assert (dict(sys.modules), list(sys.path), list(sys.argv), list(sys.meta_path), random.getstate()) == before
        assert sys.modules["python_actr"] is real
    finally:
        del sys.modules["python_actr"], sys.modules["python_actr.actr"]
    assert capsys.readouterr().out == "end...\n"


def test_everything_is_put_back_after_an_error(folder: Path) -> None:
    before = (dict(sys.modules), list(sys.path), list(sys.argv), list(sys.meta_path))
    with pytest.raises(ZeroDivisionError):
        run_text("import ccm, helper\n1 / 0", folder=folder)
    assert (dict(sys.modules), list(sys.path), list(sys.argv), list(sys.meta_path)) == before


def test_a_helper_of_python_2_is_the_same_clear_error(folder: Path) -> None:
    (folder / "old.py").write_text("import ccm\n\nprint 'a'\n", encoding="utf-8")
    message = rf"^{folder}/old.py:3: this file is written for Python 2 \(a print statement\); convert it to Python 3$"
    for load in (run_text, load_text):
        with pytest.raises(ModelFileError, match=message):
            load("import ccm\nfrom old import *", folder=folder)
        assert "old" not in sys.modules


def test_a_helper_that_lies_elsewhere_on_the_programs_path_counts_too(folder: Path, tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "far.py").write_text("x = 1\nprint x", encoding="utf-8")
    with pytest.raises(ModelFileError, match=r"far.py:2: this file is written for Python 2"):
        run_text(f"import sys\nsys.path.append({str(elsewhere)!r})\nimport far", folder=folder / "bare")


def test_a_program_is_over_when_its_threads_are() -> None:
    source = "import threading\nseen = []\ndef late():\n    threading.Event().wait(0.05)\n    seen.append(1)\n"
    source += "threading.Thread(target=late).start()\n"
    module: Any = run_text(source)
    assert module.seen == [1]


def test_a_changed_helper_is_read_again(folder: Path) -> None:
    source = "import helper, late\nvalue = (helper.VALUE, late.VALUE)"
    for value in (10, 200):
        for name in ("helper", "late"):
            (folder / f"{name}.py").write_text(f"VALUE = {value}", encoding="utf-8")
        module: Any = run_text(source, folder=folder)
        assert module.value == (value, value)


def test_two_runs_of_a_seed_are_alike_and_leave_the_programs_own_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    source = "import random, ccm\nlog = ccm.log()\nm = ccm.Model()\nlog.x = random.random()\nm.run(2)\nlog.y = m.random.random()"
    outputs: list[str] = []
    for _ in range(2):
        run_text(source, limits=RunLimits(seed=4))
        outputs.append(capsys.readouterr().out)
        random.random()
    assert outputs[0] == outputs[1]


def test_loaded_classes_can_be_used_afterwards() -> None:
    module: Any = load_text(MODEL, "loaded.py")
    with pytest.raises(ZeroDivisionError):
        module.A().run()
    assert "ccm" not in sys.modules
