"""Bodies of productions: everything that Python allows in a function, and which names it sees."""

from __future__ import annotations

import sys
import textwrap
from typing import Any

import pytest

from actr3d.actr.loading import load_text


def run_body(body: str, start: str = "n:1 word:cat", pattern: str = "n:?n word:?word", before: str = "", members: str = "") -> Any:
    """Runs one production with this body, and returns the agent; `out` collects its output."""
    text = f"""
from actr3d.actr import *
out = []
limit = 10
{textwrap.dedent(before)}
class Agent(ACTR):
    goal = Buffer()
    fired = 0
{textwrap.indent(textwrap.dedent(members), "    ")}
    def init():
        goal.set({start!r})
    def act(goal={pattern!r}):
{textwrap.indent(textwrap.dedent(body), "        ")}
"""
    module: Any = load_text(text, "body.py")
    agent = module.Agent()
    agent.run(0.06)
    agent.out = module.out
    agent.module = module
    return agent


BODIES: dict[str, tuple[str, list[Any]]] = {
    "bound": ("out.append((n, word))", [("1", "cat")]),
    "rebinding": ("n = int(n) + 1\ngoal.set('n:?n')\nout.append(goal['n'])", [2]),
    "augmented": ("n = int(n)\nn += 4\nout.append(n)", [5]),
    "annotated": ("k: int = int(n)\nj: str\nout.append(k)", [1]),
    "star": ("a, *b = word\nout.append((a, b))", [("c", ["a", "t"])]),
    "chained": ("a = b = int(n)\nout.append(a + b)", [2]),
    "for": ("for i in range(3):\n    k = i\nelse:\n    k = -k\nout.append((i, k))", [(2, -2)]),
    "while": ("k = 0\nwhile k < 5:\n    k += 1\n    if k == 3: break\nout.append(k)", [3]),
    "walrus": ("if (k := int(n)) == 1:\n    out.append(k)", [1]),
    "walrus in comprehension": ("a = [last := i for i in range(4)]\nout.append((a, last))", [([0, 1, 2, 3], 3)]),
    "comprehension of bound": ("out.append([word + c for c in word if c != n])", [["catc", "cata", "catt"]]),
    "comprehension of assigned": ("m = 2\nout.append({m * i for i in range(3)})", [{0, 2, 4}]),
    "comprehension hides": ("n = [n for n in (n, n)]\nout.append(n)", [["1", "1"]]),
    "comprehension iterates outer": ("k = [1, 2]\nout.append([k for k in k])", [[1, 2]]),
    "nested comprehension": ("k = 2\nout.append([[k * j for j in range(i)] for i in range(k)])", [[[], [0]]]),
    "dict comprehension": ("k = 'z'\nout.append({c: k for c in word})", [{"c": "z", "a": "z", "t": "z"}]),
    "generator expression": ("k = 3\nout.append(sum(k * int(i) for i in '12'))", [9]),
    "lambda": ("k = 3\nf = lambda x: x + k\nk = 4\nout.append(f(1))", [5]),
    "lambda default": ("k = 3\nfs = [lambda k=k, i=i: k + i for i in range(2)]\nout.append([f() for f in fs])", [[3, 4]]),
    "lambda default of bound": ("f = lambda n=n: n\nout.append(f())", ["1"]),
    "lambda walrus": ("k = 1\nf = lambda: (k := 5)\nf()\nout.append(k)", [1]),
    "lambda star": ("k = 1\nf = lambda *k, **n: (k, n)\nout.append(f(2, a=3))", [((2,), {"a": 3})]),
    "function": ("def f(x, n=n, *, k=word):\n    y = x + n\n    return y + k\nout.append(f('a'))", ["a1cat"]),
    "function sees newest": ("k = 1\ndef f():\n    return k\nk = 2\nout.append(f())", [2]),
    "function hides": ("k = 1\ndef f():\n    k = 2\n    return k\nout.append((f(), k))", [(2, 1)]),
    "nonlocal": ("k = 1\ndef f():\n    nonlocal k\n    k += 1\nf()\nf()\nout.append(k)", [3]),
    "nonlocal of bound": ("n = n\ndef f():\n    nonlocal n\n    n = 'new'\nf()\ngoal.set('n:?n')\nout.append(goal['n'])", ["new"]),
    "nonlocal inside": (
        "def f():\n    k = 1\n    def g():\n        nonlocal k\n        k = 2\n    g()\n    return k\nout.append(f())",
        [2],
    ),
    "recursion": ("def f(i):\n    return 1 if i == 0 else i * f(i - 1)\nout.append(f(4))", [24]),
    "decorated function": ("def twice(f):\n    return lambda: f() * 2\n@twice\ndef g():\n    return 4\nout.append(g())", [8]),
    "generator function": ("def g():\n    yield n\n    yield word\nout.append(list(g()))", [["1", "cat"]]),
    "async function": (
        "import inspect\nasync def g():\n    k = 1\n    return k\nc = g()\nc.close()\nout.append(inspect.iscoroutine(c))",
        [True],
    ),
    "class": ("k = 3\nclass C:\n    k = 5\n    def get(self):\n        return k\nout.append((C.k, C().get()))", [(5, 3)]),
    "class base": ("class A:\n    x = 1\nclass B(A):\n    pass\nout.append(B.x)", [1]),
    "class comprehension": ("k = 3\nclass C:\n    k = [k for i in (1, 2)]\nout.append(C.k)", [[3, 3]]),
    "import": ("import math, os.path as where\nout.append((math.floor(1.5), where.basename('a/b')))", [(1, "b")]),
    "import from": ("from math import floor as down\nout.append(down(2.5))", [2]),
    "with": (
        "import contextlib\nwith contextlib.nullcontext(n) as a, contextlib.nullcontext() as b:\n    out.append((a, b))",
        [("1", None)],
    ),
    "try": (
        "try:\n    1 / 0\nexcept ZeroDivisionError as e:\n    out.append(str(e))\nfinally:\n    out.append(n)",
        ["division by zero", "1"],
    ),
    "except star": (
        "try:\n    raise ExceptionGroup('g', [ValueError(1)])\nexcept* ValueError as e:\n    out.append(len(e.exceptions))",
        [1],
    ),
    "match": ("match [int(n), 2, 3]:\n    case [a, *b]:\n        out.append((a, b))", [(1, [2, 3])]),
    "match guard": ("match 5:\n    case k if k > 7:\n        out.append('big')\n    case k if k > 3:\n        out.append(k)", [5]),
    "match mapping": ("match {'a': 1, 'b': 2}:\n    case {'a': a, **rest}:\n        out.append((a, rest))", [(1, {"b": 2})]),
    "match class": ("class P:\n    x = 4\nmatch P():\n    case P(x=k) as whole:\n        out.append((k, whole.x))", [(4, 4)]),
    "match value": ("import types\nV = types.SimpleNamespace(a=1)\nmatch int(n):\n    case V.a:\n        out.append('yes')", ["yes"]),
    "match assigned class": ("T = int\nmatch 4:\n    case T():\n        out.append('T')", ["T"]),
    "del": ("k = 1\ndel k\ntry:\n    k\nexcept NameError as e:\n    out.append(e.name)", ["k"]),
    "del unknown": ("try:\n    del k\nexcept NameError as e:\n    out.append(e.name)\nif 0: k = 1", ["k"]),
    "fstring": ("k = 1.5\nout.append(f'{word!r:>6}|{k:.2f}|{n=}')", [" 'cat'|1.50|n='1'"]),
    "return": ("if n == '1':\n    out.append('early')\n    return\nout.append('late')", ["early"]),
    "docstring": ("'''Does nothing.'''", []),
    "pass": ("pass", []),
    "file globals": ("out.append(limit)", [10]),
    "read before assigned": ("limit = limit + 1\nout.append(limit)", [11]),
    "builtin": ("len = len(word)\nout.append(len)", [3]),
    "conditional expression": ("k = 'a' if n == '1' else 'b'\nout.append(k)", ["a"]),
    "slices": ("k = [1, 2, 3, 4]\nk[1:3] = []\nk[0] += 5\nout.append(k)", [[6, 4]]),
    "attribute": ("self.fired += 1\nout.append(self.fired)", [1]),
    "global": ("global limit\nlimit += 5\nout.append(limit)", [15]),
    "global in function": ("limit = 1\ndef f():\n    global limit\n    limit += 5\n    return limit\nout.append((f(), limit))", [(15, 1)]),
    "assigned seen in text": ("color = 'red'\ngoal.set('word ?color ?n')\nout.append(str(goal.chunk))", ["word red 1"]),
    "loop variable in text": ("for i in range(2):\n    goal.set('i:?i')\nout.append(goal['i'])", [1]),
    "captured in text": ("match n:\n    case str() as k:\n        goal.set('k:?k')\nout.append(goal['k'])", ["1"]),
    "imported in text": ("import math\ngoal.set('m:?math')\nout.append(goal['m'].floor(1.5))", [1]),
    "caught in text": (
        "try:\n    {}['a']\nexcept KeyError as k:\n    goal.set('k:?k')\n    out.append(type(goal['k']).__name__)",
        ["KeyError"],
    ),
    "locals": ("out.append('%(n)s %(word)s' % locals())", ["1 cat"]),
    "locals of a function": ("f = lambda a: sorted(locals())\nout.append(f(1))", [["a"]]),
    "vars": ("k = 2\nout.append((sorted(vars()), vars(self)['fired']))", [(["k", "n", "word"], 0)]),
    "dir": ("out.append(dir())", [["n", "word"]]),
    "eval": ("k = 4\nout.append(eval('k + int(n) + limit + self.fired'))", [15]),
    "eval in a comprehension": ("out.append([eval('i + 1') for i in eval('range(int(n))')])", [[1]]),
    "eval of a comprehension": ("out.append(eval('[word for _ in range(2)]'))", [["cat", "cat"]]),
    "eval with names": ("out.append(eval('n + a', {'a': 'b', 'n': 'x'}))", ["xb"]),
    "exec": ("exec('goal.set(\"w:?word\")')\nout.append(goal['w'])", ["cat"]),
    "exec assigns": ("exec('n = k = 5')\ngoal.set('k:?k')\nout.append((n, k, goal['k']))", [(5, 5, 5)]),
    "builtins are hidden": ("vars = [n]\neval = vars.append\neval(word)\nout.append((lambda: vars)())", [["1", "cat"]]),
    "unicode": ("größe = int(n)\ngoal.set('w:?größe')\nout.append(goal['w'])", [1]),
}


