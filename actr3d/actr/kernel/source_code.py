"""Finds the source of a modeller's functions, so that their bodies can be read and run as productions."""

from __future__ import annotations

import ast
import dis
import linecache
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import lru_cache
from importlib.machinery import SourceFileLoader
from pathlib import Path
from threading import Lock
from types import CodeType
from typing import Any, Literal

from actr3d.actr.kernel.log import LOG

SOURCE = "__actr3d_source__"
"""The global in which a module loaded from text keeps that text; another text may get the same name later."""


class FileName(str):
    """The name of one loaded text: it compares with other strings by its characters, but no two `FileName`s are equal.

    Tracebacks look up lines by a file's name, and two texts may have the same name; this keeps their lines apart.
    """

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        return self is other if isinstance(other, FileName) else str.__eq__(self, other)

    def __ne__(self, other: object) -> bool:
        return not self == other

    __hash__ = str.__hash__


def keep_lines(source: str, filename: FileName) -> None:
    """Provides a text's lines to tracebacks, until `drop_lines`."""
    linecache.cache.pop(filename, None)  # the lines of a file on disk with this name, which would be used for every text
    linecache.cache[filename] = (len(source), None, [f"{line}\n" for line in source.split("\n")], str(filename))


def drop_lines(filenames: Iterable[FileName]) -> None:
    """Removes the lines of texts."""
    for filename in filenames:
        linecache.cache.pop(filename, None)


_PARSING = Lock()


def parse(text: str, mode: Literal["exec", "eval"] = "exec") -> Any:
    """Returns the syntax tree of a text, as `ast.parse`, in one thread at a time.

    In several threads at once, `ast.parse` of Python 3.11 counts the depths of all of them as one and may raise a SystemError
    (https://github.com/python/cpython/issues/106905).

    Raises:
        SyntaxError: If the text is not Python.
        ValueError: If it has a NUL character.
        RecursionError: If it is nested too deeply.
        MemoryError: The same, for other texts.
    """
    with _PARSING:
        return ast.parse(text, mode=mode)


@lru_cache(maxsize=64)
def syntax_tree(text: str) -> ast.Module:
    """Parses a file's text; returns an empty tree if it is no longer Python (the file has changed since it was loaded)."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the compiler has issued all warnings about the file
            return parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], [])


@lru_cache(maxsize=64)
def _functions(text: str) -> dict[tuple[str, int], ast.FunctionDef]:
    """Returns every function of a file by its name and first line (that of its first decorator)."""
    found: dict[tuple[str, int], ast.FunctionDef] = {}
    for node in ast.walk(syntax_tree(text)):
        if isinstance(node, ast.FunctionDef):
            line = min([node.lineno, *(d.lineno for d in node.decorator_list)])
            found[node.name, line] = node
    return found


def function_node(func: Callable[..., Any]) -> ast.FunctionDef | None:
    """Returns the syntax tree of a function's definition, or None if its source is not available, or is not that of its code."""
    code, text = func.__code__, source_of(func)
    # A loaded text is that of the code; a file may have changed since its import. Other loaders may change the code.
    plain = SOURCE not in func.__globals__ and type(func.__globals__.get("__loader__")) is SourceFileLoader
    if plain and _content(code) not in _contents(text):
        return None
    return _functions(text).get((code.co_name, code.co_firstlineno))


@lru_cache(maxsize=64)
def _contents(text: str) -> frozenset[tuple[Any, ...]]:
    """Returns what every function of a file does."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = [compile(text, "", "exec", dont_inherit=True)]
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return frozenset()
    for code in found:
        found += [value for value in code.co_consts if isinstance(value, CodeType)]
    return frozenset(map(_content, found))


def _content(code: CodeType) -> tuple[Any, ...]:
    """Returns what code does and where it begins; without its tables of lines, which releases of one version of Python make differently."""
    constants: list[object] = [value for value in code.co_consts if not isinstance(value, CodeType)]
    kinds = tuple(type(value) for value in constants)
    return code.co_name, code.co_firstlineno, code.co_code, code.co_names, code.co_varnames, kinds, tuple(constants)


def source_of(func: Callable[..., Any]) -> str:
    """Returns the text of a function's file: the loaded text if this library loaded it, otherwise the current one."""
    names = func.__globals__
    filename = func.__code__.co_filename
    if SOURCE in names and names.get("__file__") == filename:
        return names[SOURCE]
    return "".join(linecache.getlines(filename, names))


