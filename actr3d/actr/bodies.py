"""Turns the body of a production into a function of what the production has bound.

A body sees, nearest first: its bound variables and whatever it assigns itself; the attributes of its agent and of the
agent's ancestors; the globals of its own file. What it assigns becomes visible to `?name` in the texts it passes on.
Lines keep their numbers, so that a traceback shows the modeller's own file.
"""

from __future__ import annotations

import ast
import builtins
import copy
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import CodeType
from typing import Any, cast

from actr3d.errors import ProductionException

BOUND = "__bound__"
Body = Callable[[dict[str, Any]], None]
_SCOPES = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda, ast.ClassDef)
_COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


class Scope(dict[str, Any]):
    """What a body has bound; what is not bound here is looked up further out."""

    def __init__(self, bound: Mapping[str, Any], context: Mapping[str, Any], file: Mapping[str, Any]) -> None:
        super().__init__(bound)
        self.__dict__["outer"] = (context, file, vars(builtins))

    def __missing__(self, key: str) -> Any:
        for names in self.__dict__["outer"]:
            if key in names:
                return names[key]
        raise NameError(f"name '{key}' is not defined", name=key)

    def bind(self, key: str, value: Any) -> Any:
        """Binds a name, and returns its value."""
        self[key] = value
        return value


def stored_names(nodes: Iterable[ast.AST]) -> set[str]:
    """Returns the names that statements assign in their own scope, whatever the form of assignment."""
    names: set[str] = set()
    loose: set[str] = set()
    for node in nodes:
        _collect(node, names, loose)
    return names - loose


def _collect(node: ast.AST, names: set[str], loose: set[str], inner: bool = False) -> None:
    """Adds to `names` what a node assigns, and to `loose` what it declares global; `inner` is inside a comprehension."""
    if isinstance(node, ast.Name) and isinstance(node.ctx, (ast.Store, ast.Del)) and not inner:
        names.add(node.id)
    elif isinstance(node, ast.NamedExpr):
        names.add(node.target.id)
        _collect(node.value, names, loose, inner)
        return
    elif isinstance(node, (ast.Global, ast.Nonlocal)):
        loose.update(node.names)
    elif isinstance(node, (ast.Import, ast.ImportFrom)):
        names.update((alias.asname or alias.name).split(".")[0] for alias in node.names)
    elif isinstance(node, (ast.ExceptHandler, ast.MatchAs, ast.MatchStar)) and node.name:
        names.add(node.name)
    elif isinstance(node, ast.MatchMapping) and node.rest:
        names.add(node.rest)
    elif isinstance(node, _SCOPES):
        if not isinstance(node, ast.Lambda):
            names.add(node.name)
        return
    for child in ast.iter_child_nodes(node):
        _collect(child, names, loose, inner or isinstance(node, _COMPREHENSIONS))


def used_names(nodes: Iterable[ast.AST]) -> set[str]:
    """Returns every name that is read or assigned anywhere in the nodes."""
    return {part.id for node in nodes for part in ast.walk(node) if isinstance(part, ast.Name)}


class _Rebinder(ast.NodeTransformer):
    """Makes every use of an assigned name a use of the bound variables, so that they always hold its newest value."""

    def __init__(self, stored: set[str]) -> None:
        self.stored = stored

    def _item(self, name: str, ctx: ast.expr_context, at: ast.AST) -> ast.Subscript:
        item = ast.Subscript(ast.Name(BOUND, ast.Load()), ast.Constant(name), ctx)
        return ast.fix_missing_locations(ast.copy_location(item, at))

    def _sync(self, names: Iterable[str], at: ast.AST) -> list[ast.stmt]:
        """Statements that bind names which Python could only assign plainly."""
        out: list[ast.stmt] = []
        for name in names:
            if name in self.stored:
                assign = ast.Assign([self._item(name, ast.Store(), at)], ast.Name(name, ast.Load()))
                out.append(ast.fix_missing_locations(ast.copy_location(assign, at)))
        return out

    def visit_Name(self, node: ast.Name) -> ast.expr:  # noqa: N802
        return self._item(node.id, node.ctx, node) if node.id in self.stored else node

    def visit_NamedExpr(self, node: ast.NamedExpr) -> ast.expr:  # noqa: N802
        if node.target.id not in self.stored:
            return cast("ast.expr", self.generic_visit(node))
        call = ast.Call(
            ast.Attribute(ast.Name(BOUND, ast.Load()), "bind", ast.Load()),
            [ast.Constant(node.target.id), cast("ast.expr", self.visit(node.value))],
            [],
        )
        return ast.fix_missing_locations(ast.copy_location(call, node))

    def _inside(self, node: Any, hidden: set[str]) -> Any:
        """Visits a nested scope, leaving alone the names that are its own."""
        before, self.stored = self.stored, self.stored - hidden
        self.generic_visit(node)
        self.stored = before
        return node

    def _parameters(self, args: ast.arguments) -> set[str]:
        every = [*args.posonlyargs, *args.args, *args.kwonlyargs, args.vararg, args.kwarg]
        return {a.arg for a in every if a is not None}

    def visit_Lambda(self, node: ast.Lambda) -> Any:  # noqa: N802
        return self._inside(node, self._parameters(node.args))

    def _definition(self, node: Any, hidden: set[str]) -> list[ast.stmt]:
        name = node.name
        return [self._inside(node, hidden), *self._sync([name], node)]

    def visit_FunctionDef(self, node: ast.FunctionDef) -> Any:  # noqa: N802
        return self._definition(node, self._parameters(node.args) | stored_names(node.body))

    def visit_ClassDef(self, node: ast.ClassDef) -> Any:  # noqa: N802
        return self._definition(node, stored_names(node.body))

    def _comprehension(self, node: Any) -> Any:
        targets = {n.id for g in node.generators for n in ast.walk(g.target) if isinstance(n, ast.Name)}
        return self._inside(node, targets)

    visit_ListComp = visit_SetComp = visit_DictComp = visit_GeneratorExp = _comprehension

    def visit_Import(self, node: ast.Import | ast.ImportFrom) -> Any:  # noqa: N802
        return [node, *self._sync([(a.asname or a.name).split(".")[0] for a in node.names], node)]

    visit_ImportFrom = visit_Import

    def visit_ExceptHandler(self, node: ast.ExceptHandler) -> Any:  # noqa: N802
        self.generic_visit(node)
        if node.name:
            node.body[:0] = self._sync([node.name], node)
        return node

    def visit_match_case(self, node: ast.match_case) -> Any:
        names = stored_names([node.pattern])
        self.generic_visit(node)
        node.body[:0] = self._sync(sorted(names), node.body[0])
        return node


