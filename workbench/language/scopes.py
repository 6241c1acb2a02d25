"""Finds the scope of each plain name of a Python text, by Python's own rules."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any, cast

from parso.grammar import load_grammar

from actr3d.actr.lint.slot_names import GIVERS, READERS

Scope = tuple[str, str, tuple[int, int]]
"""The kind of a scope, its name, and where it begins."""
_COMPREHENSIONS = ("comp_for", "sync_comp_for")
_BY_NAME = ("getattr", "setattr", "hasattr", "delattr", "vars")
_FUNCTIONS = ("funcdef", "lambdef")


class Scopes:
    """The scopes of a text: the module, its classes, functions and comprehensions."""

    def __init__(self, code: str) -> None:
        self._module: Any = cast("Any", load_grammar()).parse(code)
        self._leaves: dict[tuple[int, int], Any] = {leaf.start_pos: leaf for leaf in _leaves(self._module) if leaf.type == "name"}
        self._bound: dict[int, dict[str, Any]] = {}
        """For each scope, its names, and where each is bound first."""
        self._passed: dict[int, dict[str, bool]] = {}
        """For each function, the names of `global` (True) and `nonlocal` (False) in it."""
        for leaf in self._leaves.values():
            if leaf.parent.type in ("global_stmt", "nonlocal_stmt"):
                self._passed.setdefault(id(self._around(leaf)[0]), {})[leaf.value] = leaf.parent.type == "global_stmt"
        for leaf in self._leaves.values():
            if _is_plain(leaf) and not _is_import_path(leaf) and leaf.is_definition():
                self._bind(leaf)

    def of(self, place: tuple[int, int]) -> Scope | None:
        """Returns the scope of the plain name at a line and column; None if the text does not define it.

        Returns:
            Its kind (`module`, `class` or `function`, which comprehensions are, too), its name, with those of the classes around it for a
            class, and where it begins.
        """
        leaf = self._leaves.get(place)
        scope = None if leaf is None or _is_import_path(leaf) else self._scope(leaf)
        if scope is None:
            return None
        if scope.type == "classdef":
            return "class", ".".join(_classes(scope)), scope.start_pos
        name = scope.name.value if scope.type == "funcdef" else ""
        return ("module" if scope is self._module else "function"), name, scope.start_pos

    def is_definition(self, place: tuple[int, int]) -> bool:
        """Returns whether a value is given to the name at a line and column."""
        leaf = self._leaves.get(place)
        return leaf is not None and bool(leaf.is_definition())

    def is_made_by_call(self, place: tuple[int, int]) -> bool:
        """Returns whether the value that is given to the name at a line and column is that of one call: `eyes = Eyes(visual)`."""
        leaf = self._leaves.get(place)
        definition = None if leaf is None else leaf.get_definition()
        value = None if definition is None or definition.type != "expr_stmt" else definition.children[-1]
        return (
            value is not None
            and value.type == "atom_expr"
            and value.children[-1].type == "trailer"
            and value.children[-1].children[0] == "("
        )

    def may_name_member(self, place: tuple[int, int]) -> bool:
        """Returns whether the text at a line and column may name a member: `attrgetter("ink")`; no value in a chunk, key or test."""
        node = self._module.get_leaf_for_position(place)
        while node is not None and node.type in ("string", "argument", "arglist", "atom", "testlist_comp"):
            node = node.parent
        if node is None or node.type in ("comparison", "dictorsetmaker", "subscriptlist"):
            return False
        if node.type != "trailer":
            return True
        return node.children[0] == "(" and node.get_previous_leaf().value not in (*GIVERS, *READERS, "modify")

    def is_printed(self, place: tuple[int, int]) -> bool:
        """Returns whether the text at a line and column is as such given to `print`."""
        leaf = self._module.get_leaf_for_position(place)
        given = None if leaf is None else leaf.parent if leaf.parent.type != "arglist" else leaf.parent.parent
        return given is not None and given.type == "trailer" and given.get_previous_leaf().value == "print"

    def function_with_parameter(self, place: tuple[int, int]) -> str | None:
        """Returns the name of the function of which the plain name at a line and column is a parameter, empty for a `lambda`; else None."""
        if self._type_of_binding(place) != "param":
            return None
        scope = self._scope(self._leaves[place])
        return str(scope.name.value) if scope.type == "funcdef" else ""

    def is_parameter_of_decorated(self, place: tuple[int, int]) -> bool:
        """Returns whether the plain name at a line and column is a parameter of a function with a decorator, which may pass it on."""
        return self._type_of_binding(place) == "param" and self._scope(self._leaves[place]).parent.type == "decorated"

    def is_function_or_class(self, place: tuple[int, int]) -> bool:
        """Returns whether the plain name at a line and column is that of a function or class, defined, imported, or Python's own."""
        return self._type_of_binding(place) in ("funcdef", "classdef", "import_name", "import_from", "")

    def _type_of_binding(self, place: tuple[int, int]) -> str:
        """Returns by what kind of statement or parameter a plain name is bound first; empty if the text does not bind it."""
        leaf = self._leaves.get(place)
        scope = None if leaf is None else self._scope(leaf)
        definition = None if leaf is None or scope is None else self._bound[id(scope)][leaf.value].get_definition()
        return "" if definition is None else str(definition.type)

    @cached_property
    def called_with_names(self) -> set[str]:
        """The functions and classes that are called with computed names, as in `f(**values)`; empty for one that is not known."""
        stars = (
            leaf for leaf in _leaves(self._module) if leaf.type == "operator" and leaf.value == "**" and leaf.parent.type == "argument"
        )
        called = (leaf.search_ancestor("trailer", "classdef", "decorator").get_first_leaf().get_previous_leaf() for leaf in stars)
        return {leaf.value if leaf.type == "name" and self._is_called_itself(leaf) else "" for leaf in called}

    @cached_property
    def asked_by_name(self) -> list[tuple[int, int]]:
        """Where the expressions end of which attributes are asked for by computed names, as in `getattr(one, name)`."""
        calls = (leaf.get_next_sibling() for leaf in self._leaves.values() if leaf.value in _BY_NAME)
        given = (call.children[1] for call in calls if call is not None and call.type == "trailer" and call.children[0] == "(")
        computed = (one for one in given if one.type != "arglist" or one.children[2].type != "string")
        return [(one.children[0] if one.type == "arglist" else one).get_last_leaf().end_pos for one in computed]

    def _is_called_itself(self, leaf: Any) -> bool:
        """Returns whether a name that is called is that of an attribute, a function or a class, and no variable."""
        return not _is_plain(leaf) or self.is_function_or_class(leaf.start_pos)

    def is_import_path(self, place: tuple[int, int]) -> bool:
        """Returns whether the name at a line and column is that of another text: of a module, or of what is imported from it."""
        leaf = self._leaves.get(place)
        return leaf is not None and _is_import_path(leaf)

    def _bind(self, leaf: Any) -> None:
        scopes = self._around(leaf)
        definition = leaf.get_definition()
        if definition is not None and definition.type == "namedexpr_test":
            scopes = [scope for scope in scopes if scope.type not in (*_COMPREHENSIONS, "classdef")]
        passed = self._passed.get(id(scopes[0]), {}).get(leaf.value)
        if passed is False:  # the function around it binds the name itself
            return
        scope = self._module if passed else scopes[0]
        self._bound.setdefault(id(scope), {}).setdefault(leaf.value, leaf)

    def _scope(self, leaf: Any) -> Any:
        """Returns the scope that a name belongs to; None if no scope binds it."""
        scopes = self._around(leaf)
        for number, scope in enumerate(scopes):
            passed = self._passed.get(id(scope), {}).get(leaf.value)
            if passed:
                return self._module
            bound = self._bound.get(id(scope), {}).get(leaf.value)
            if bound is None or passed is False:
                continue
            if scope.type == "classdef" and (number > 0 or leaf.start_pos < bound.start_pos or _is_value(leaf, bound)):
                continue  # a class passes its names on to no function, and until it binds a name, that of a scope around it counts
            if scope is self._module and _is_read_before(leaf, bound, scopes[:number]):
                return None  # it is still that of Python, or of `from module import *`
            return scope
        return None

    def _around(self, leaf: Any) -> list[Any]:
        """Returns the scopes around a name, nearest first."""
        found: list[Any] = []
        child, node = leaf, leaf.parent
        while node is not None:
            if node.type in _FUNCTIONS:
                if _is_inside_function(node, child, leaf):
                    found.append(node)
            elif node.type == "classdef":
                if child is node.children[-1]:
                    found.append(node)
            elif node.children[-1].type in _COMPREHENSIONS and node.type not in _COMPREHENSIONS:
                comprehension = node.children[-1]
                first = comprehension.children[-1] if comprehension.type == "comp_for" else comprehension
                iterable = first.children[3]
                if not (iterable.start_pos <= leaf.start_pos < iterable.end_pos):
                    found.append(comprehension)
            child, node = node, node.parent
        return [*found, self._module]


