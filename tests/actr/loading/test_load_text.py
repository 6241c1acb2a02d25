"""Texts that are loaded as modules: any number of them, concurrently and one after another, as files would be."""

import gc
import linecache
import pickle
import sys
import threading
import traceback
import weakref
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import actr3d.actr as library
from actr3d.actr.loading import load_text, run_text
from actr3d.errors import ModelFileError

LATE = """
def late():
    import python_actr, ccm.lib.grid
    from ccm.lib.actr import ACTR
    from python_actr.actr import *
    import ccm.lib.actr as short
    assert ccm.lib.grid.World and short.Buffer
    return {ACTR, short.ACTR, python_actr.ACTR, __import__('ccm').ACTR}
""".replace("    from python_actr.actr import *\n", "")


def in_thread(call: Any) -> Any:
    """Returns the result of a call in another thread."""
    found: list[Any] = []
    thread = threading.Thread(target=lambda: found.append(call()))
    thread.start()
    thread.join()
    return found[0]


@pytest.fixture
def real() -> Any:
    """Other modules with the old names, as if python_actr were installed and imported."""
    names = ("python_actr", "ccm", "ccm.lib", "ccm.lib.actr")
    before = {name: sys.modules.pop(name) for name in names if name in sys.modules}
    modules = {name: ModuleType(name) for name in names}
    sys.modules.update(modules)
    yield modules
    assert all(sys.modules[name] is module for name, module in modules.items())
    for name in names:
        del sys.modules[name]
    sys.modules.update(before)


@pytest.mark.parametrize("load", [load_text, run_text])
def test_a_late_import_of_an_old_name_gets_this_library(load: Any, real: Any) -> None:
    module = load(LATE)
    assert module.late() == {library.ACTR}
    assert in_thread(module.late) == {library.ACTR}


def test_a_late_import_in_a_production_gets_this_library(real: Any) -> None:
    text = "from ccm import *\nseen = []\nclass A(ACTR):\n    def init():\n        import ccm\n        seen.append(ccm.Buffer)\n"
    module: Any = load_text(text)
    module.A().run(1)
    assert module.seen == [library.Buffer]


def test_names_the_old_library_does_not_have_are_not_found() -> None:
    module: Any = load_text("def late(name):\n    return __import__(name)")
    with pytest.raises(ModuleNotFoundError, match=r"No module named 'ccm.nothing'"):
        module.late("ccm.nothing")
    with pytest.raises(ModuleNotFoundError, match="No module named 'nothing_at_all'"):
        module.late("nothing_at_all")


def test_each_text_of_one_name_has_its_own_lines() -> None:
    texts = [f"# text {number}\n" + "\n" * number + f"def boom():\n    return 1 / 0  # {number}\n" for number in range(3)]
    modules: list[Any] = [load_text(text, "editor.py") for text in texts]
    for number, module in reversed(list(enumerate(modules))):
        with pytest.raises(ZeroDivisionError) as caught:
            module.boom()
        frame = traceback.extract_tb(caught.value.__traceback__)[-1]
        assert (frame.filename, frame.line) == ("editor.py", f"return 1 / 0  # {number}")
        assert f'File "editor.py", line {3 + number}, in boom' in "".join(traceback.format_exception(caught.value))


def test_a_text_does_not_take_the_lines_of_the_file_it_came_from(tmp_path: Path) -> None:
    path = tmp_path / "edited.py"
    path.write_text("x = 'as it is on disk'\n", encoding="utf-8")
    assert linecache.getline(str(path), 1) == "x = 'as it is on disk'\n"
    with pytest.raises(ZeroDivisionError) as caught:
        load_text("x = 1 / 0", str(path))
    assert traceback.extract_tb(caught.value.__traceback__)[-1].line == "x = 1 / 0"