def source_of_module(name: str) -> str:
    """Returns the text of a module's file as `source_of` does; empty if there is none."""
    module = sys.modules.get(name)
    names = {} if module is None else module.__dict__
    return names.get(SOURCE) or "".join(linecache.getlines(names.get("__file__") or "", names))


def with_filename(code: CodeType, filename: str) -> CodeType:
    """Returns code with another file name, also in the functions and classes inside it: code is made once for all files of one text."""
    if code.co_filename is filename:
        return code
    inner = tuple([with_filename(value, filename) if isinstance(value, CodeType) else value for value in code.co_consts])
    return code.replace(co_filename=filename, co_consts=inner)


def has_file(func: Callable[..., Any]) -> bool:
    """Returns whether the file of a function exists."""
    return Path(func.__code__.co_filename).is_file()


def location(func: Callable[..., Any]) -> tuple[str, int]:
    """Returns the file and the line of a function's definition."""
    return func.__code__.co_filename, func.__code__.co_firstlineno


def file_and_line(func: Callable[..., Any]) -> str:
    """Returns `file:line` of a function's definition."""
    return "{}:{}".format(*location(func))


def assigned_globals(func: Callable[..., Any]) -> set[str]:
    """Returns the names that a function declares global and assigns."""
    code = func.__code__
    if not _STORE_GLOBAL & set(code.co_code[::2]):
        return set()
    return {step.argval for step in dis.get_instructions(code) if step.opname == "STORE_GLOBAL"}


_STORE_GLOBAL = {dis.opmap["STORE_GLOBAL"]}


WRITTEN_FOR_PYTHON_ACTR = "__written_for_python_actr__"
"""The global that marks the module of a loaded model as importing python_actr or ccm by name."""


def for_python_actr(file: Mapping[str, Any]) -> bool:
    """Returns whether a file, given its globals, is part of a program that imports python_actr or ccm by name."""
    return LOG.announce or bool(file.get(WRITTEN_FOR_PYTHON_ACTR))


def written_for_python_actr(kind: type) -> bool:
    """Returns whether a class is part of such a program."""
    files = [sys.modules.get(klass.__module__) for klass in kind.__mro__]
    return LOG.announce or any(for_python_actr(vars(file)) for file in files if file is not None)


DYNAMIC = {"exec", "globals", "vars", "locals", "setattr"}
"""A text that uses one of these may define names that are not written in it."""


def last_name(node: ast.expr) -> str:
    """Returns a name without the names before its last dot; an empty text for any other expression."""
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def names_defined_in(tree: ast.AST) -> set[str] | None:
    """Returns all names that a text defines, in whatever scope; None if its code may define others."""
    nodes = list(ast.walk(tree))
    if any(isinstance(node, ast.Name) and node.id in DYNAMIC for node in nodes):
        return None
    return {name for node in nodes for name in _names_defined_by(node)}


def _names_defined_by(node: ast.AST) -> Iterator[str]:
    """Yields the names that a node defines."""
    match node:
        case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name) | ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
            yield name
        case ast.ClassDef(name=name):
            yield name
        case _ if type(node).__name__ in ("TypeVar", "ParamSpec", "TypeVarTuple"):  # Python 3.12 and later
            yield vars(node)["name"]
        case (
            ast.ExceptHandler(name=str(name))
            | ast.MatchAs(name=str(name))
            | ast.MatchStar(name=str(name))
            | ast.MatchMapping(rest=str(name))
        ):
            yield name
        case ast.Import() | ast.ImportFrom():
            for alias in node.names:
                yield alias.asname or alias.name.partition(".")[0]
        case ast.Global():
            yield from node.names
        case _:
            pass


def productions_inside(node: ast.FunctionDef, is_part: Callable[[str], bool]) -> Iterator[tuple[int, str]]:
    """Yields the line and a message for each function inside a method that looks like a production and is not used by the method.

    Args:
        node: The method.
        is_part: Returns whether the agent has a part of a name.
    """
    inside = [part for statement in node.body for part in ast.walk(statement)]
    read = {part.id for part in inside if isinstance(part, ast.Name)}
    for part in inside:
        if not isinstance(part, ast.FunctionDef) or part.name in read:
            continue
        names = [one.arg for one in part.args.args]
        if names and all(map(is_part, names)) and len(part.args.defaults) == len(names):
            what = f"'{part.name}' is inside it, and therefore no production; it needs the indentation of '{node.name}'"
            yield part.lineno, f"production '{node.name}': {what}"
