"""The slots that a model file gives values to, as far as its text tells."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import Any

from actr3d.actr.sources import source_of, syntax_tree

_NAMED = re.compile(r"(?:^|\s)(\w+):\S")


def slots_given(func: Callable[..., Any]) -> set[str]:
    """Returns every name in the file of a function that may become a slot of a chunk: named slots in texts, keyword
    arguments, keys of dicts, attributes, and names that are assigned; patterns of productions do not count.
    """
    return set(_given(source_of(func)))


def slots_named(func: Callable[..., Any]) -> set[str]:
    """Returns the names in the file of a function that texts show to be slots: what may have been meant by another."""
    return set(_named(source_of(func)))


@lru_cache(maxsize=16)
def _named(text: str) -> frozenset[str]:
    nodes = _outside_patterns(syntax_tree(text))
    texts = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    return frozenset(name for text in texts for name in _NAMED.findall(text))


@lru_cache(maxsize=16)
def _given(text: str) -> frozenset[str]:
    found: set[str] = set()
    for node in _outside_patterns(syntax_tree(text)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            found.update(_NAMED.findall(node.value))
            if node.value.isidentifier():
                found.add(node.value)
        elif isinstance(node, ast.JoinedStr):
            texts = [part.value if isinstance(part, ast.Constant) else "x" for part in node.values]
            found.update(_NAMED.findall("".join(map(str, texts))))
        elif isinstance(node, ast.keyword) and node.arg:
            found.add(node.arg)
        elif isinstance(node, ast.Attribute):
            found.add(node.attr)
        elif isinstance(node, ast.Name):
            found.add(node.id)
    return frozenset(found)


def _outside_patterns(node: ast.AST) -> Iterator[ast.AST]:
    """Yields every node but the defaults of functions all of whose parameters have one."""
    yield node
    for child in ast.iter_child_nodes(node):
        if isinstance(node, ast.FunctionDef) and child is node.args and len(node.args.args) == len(node.args.defaults):
            continue
        yield from _outside_patterns(child)
