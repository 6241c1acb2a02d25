"""Sources of productions: forms of definition, inheritance, files, and the errors that name them."""

from __future__ import annotations

import importlib
import linecache
import subprocess
import sys
import traceback
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr import ACTR
from actr3d.actr.loading import load_text, run_file
from actr3d.errors import ModelWarning, ProductionException
from tests.helpers.paths import MODELS

HEAD = "from actr3d.actr import *\nout = []\n"


def load(body: str, name: str = "forms.py") -> Any:
    return load_text(HEAD + body, name)


def ran(body: str, seconds: float = 0.3) -> list[Any]:
    module = load(body)
    module.Agent().run(seconds)
    return module.out


def test_one_line_production() -> None:
    body = "class Agent(ACTR):\n  goal = Buffer()\n  def init(): goal.set('a')\n  def p(goal='a'): goal.set('b'); out.append(1)\n"
    assert ran(body) == [1]


def test_signature_on_several_lines_with_brackets_in_patterns() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('a:(x) b:2')
    def p(
        goal=('b:?b',   # a comment with ) and :
              'b:!3'),
        utility=(1
                 + 1),
    ) -> None:
        out.append(b)
        goal.clear()
"""
    assert ran(body) == ["2"]


def test_tabs_and_windows_line_ends(tmp_path: Path) -> None:
    text = HEAD + (
        "class Agent(ACTR):\n\tgoal = Buffer()\n\tdef init():\n\t\tgoal.set('a')\n"
        "\tdef p(goal='a'):\n\t\tif True:\n\t\t\tout.append('''two\nlines''')\n\t\tgoal.clear()\nagent = Agent()\nagent.run(1)\n"
    )
    (tmp_path / "m.py").write_bytes(text.replace("\n", "\r\n").encode())
    assert run_file(tmp_path / "m.py").out == ["two\nlines"]


def test_unicode_names() -> None:
    body = """
class Agent(ACTR):
    ziel = Buffer()
    größe = 3
    def init():
        ziel.set('straße:lang')
    def gehe_über(ziel='straße:?länge'):
        out.append((länge, größe))
        ziel.clear()
"""
    assert ran(body) == [("lang", 3)]


def test_definitions_that_depend_on_a_condition() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('a')
    for word in ('x', 'y'):
        if word == 'y':
            def p(goal='a'):
                out.append('then')
                goal.clear()
        else:
            def p(goal='a'):
                out.append('else')
"""
    assert ran(body) == ["then"]


def test_two_functions_of_one_name_on_two_lines_keep_their_own_bodies() -> None:
    body = """
class A(ACTR):
    goal = Buffer()
    def init():
        goal.set('a')
    def p(goal='a'):
        out.append('A')
        goal.clear()
class Agent(A):
    def p(goal='a'):
        out.append('B')
        goal.clear()
"""
    module = load(body)
    module.Agent().run(0.2)
    module.A().run(0.2)
    assert module.out == ["B", "A"]


def test_inherited_mixed_in_overridden_and_removed_productions() -> None:
    body = """
class Base(ACTR):
    goal = Buffer()
    def init():
        goal.set('a')
    def first(goal='a'):
        out.append('base first')
        goal.set('b')
    def second(goal='b'):
        out.append('base second')
        goal.set('c')
    def unwanted(goal='c'):
        out.append('unwanted')
class Mixin:
    def second(goal='b'):
        out.append('mixin second')
        goal.set('c')
    def third(goal='c'):
        out.append('mixin third')
        goal.clear()
class Agent(Mixin, Base):
    unwanted = None
"""
    assert ran(body) == ["base first", "mixin second", "mixin third"]