def _leaves(node: Any) -> Iterator[Any]:
    """Yields the leaves of a tree."""
    if not hasattr(node, "children"):
        yield node
    for child in getattr(node, "children", ()):
        yield from _leaves(child)


def _classes(node: Any) -> list[str]:
    """Returns the names of the classes around a node, outermost first, and its own."""
    own = [str(node.name.value)] if node.type == "classdef" else []
    return own if node.parent is None else [*_classes(node.parent), *own]


def _is_plain(leaf: Any) -> bool:
    """Returns whether a name is neither an attribute nor that of an argument."""
    before, parent = leaf.get_previous_leaf(), leaf.parent
    is_argument = parent.type == "argument" and parent.children[0] is leaf and parent.children[1] == "="
    return (
        not (before is not None and before.type == "operator" and before.value == "." and parent.type != "import_from") and not is_argument
    )


def _is_import_path(leaf: Any) -> bool:
    """Returns whether a name in an import binds nothing here."""
    node = leaf.parent
    while node.type in ("dotted_name", "dotted_as_name", "dotted_as_names", "import_as_name", "import_as_names"):
        node = node.parent
    return node.type in ("import_name", "import_from") and leaf not in node.get_defined_names()


def _is_inside_function(function: Any, child: Any, leaf: Any) -> bool:
    """Returns whether a name belongs inside of a function, in whose child it stands: not its own name, defaults or annotations."""
    if child is function.children[-1]:
        return True
    node = leaf.parent
    while node is not function and node.type != "param":
        node = node.parent
    return node.type == "param" and node.name is leaf


def _is_read_before(leaf: Any, bound: Any, inside: list[Any]) -> bool:
    """Returns whether a module reads a name before it binds it first: in no function, which may run later, and in no loop."""
    if any(scope.type in _FUNCTIONS for scope in inside) or leaf.search_ancestor("for_stmt", "while_stmt"):
        return False
    return leaf.start_pos < bound.start_pos or _is_value(leaf, bound)


def _is_value(leaf: Any, bound: Any) -> bool:
    """Returns whether a name is read by the statement that binds it first."""
    statement = bound.get_definition()
    return leaf is not bound and statement.type == "expr_stmt" and statement.start_pos <= leaf.start_pos < statement.end_pos
