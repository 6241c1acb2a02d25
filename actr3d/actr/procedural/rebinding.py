"""Finds the names that code assigns, and redirects assignments to a production's bound variables.

The rules are Python's: comprehensions, lambdas, functions and classes inside a body are scopes of their own, and `global` and
`nonlocal` assign a name to another scope.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from typing import Any, cast

BOUND = "__bound__"
"""The name of the bound variables in a compiled body."""
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
SCOPES = (*_FUNCTIONS, ast.Lambda, ast.ClassDef)
_COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
SCOPE_BUILTINS = frozenset({"dir", "eval", "exec", "locals", "vars"})
"""The builtins that see the variables around their call."""


class Names:
    """The names that statements of one scope assign, declare global, or declare nonlocal."""

    def __init__(self, nodes: Iterable[ast.AST]) -> None:
        self.assigned: set[str] = set()
        self.declared_global: set[str] = set()
        self.declared_nonlocal: set[str] = set()
        for node in nodes:
            self._collect(node, inner=False)

    @property
    def own(self) -> set[str]:
        """The names that belong to this scope."""
        return self.assigned - self.declared_global - self.declared_nonlocal

    def _collect(self, node: ast.AST, inner: bool) -> None:
        """Collects the names of a node; `inner` is whether it is inside a comprehension, whose targets are its own."""
        if isinstance(node, ast.Name):
            if isinstance(node.ctx, (ast.Store, ast.Del)) and not inner:
                self.assigned.add(node.id)
        elif isinstance(node, ast.NamedExpr):
            self.assigned.add(node.target.id)
            self._collect(node.value, inner)
            return
        elif isinstance(node, ast.Global):
            self.declared_global.update(node.names)
        elif isinstance(node, ast.Nonlocal):
            self.declared_nonlocal.update(node.names)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            self.assigned.update(imported_names(node))
        elif isinstance(node, (ast.ExceptHandler, ast.MatchAs, ast.MatchStar)):
            self.assigned.update({node.name} if node.name else ())
        elif isinstance(node, ast.MatchMapping):
            self.assigned.update({node.rest} if node.rest else ())
        elif isinstance(node, SCOPES):
            self._collect_scope(node)
            return
        for child in ast.iter_child_nodes(node):
            self._collect(child, inner or isinstance(node, _COMPREHENSIONS))

    def _collect_scope(self, node: Any) -> None:
        if not isinstance(node, ast.Lambda):
            self.assigned.add(node.name)
        for part in outside(node):
            self._collect(part, inner=False)


def outside(node: Any) -> list[ast.expr]:
    """Returns the parts of a function, lambda or class that are evaluated in the scope around it: decorators, defaults, bases."""
    if isinstance(node, ast.ClassDef):
        return [*node.decorator_list, *node.bases, *(keyword.value for keyword in node.keywords)]
    defaults = [*node.args.defaults, *(d for d in node.args.kw_defaults if d is not None)]
    return defaults if isinstance(node, ast.Lambda) else [*node.decorator_list, *defaults]


def imported_names(node: ast.Import | ast.ImportFrom) -> list[str]:
    """Returns the names that an import assigns."""
    return [(alias.asname or alias.name).split(".")[0] for alias in node.names]


def parameter_names(args: ast.arguments) -> set[str]:
    """Returns the names of a function's parameters."""
    every = [*args.posonlyargs, *args.args, *args.kwonlyargs, args.vararg, args.kwarg]
    return {a.arg for a in every if a is not None}


def stored_names(nodes: Iterable[ast.AST]) -> set[str]:
    """Returns the names that statements assign in their own scope, whatever the form of assignment."""
    return Names(nodes).own


def used_names(nodes: Iterable[ast.AST]) -> set[str]:
    """Returns every name that is read or assigned anywhere in the nodes."""
    return {part.id for node in nodes for part in ast.walk(node) if isinstance(part, ast.Name)}