HELPER = """
from __future__ import annotations
from dataclasses import dataclass
import ccm
from parts.inner import PLACE

@dataclass
class Setting:
    value: int = 3

class Part(ccm.Model):
    pass

def late():
    import python_actr
    return python_actr.ACTR
"""


@pytest.fixture
def folders(tmp_path: Path) -> list[Path]:
    """Two folders with helper modules of the same names."""
    for name in ("one", "two"):
        (tmp_path / name / "parts").mkdir(parents=True)
        (tmp_path / name / "helper.py").write_text(
            f"{HELPER}NAME = '{name}'\n",
            encoding="utf-8",
        )
        (tmp_path / name / "parts" / "__init__.py").write_text("from . import inner\n", encoding="utf-8")
        (tmp_path / name / "parts" / "inner.py").write_text(f"PLACE = 'inside {name}'\n", encoding="utf-8")
        (tmp_path / name / "later.py").write_text(f"NAME = 'later {name}'\n", encoding="utf-8")
    return [tmp_path / "one", tmp_path / "two"]


HELPED = """
import helper, parts.inner
from helper import NAME, Part, Setting
def later():
    import later
    return later.NAME
seen = (helper.NAME, NAME, helper.PLACE, parts.inner.PLACE, Setting().value)
"""


def test_helper_modules_of_two_folders_are_kept_apart(folders: list[Path], real: Any) -> None:
    modules: list[Any] = [load_text(HELPED, "model.py", folder=folder) for folder in folders]
    assert [module.seen for module in modules] == [(n, n, f"inside {n}", f"inside {n}", 3) for n in ("one", "two")]
    assert [in_thread(module.later) for module in reversed(modules)] == ["later two", "later one"]
    assert all(issubclass(module.Part, library.Model) and in_thread(module.helper.late) is library.ACTR for module in modules)
    assert not {"helper", "parts", "later"} & set(sys.modules)
    assert pickle.loads(pickle.dumps(modules[1].Setting(5))) == modules[1].Setting(5)


def test_without_a_folder_there_are_no_helper_modules(folders: list[Path], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folders[0])
    with pytest.raises(ModuleNotFoundError, match="No module named 'later'"):
        load_text("import later")


def test_a_text_that_fails_leaves_nothing_in_the_modules(folders: list[Path]) -> None:
    load_text("import dataclasses, ccm.lib.grid")
    gc.collect()
    before = dict(sys.modules)
    for text, error in ((HELPED + "1 / 0", ZeroDivisionError), ("x = = 1", ModelFileError)):
        with pytest.raises(error):
            load_text(text, folder=folders[0])
        assert dict(sys.modules) == before