def test_productions_of_a_base_class_see_their_own_files_globals(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "rules_of_old.py").write_text(
        "from actr3d.actr import *\nword = 'base file'\nseen = []\nclass Old(ACTR):\n    goal = Buffer()\n"
        "    def init():\n        goal.set('a')\n    def p(goal='a'):\n        seen.append(word)\n        goal.set('b')\n"
    )
    (tmp_path / "rules_of_new.py").write_text(
        "from rules_of_old import *\nimport rules_of_old\nword = 'new file'\nclass New(Old):\n    def q(goal='b'):\n"
        "        seen.append(word)\n        goal.clear()\n"
    )
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    module: Any = importlib.import_module("rules_of_new")
    module.New().run(0.3)
    assert module.seen == ["base file", "new file"]
    for name in ("rules_of_new", "rules_of_old"):
        del sys.modules[name]


def test_decorated_productions() -> None:
    body = """
def noted(func):
    out.append(func.__name__)
    return func
def with_utility(value):
    return lambda func: func
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('a')
    @noted
    @with_utility(
        3
    )
    def p(goal='a'):
        out.append('fired')
        goal.clear()
"""
    assert ran(body) == ["p", "fired"]


def test_a_body_that_yields_is_named_with_its_line() -> None:
    body = "class Agent(ACTR):\n    goal = Buffer()\n    def init():\n        goal.set('a')\n    def p(goal='a'):\n        yield 1\n"
    with pytest.raises(ProductionException, match=r"forms\.py:8: production 'p' yields; the body of a production cannot wait"):
        ran(body)


def test_a_traceback_shows_file_line_text_and_production() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('n:0')
    def divide(goal='n:?n'):
        m = int(n)
        out.append(
            1 / m
        )
"""
    module = load(body, "errors.py")
    with pytest.raises(ZeroDivisionError) as caught:
        module.Agent().run(1)
    frame = traceback.extract_tb(caught.value.__traceback__)[-1]
    assert (frame.filename, frame.lineno, frame.name, frame.line) == ("errors.py", 11, "divide", "1 / m")
    assert caught.value.__notes__ == ["in production 'divide' (errors.py:8) at 0.05 s"]


def test_a_misspelt_name_in_a_body_is_recognized() -> None:
    body = "class Agent(ACTR):\n    goal = Buffer()\n    def init():\n        goal.set('a')\n    def p(goal='a'):\n        gaol.clear()\n"
    with pytest.raises(NameError) as caught, pytest.warns(ModelWarning, match="nothing defines 'gaol'; did you mean 'goal'"):
        ran(body)
    assert "did you mean 'goal'?" in caught.value.__notes__[0]


def test_a_misspelt_method_in_a_body_is_recognized() -> None:
    body = "class Agent(ACTR):\n    goal = Buffer()\n    def init():\n        goal.sett('a')\n"
    with pytest.raises(AttributeError) as caught:
        ran(body)
    assert "in production 'init' (forms.py:5) at 0 s; did you mean 'set'?" in caught.value.__notes__


def test_missing_source_code_is_reported_plainly() -> None:
    space: dict[str, Any] = {}
    text = HEAD + "class Agent(ACTR):\n    goal = Buffer()\n    def init():\n        goal.set('a')\n"
    exec(text, space)
    with pytest.raises(ProductionException, match=r"production 'init': its source is not available \(<string>:5\).*load_text"):
        space["Agent"]().run(1)


@pytest.mark.parametrize("statement", ["goal.clear()", "yield 1"])
def test_an_async_production_is_reported_plainly(statement: str) -> None:
    body = f"class Agent(ACTR):\n    goal = Buffer()\n    async def init():\n        {statement}\n"
    with pytest.raises(ProductionException, match=r"production 'init': it is async \(forms.py:5\); write it with def"):
        ran(body)


def test_a_file_that_changed_after_it_was_loaded_is_reported_plainly(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "changed_since.py"
    text = HEAD + "class Agent(ACTR):\n    goal = Buffer()\n    def init():\n        goal.set('a')\n"
    path.write_text(text)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    module: Any = importlib.import_module("changed_since")
    path.write_text("# a new first line\n" + text)
    with pytest.raises(ProductionException, match=r"changed_since\.py:5.*changed"):
        module.Agent().run(1)
    path.write_text("def (:\n")
    del sys.modules["changed_since"]


def test_two_texts_of_one_name_keep_their_own_bodies() -> None:
    text = "class Agent(ACTR):\n    goal = Buffer()\n    def init():\n        out.append({!r})\n"
    first, second = load(text.format("first")), load(text.format("second"))
    first.Agent().run(0.1)
    second.Agent().run(0.1)
    assert (first.out, second.out) == (["first"], ["second"])


def test_lines_are_counted_as_python_counts_them() -> None:
    with pytest.raises(ZeroDivisionError) as caught:
        load("# a form feed \x0c and a \u2028 end no line\n1 / 0\n", "feed.py")
    frame = traceback.extract_tb(caught.value.__traceback__)[-1]
    assert (frame.lineno, frame.line) == (4, "1 / 0")


def test_a_lambda_is_no_production() -> None:
    body = "class Agent(ACTR):\n    goal = Buffer()\n    p = lambda goal='a': goal.clear()\n    def init():\n        goal.set('a')\n"
    with pytest.raises(ProductionException, match=r"production 'p'.*forms\.py:5.*def"):
        ran(body)


@pytest.mark.parametrize("name", ["production_time", "production_threshold"])
def test_a_plain_function_as_time_or_threshold(name: str) -> None:
    for given in ("lambda: 0.2", "value"):
        body = (
            f"def value(): return 0.2\nclass Agent(ACTR):\n    goal = Buffer()\n    {name} = {given}\n"
            "    def init():\n        goal.set('a')\n"
            "    def p(goal='a', utility=0.2):\n        out.append(self.now())\n        goal.clear()\n"
        )
        assert ran(body) == [0.2 if name == "production_time" else 0.05]


def test_keyword_only_patterns_are_patterns() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('a')
    def p(*, goal='b'):
        out.append('p')
        goal.clear()
    def q(*, goal='a'):
        out.append('q')
        goal.clear()
"""
    assert ran(body) == ["q"]