@pytest.mark.parametrize("name", BODIES)
def test_everything_that_python_allows_in_a_body(name: str) -> None:
    body, expected = BODIES[name]
    assert run_body(body).out == expected


def test_an_attribute_hides_a_builtin_that_sees_variables() -> None:
    assert run_body("out.append((vars, (lambda: vars)()))", members="vars = 'agent'").out == [("agent", "agent")]


def test_type_statement() -> None:
    if sys.version_info >= (3, 12):
        assert run_body("type Pair = tuple[int, n]\nout.append(Pair.__name__)").out == ["Pair"]
        assert run_body("def f[T](x: T, n=n) -> T:\n    return x\nout.append(f(n))").out == ["1"]
    else:
        with pytest.raises(Exception, match=r"body\.py:\d+"):
            run_body("type Pair = tuple[int, n]")


def test_attributes_hide_file_globals_and_bound_names_hide_attributes() -> None:
    before = "colour = 'file'\nshape = 'file'\nn = 'file'"
    agent = run_body("out.append((colour, shape, n))", before=before, members="shape = 'agent'\nn = 'agent'")
    assert agent.out == [("file", "agent", "1")]


def test_nearest_ancestor_wins_and_top_is_the_highest() -> None:
    module: Any = load_text(
        """
from actr3d.actr import *
out = []
class Inner(ProductionSystem):
    speed = 1
    def act(goal='go'):
        out.append((speed, depth, self.name, top.name, self.parent.name))
        goal.clear()
class Agent(ACTR):
    speed = 2
    depth = 2
    goal = Buffer()
    inner = Inner()
    def init():
        goal.set('go')
class World(Model):
    speed = 3
    depth = 3
    agent = Agent()
""",
        "nested.py",
    )
    module.World().run(0.2)
    assert module.out == [(1, 2, "inner", "top", "agent")]