def test_texts_loaded_concurrently_by_many_threads_do_not_disturb_each_other(folders: list[Path], real: Any) -> None:
    seen: list[Any] = []

    def load(number: int) -> None:
        folder = folders[number % 2]
        module: Any = load_text(HELPED + f"number = {number}\nimport ccm\nclass A(ccm.ACTR): pass\n", "model.py", folder=folder)
        seen.append((module.seen[0] == folder.name, module.later() == f"later {folder.name}", issubclass(module.A, library.ACTR)))

    threads = [threading.Thread(target=load, args=[number]) for number in range(24)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert seen == [(True, True, True)] * 24


AGENT = """
from ccm import *
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('go NUMBER')
    def go(goal='go ?n'):
        goal.clear()
"""


def test_nothing_is_left_of_unused_texts(folders: list[Path]) -> None:
    def load(number: int) -> Any:
        module: Any = load_text(AGENT.replace("NUMBER", str(number)) + "import helper\n", "agent.py", folder=folders[0])
        module.Agent().run(1)
        return module

    load(0)
    gc.collect()
    before = len(linecache.cache), len(sys.modules)
    kept: Any = load(1).Agent
    dead = [weakref.ref(load(number)) for number in range(2, 20)]
    gc.collect()
    assert [ref for ref in dead if ref() is not None] == []
    # The class keeps its module, its lines and its helper modules.
    assert sys.modules[kept.__module__].Agent is kept
    assert len(linecache.cache) > before[0]
    del kept
    gc.collect()
    assert (len(linecache.cache), len(sys.modules)) == before


def test_the_registered_module_is_the_loaded_text() -> None:
    module: Any = load_text("from __future__ import annotations\nimport dataclasses\n@dataclasses.dataclass\nclass A:\n    x: int = 1\n")
    registered: Any = sys.modules[module.__name__]
    assert vars(registered) is vars(module)
    assert pickle.loads(pickle.dumps(module.A(3))) == module.A(3)
    registered.y = 4
    assert module.y == 4
    with pytest.raises(AttributeError, match="has no attribute 'z'"):
        _ = registered.z
    del module
    gc.collect()
    assert (vars(registered), hasattr(registered, "A")) == ({}, False)


def test_one_text_is_called_the_same_each_time_it_is_loaded_alone() -> None:
    first, second = load_text("x = 1", "a.py"), load_text("x = 1", "a.py")
    assert second.__name__ == f"{first.__name__}_2"
    name = first.__name__
    del first, second
    gc.collect()
    assert load_text("x = 1", "a.py").__name__ == name


def test_a_class_without_functions_keeps_its_text_in_use() -> None:
    agent = load_text("class Bare:\n    colour = 'red'\n", "bare.py").Bare
    gc.collect()
    assert sys.modules[agent.__module__].Bare is agent


def test_a_file_in_a_copy_of_the_repository_gets_the_library_itself(tmp_path: Path) -> None:
    (tmp_path / "actr3d").mkdir()
    for name in ("__init__", "clock"):
        (tmp_path / "actr3d" / f"{name}.py").write_text("copy = True\n")
    source = "import actr3d\nfrom actr3d import clock\nfrom actr3d.actr import ACTR\n"
    loaded = load_text(source, str(tmp_path / "m.py"), folder=tmp_path)
    ran = run_text(source, str(tmp_path / "m.py"), folder=tmp_path)
    for module in (loaded, ran):
        assert module.ACTR is library.ACTR
        assert not hasattr(module.actr3d, "copy")
        assert not hasattr(module.clock, "copy")


COUNTING = """
from python_actr import ACTR, Buffer
seen = []
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('go 1')
    def go(goal='go ?n'):
        goal.clear()
        seen.append(n)
        later = lambda: 1 / fails
        if fails == 0:
            later()
"""


def test_a_text_that_is_loaded_again_shares_nothing_that_changes_with_the_first_module() -> None:
    def load(fails: int) -> Any:
        module: Any = load_text(COUNTING, "counting.py")
        module.fails = fails
        return module

    first, second = load(1), load(1)
    first.Agent().run(1)
    assert (first.seen, second.seen) == (["1"], [])
    second.Agent().run(1)
    assert (first.seen, second.seen) == (["1"], ["1"])
    gone = [weakref.ref(first), weakref.ref(second)]
    del first, second
    gc.collect()
    assert [ref() for ref in gone] == [None, None]
    third = load(0)
    with pytest.raises(ZeroDivisionError) as raised:
        third.Agent().run(1)
    lines = [frame.line for frame in traceback.extract_tb(raised.value.__traceback__) if frame.filename == "counting.py"]
    assert lines[-2:] == ["later()", "later = lambda: 1 / fails"]  # the lines of the first module no longer exist


def test_the_compiler_warns_about_a_text_each_time_it_is_loaded() -> None:
    for _ in range(2):
        with pytest.warns(SyntaxWarning, match='"is" with'):
            load_text("x = 1\ny = x is 1\n", "warns.py")
    module: Any = load_text("x = 1\n", "quiet.py")
    assert module.x == 1
    for _ in range(2):
        with pytest.raises(ModelFileError, match=r"wrong\.py:1: "):
            load_text("x = (\n", "wrong.py")