def test_names_of_tests_stay_live_in_classes_written_in_functions() -> None:
    seen: list[str] = []

    class Agent(ACTR):
        def init():  # pyright: ignore
            seen.append("init")

    Agent().run(0.1)
    assert seen == ["init"]


THREADS = """
import gc, sys, threading, time
from pathlib import Path
from actr3d.actr.kernel.source_code import parse

text = Path(sys.argv[1]).read_text(encoding="utf-8")
failures = []

def work():
    for _ in range(12):
        try:
            parse(text)
        except SystemError as error:
            failures.append(error)

gc.set_threshold(2000)
gc.callbacks.append(lambda phase, info: time.sleep(2e-4))  # lets other threads run in the middle of a tree
threads = [threading.Thread(target=work) for _ in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(len(failures))
"""


def test_several_threads_can_parse_concurrently() -> None:
    model = MODELS / "aperture_passage.py"
    done = subprocess.run([sys.executable, "-c", THREADS, str(model)], check=True, capture_output=True, text=True)
    assert done.stdout == "0\n"


def test_a_file_that_has_changed_since_its_import_is_not_run_in_a_mixture_of_versions(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "edited_since.py"
    body = "    def init(): goal.set('go')\n    def act(goal='go'): goal.set('end')\n"
    text = f"from actr3d.actr import *\nclass A(ACTR):\n    goal = Buffer()\n{body}"
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    file.write_text(text, encoding="utf-8")
    module: Any = importlib.import_module("edited_since")
    module.A().run(0)
    linecache.clearcache()
    file.write_text(text.replace("'go'", "'run'"), encoding="utf-8")
    with pytest.raises(ProductionException, match=r"production 'init': its source is not available .* the file has changed since"):
        module.A().run()