def compile_body(
    statements: Sequence[ast.stmt],
    *,
    func: Callable[..., Any],
    name: str,
    bound: Iterable[str],
    context: Mapping[str, Any],
) -> Body:
    """Makes a function of a body's statements.

    Args:
        statements: The body, or some of its statements, as parsed; they are left as they are.
        func: The modeller's method they come from; its file's globals are seen live.
        name: The production's name, which tracebacks show.
        bound: The variables that the patterns bind.
        context: What the agent and its ancestors offer by name; fixed from here on.

    Returns:
        A function that takes the bound variables. Where the body assigns names, these must be a `Scope`.

    Raises:
        ProductionException: If the body contains `yield`, or cannot be compiled.
    """
    filename = func.__code__.co_filename
    stored = stored_names(statements)
    used = used_names(statements)
    taken = tuple(n for n in bound if n in used and n not in stored)
    given = tuple(sorted(n for n in used & context.keys() if n not in stored and n not in taken))
    # Thousands of agents of one class differ in what their names mean, not in their code.
    key = (filename, name, func.__code__, tuple((s.lineno, s.col_offset) for s in statements), taken, given)
    code = _CODES.get(key)
    if code is None:
        _refuse_yield(statements, name, filename)
        if len(_CODES) >= MOST_CODES:
            _CODES.clear()
        code = _CODES[key] = _compile(statements, name, filename, stored, taken, given)
    space: dict[str, Any] = {}
    exec(code, func.__globals__, space)
    made = space["__make__"](*(context[n] for n in given))
    made.__code__ = made.__code__.replace(co_name=name, co_qualname=name)
    return made


_CODES: dict[Any, CodeType] = {}
MOST_CODES = 10_000
"""How many bodies' code is kept."""


def _compile(
    statements: Sequence[ast.stmt], name: str, filename: str, stored: set[str], taken: Sequence[str], given: Sequence[str]
) -> CodeType:
    """Compiles a function that takes what the body is given by name, and returns the body as a function."""
    body = [cast("ast.stmt", copy.deepcopy(node)) for node in statements]
    if stored:
        rebinder = _Rebinder(stored)
        body = [part for node in body for part in _as_list(rebinder.visit(node))]
    first = statements[0]
    prologue = [ast.Assign([ast.Name(n, ast.Store())], ast.Subscript(ast.Name(BOUND, ast.Load()), ast.Constant(n), ast.Load())) for n in taken]
    inner = _function("__production__", [BOUND], [*prologue, *body], first)
    outer = _function("__make__", given, [inner, ast.Return(ast.Name("__production__", ast.Load()))], first)
    module = ast.fix_missing_locations(ast.Module([outer], []))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # whatever there is to say was said when the file itself was compiled
            return compile(module, filename, "exec", dont_inherit=True)
    except SyntaxError as error:
        raise ProductionException(f"{filename}:{error.lineno or first.lineno}: production '{name}': {error.msg}") from error


def _refuse_yield(statements: Sequence[ast.stmt], name: str, filename: str) -> None:
    for node in statements:
        for part in _own_nodes(node):
            if isinstance(part, (ast.Yield, ast.YieldFrom, ast.Await)):
                raise ProductionException(
                    f"{filename}:{part.lineno}: production '{name}' yields; a production acts at once: "
                    "let it call a generator method, which may wait"
                )


def _own_nodes(node: ast.AST) -> Iterable[ast.AST]:
    """Yields a node and those below it that belong to the same function."""
    yield node
    if not isinstance(node, _SCOPES):
        for child in ast.iter_child_nodes(node):
            yield from _own_nodes(child)


def _as_list(result: Any) -> list[ast.stmt]:
    return cast("list[ast.stmt]", result) if isinstance(result, list) else [result]


def _function(name: str, parameters: Sequence[str], body: list[Any], at: ast.AST) -> ast.FunctionDef:
    """Returns a plain function definition that stands where `at` stands."""
    args = ast.arguments(posonlyargs=[], args=[ast.arg(p) for p in parameters], kwonlyargs=[], kw_defaults=[], defaults=[])
    node: Any = ast.FunctionDef(name=name, args=args, body=body or [ast.Pass()], decorator_list=[])
    node.type_params = []  # Python 3.12 and newer ask for it
    return ast.copy_location(node, at)
