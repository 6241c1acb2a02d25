"""The names that a model file uses for slots, and which of them look misspelt."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import Any

from actr3d.actr.kernel.source_code import source_of, syntax_tree

_NAMED = re.compile(r"(?:^|\s)(\w+):(?:\S|$)")
_WORD = re.compile(r"[\w.-]+")
_COMPUTED = "\0"
"""Marks a computed value in an f-string's text."""
SURE = 0.74
"""The similarity to another name (0 to 1) from which a name counts as misspelt."""
READERS = ("request", "find_matching_chunks")
"""Methods whose text requests a chunk, and sets no slots."""
GIVERS = ("set", "add")
"""Methods whose text makes a chunk."""


class Vocabulary:
    """The names in a model file that are, or may become, slots, by their use.

    Args:
        tree: The file.
    """

    def __init__(self, tree: ast.AST) -> None:
        self.matched: set[str] = set()
        """Slots named in the patterns of productions."""
        self.asked: set[str] = set()
        """Slots named in the texts of requests."""
        self.given: set[str] = set()
        """Slots named in any other text."""
        self.modified: set[str] = set()
        """The keywords of `modify`."""
        self.mentioned: set[str] = set()
        """Everything else that may name a slot: keyword arguments, attributes, names, and texts of one word."""
        self.written: set[str] = set()
        """Every word that can become a slot or a value of a chunk: those of the texts outside patterns, requests and docstrings, keyword
        arguments, and names and attributes that are assigned."""
        self.together: list[set[str]] = []
        """Sets of slots that occur in one text."""
        self._alone = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        self._walk(tree, self.given)

    @property
    def giving(self) -> set[str]:
        """Every name that may become a slot of a chunk."""
        return self.given | self.modified | self.mentioned

    def apart(self, one: str, other: str) -> bool:
        """Returns whether no text contains both of two slots."""
        return not any(one in names and other in names for names in self.together)

    def _walk(self, node: ast.AST, texts: set[str]) -> None:
        """Collects the names in a node; slots named in its texts are added to `texts`."""
        text = text_of(node)
        if text is not None:
            names = set(slots_in(text))
            texts |= names
            if len(names) > 1:
                self.together.append(names)
            if texts is not self.matched and text.isidentifier():
                self.mentioned.add(text)
            if texts is self.given and id(node) not in self._alone:
                self.written.update(_WORD.findall(text))
        elif isinstance(node, (ast.Name, ast.Attribute)):
            name = node.id if isinstance(node, ast.Name) else node.attr
            self.mentioned.add(name)
            if isinstance(node.ctx, ast.Store):
                self.written.add(name)
        elif isinstance(node, ast.keyword) and node.arg:
            self.mentioned.add(node.arg)
            self.written.add(node.arg)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            self._call(node, node.func, texts)
            return
        for child in ast.iter_child_nodes(node):
            if isinstance(node, ast.FunctionDef) and child is node.args and is_production(node):
                for default in node.args.defaults:
                    self._pattern(default)
            else:
                self._walk(child, texts)

    def _call(self, node: ast.Call, func: ast.Attribute, texts: set[str]) -> None:
        self._walk(func, texts)
        for arg in node.args:
            self._walk(arg, self.asked if func.attr in READERS else texts)
        for keyword in node.keywords:
            if func.attr == "modify" and keyword.arg:
                self.modified.add(keyword.arg)
                self.written.add(keyword.arg)
                self._walk(keyword.value, texts)
            elif func.attr in READERS and keyword.arg:
                self.mentioned.add(keyword.arg)
                self._walk(keyword.value, texts)
            else:
                self._walk(keyword, texts)

    def _pattern(self, node: ast.AST) -> None:
        """Collects the slots of a pattern, which are named only by its texts and a dict's keys."""
        for part in ast.walk(node):
            names = set(slots_in(text_of(part) or ""))
            if isinstance(part, ast.Dict):
                names = {key.value for key in part.keys if isinstance(key, ast.Constant) and isinstance(key.value, str)}
            self.matched |= names
            self.together.append(names)


def vocabulary(func: Callable[..., Any]) -> Vocabulary:
    """Returns the names used in the file of a function."""
    return _vocabulary(source_of(func))


@lru_cache(maxsize=16)
def _vocabulary(text: str) -> Vocabulary:
    return Vocabulary(syntax_tree(text))


def is_production(node: ast.FunctionDef) -> bool:
    """Returns whether all parameters of a function have a default."""
    return len(node.args.args) == len(node.args.defaults)


def text_of(node: ast.AST) -> str | None:
    """Returns a text as written in the source, with a mark for each computed value; None if the node is not text."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(str(part.value) if isinstance(part, ast.Constant) else _COMPUTED for part in node.values)
    return None


def slots_in(text: str) -> list[str]:
    """Returns the named slots of a chunk's or a pattern's text."""
    return _NAMED.findall(text)


def misspelling_of(name: str, known: Iterable[str]) -> str | None:
    """Returns the known name of which `name` looks like a misspelling."""
    return next((other for other in sorted(known) if is_misspelt(name, other)), None)


def is_misspelt(one: str, other: str) -> bool:
    """Returns whether two names differ by one typing error: a letter too many, too few or wrong, two exchanged, or capitals.

    Deliberately similar names do not count: `num1` and `num2`, `left_x` and `left_y`, `word` and `words`, `height` and
    `weight`; nor do names of fewer than four letters.
    """
    if one == other or min(len(one), len(other)) < 4:
        return False
    if one.casefold() == other.casefold():
        return True
    start = 0
    while start < min(len(one), len(other)) and one[start] == other[start]:
        start += 1
    end = 0
    while end < min(len(one), len(other)) - start and one[-1 - end] == other[-1 - end]:
        end += 1
    middle, changed = one[start : len(one) - end], other[start : len(other) - end]
    if not (middle + changed).isalpha():
        return False
    if len(middle) == 2:
        return middle == changed[::-1]
    # Changes at the ends of a name, and of a single letter in it, are deliberate.
    alone = not (one[start - 1 : start].isalpha() and one[len(one) - end :][:1].isalpha())
    return len(middle) <= 1 and len(changed) <= 1 and not alone and len(one) + len(other) >= 9