def test_file_globals_are_live() -> None:
    agent = run_body("out.append(limit)\ngoal.modify(n=int(n) + 1)")
    agent.module.limit = 11
    agent.run(0.05)
    assert agent.out == [10, 11]


def test_names_of_a_function_around_the_class_are_seen_live() -> None:
    module: Any = load_text(
        """
from actr3d.actr import *
def make(step):
    seen = []
    class Agent(ACTR):
        goal = Buffer()
        def init():
            goal.set('n:0')
        def act(goal='n:?n'):
            seen.append(step)
            m = int(n) + step
            goal.set('n:?m')
    def faster():
        nonlocal step
        step = 10
    return Agent, seen, faster
""",
        "closure.py",
    )
    kind, seen, faster = module.make(2)
    agent = kind()
    agent.run(0.06)
    faster()
    agent.run(0.05)
    assert seen == [2, 10]
    assert agent.goal["n"] == 12


def test_assignments_in_init_are_seen_by_all_productions_of_that_agent_only() -> None:
    module: Any = load_text(
        """
from actr3d.actr import *
import itertools
serial = itertools.count()
out = []
class Agent(ACTR):
    goal = Buffer()
    def a_first():
        number = next(serial)
    def init():
        word = 'w%d' % number
        goal.set('go')
    def act(goal='go'):
        out.append((number, word))
        goal.clear()
""",
        "init.py",
    )
    first, second = module.Agent(), module.Agent()
    first.run(0.2)
    second.run(0.2)
    assert module.out == [(0, "w0"), (1, "w1")]


def test_global_changes_what_init_assigned() -> None:
    module: Any = load_text(
        """
from actr3d.actr import *
out = []
class Agent(ACTR):
    goal = Buffer()
    def init():
        count = 0
        goal.set('go')
    def act(goal='go'):
        global count
        count += 1
        goal.set('read')
    def read(goal='read'):
        out.append(count)
        goal.clear()
""",
        "global.py",
    )
    module.Agent().run(0.2)
    module.Agent().run(0.2)
    assert module.out == [1, 1]


def test_private_attributes_are_those_of_the_methods() -> None:
    members = """
    def look(self):
        return self.__secret
    def keep(self, value):
        self.__secret = value
    """
    assert run_body("self.keep(4)\nself.__secret += 1\nout.append(self.look())", members=members).out == [5]