def sees_variables(nodes: Iterable[ast.AST]) -> bool:
    """Returns whether statements mention, in their own scope, a builtin that sees the variables there."""
    return any(
        (isinstance(node, ast.Name) and node.id in SCOPE_BUILTINS)
        or sees_variables(
            outside(node)
            if isinstance(node, SCOPES)
            else [node.generators[0].iter]  # the rest of a comprehension is a scope of its own
            if isinstance(node, _COMPREHENSIONS)
            else ast.iter_child_nodes(node)
        )
        for node in nodes
    )


class Rebinder(ast.NodeTransformer):
    """Replaces every use of an assigned name by a use of the bound variables, so that they always contain its current value.

    Args:
        stored: The names the body assigns.
        own: Those among them that only the body's own scope sees.
    """

    def __init__(self, stored: set[str], own: AbstractSet[str] = frozenset()) -> None:
        self.stored = stored
        self._seen_by_functions = stored - own
        """The names that inner functions see; inside a class they differ from `stored` too."""

    def body(self, statements: Iterable[ast.stmt]) -> list[ast.stmt]:
        """Rewrites statements (in place) and returns them."""
        out: list[ast.stmt] = []
        for node in statements:
            made: Any = self.visit(node)
            out += cast("list[ast.stmt]", made) if isinstance(made, list) else [made]
        return out

    def _item(self, name: str, ctx: ast.expr_context, at: ast.AST) -> ast.Subscript:
        item = ast.Subscript(ast.Name(BOUND, ast.Load()), ast.Constant(name), ctx)
        return ast.fix_missing_locations(ast.copy_location(item, at))

    def _call(self, method: str, name: str | None, value: ast.expr, at: ast.AST) -> ast.Call:
        func = ast.Attribute(ast.Name(BOUND, ast.Load()), method, ast.Load())
        call = ast.Call(func, [value] if name is None else [ast.Constant(name), value], [])
        return ast.fix_missing_locations(ast.copy_location(call, at))

    def _sync(self, names: Iterable[str], at: ast.AST) -> list[ast.stmt]:
        """Returns statements that copy plainly assigned names to the bound variables."""
        out: list[ast.stmt] = []
        for name in names:
            if name in self.stored:
                assign = ast.Assign([self._item(name, ast.Store(), at)], ast.Name(name, ast.Load()))
                out.append(ast.fix_missing_locations(ast.copy_location(assign, at)))
        return out

    # -- plain uses

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return self._item(node.id, node.ctx, node) if node.id in self.stored else node

    def visit_NamedExpr(self, node: ast.NamedExpr) -> ast.expr:
        if node.target.id not in self.stored:
            return cast("ast.expr", self.generic_visit(node))
        return self._call("bind", node.target.id, cast("ast.expr", self.visit(node.value)), node)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST:
        self.generic_visit(node)
        if not isinstance(node.target, ast.Name):
            node.simple = 0
        return node

    def visit_Nonlocal(self, node: ast.Nonlocal) -> ast.AST:
        node.names = [name for name in node.names if name not in self.stored]
        return node if node.names else ast.copy_location(ast.Pass(), node)

    # -- scopes inside

    def _visit_all(self, nodes: Sequence[Any]) -> list[Any]:
        return [self.visit(node) for node in nodes]

    def _outside(self, node: Any) -> None:
        """Rewrites the parts of a function, lambda or class that are evaluated in the scope around it."""
        if isinstance(node, ast.ClassDef):
            node.bases = self._visit_all(node.bases)
            for keyword in node.keywords:
                keyword.value = self.visit(keyword.value)
        else:
            node.args.defaults = self._visit_all(node.args.defaults)
            node.args.kw_defaults = [d if d is None else self.visit(d) for d in node.args.kw_defaults]
        if not isinstance(node, ast.Lambda):
            node.decorator_list = self._visit_all(node.decorator_list)

    def _function_scope(self, hidden: set[str]) -> tuple[set[str], set[str]]:
        """Enters a function, and returns what `_leave` needs to leave it again."""
        before = self.stored, self._seen_by_functions
        self.stored = self._seen_by_functions = self._seen_by_functions - hidden
        return before

    def _leave(self, before: tuple[set[str], set[str]]) -> None:
        self.stored, self._seen_by_functions = before

    def visit_Lambda(self, node: ast.Lambda) -> Any:
        self._outside(node)
        before = self._function_scope(parameter_names(node.args) | Names([node.body]).own)
        node.body = self.visit(node.body)
        self._leave(before)
        return node

    def visit_FunctionDef(self, node: Any) -> Any:
        self._outside(node)
        names = Names(node.body)
        before = self._function_scope(parameter_names(node.args) | names.own | names.declared_global)
        node.body = self.body(node.body)
        self._leave(before)
        return [node, *self._sync([node.name], node)]

    visit_AsyncFunctionDef = visit_FunctionDef  # noqa: N815

    def visit_ClassDef(self, node: ast.ClassDef) -> Any:
        self._outside(node)
        names = Names(node.body)
        before = self.stored
        self.stored = self._seen_by_functions - names.own - names.declared_global
        node.body = self.body(node.body)
        self.stored = before
        return [node, *self._sync([node.name], node)]

    def _comprehension(self, node: Any) -> Any:
        first, *others = node.generators
        first.iter = self.visit(first.iter)  # evaluated in the scope around the comprehension
        targets = {n.id for g in node.generators for n in ast.walk(g.target) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        before = self._function_scope(targets)
        first.target = self.visit(first.target)
        first.ifs = self._visit_all(first.ifs)
        for part in others:
            self.generic_visit(part)
        for field in ("elt", "key", "value"):
            if hasattr(node, field):
                setattr(node, field, self.visit(getattr(node, field)))
        self._leave(before)
        return node

    visit_ListComp = visit_SetComp = visit_DictComp = visit_GeneratorExp = _comprehension  # noqa: N815

    # -- statements that can assign plain names only

    def visit_Import(self, node: ast.Import | ast.ImportFrom) -> Any:
        return [node, *self._sync(imported_names(node), node)]

    visit_ImportFrom = visit_Import  # noqa: N815

    def visit_TypeAlias(self, node: Any) -> Any:
        name = node.name.id
        node.value = self.visit(node.value)
        return [node, *self._sync([name], node)]

    def visit_ExceptHandler(self, node: ast.ExceptHandler) -> Any:
        self.generic_visit(node)
        if node.name:
            node.body[:0] = self._sync([node.name], node)
        return node

    def visit_Match(self, node: ast.Match) -> Any:
        """Rewrites a match statement; patterns can refer to a class or constant only by a plain name, so they get plain copies."""
        named = {n.id for case in node.cases for n in ast.walk(case.pattern) if isinstance(n, ast.Name) and n.id in self.stored}
        copies: list[ast.stmt] = []
        for name in sorted(named):
            assign = ast.Assign([ast.Name(name, ast.Store())], self._item(name, ast.Load(), node))
            copies.append(ast.fix_missing_locations(ast.copy_location(assign, node)))
        node.subject = self.visit(node.subject)
        for case in node.cases:
            captured = sorted(Names([case.pattern]).own & self.stored)
            case.body = self.body(case.body)
            if case.guard is not None:
                pairs = ast.Dict([ast.Constant(name) for name in captured], [ast.Name(name, ast.Load()) for name in captured])
                guard: ast.expr = self.visit(case.guard)
                case.guard = ast.BoolOp(ast.And(), [self._call("bind_all", None, pairs, guard), guard]) if captured else guard
                ast.fix_missing_locations(ast.copy_location(case.guard, guard))
            case.body[:0] = self._sync(captured, case.body[0])
        return [*copies, node]
