"""Which slots chunks can have: a run that waits for a chunk with any other slot waits for ever."""

from __future__ import annotations

import ast
import inspect
import re
import sys
from collections.abc import Iterable
from contextlib import suppress
from itertools import pairwise
from pathlib import Path

from actr3d.actr.chunks.pattern import parse
from actr3d.actr.kernel.source_code import syntax_tree
from actr3d.errors import Actr3dError, did_you_mean

LIBRARY = "actr3d."
"""What the names of the library's modules begin with; their chunks may have any slot that the texts of the package name."""
_WORD = re.compile(r"[^\W\d]\w*")
_SLOT = re.compile(r"(?<![\w?])([^\W\d]\w*):(?=\S)")
MOST_TOLD = 12


def check_slots(pattern: str, sources: Iterable[str], modules: Iterable[str], folder: str = "") -> None:
    """Checks that a chunk can have the slots that a pattern names. What is only computed cannot be known, and is let through.

    Args:
        pattern: The pattern.
        sources: The texts of the model.
        modules: The names of the Python modules from which its parts come.
        folder: Where its helper modules are; an empty text for nowhere.

    Raises:
        Actr3dError: If there is one that no text of the model names; with what is like it.
    """
    wanted = {slot for slot, _, _ in parse(pattern) if isinstance(slot, str)}
    sources = [*sources, *_helpers(folder)]
    texts = [*sources, *_texts(modules)]
    unknown = wanted.difference(*(_WORD.findall(text) for text in texts)) if wanted else set[str]()
    if not unknown or any(_computes_slots(text) for text in sources):
        return
    own, all_slots = (sorted({slot for text in given for slot in _slots(text)}) for given in (sources, texts))
    for slot in sorted(unknown):
        more = f" and {len(own) - MOST_TOLD} more" if len(own) > MOST_TOLD else ""
        there = f"; there are: {', '.join(own[:MOST_TOLD])}{more}" if own else "; its chunks have no named slots"
        near = did_you_mean(slot, own) or did_you_mean(slot, all_slots)
        raise Actr3dError(f"no chunk of this model can have a slot '{slot}'{near or there}")


def _texts(modules: Iterable[str]) -> Iterable[str]:
    """Yields the texts of modules; of one of the library those of its whole package, for what its chunks hold is named elsewhere."""
    names = set(modules)
    packages = {".".join(name.split(".")[:2]) for name in names if name.startswith(LIBRARY)}
    for name, module in list(sys.modules.items()):
        if name in names or any(name == package or name.startswith(f"{package}.") for package in packages):
            with suppress(OSError, TypeError):  # a model of which there is no file; its text is known otherwise
                yield inspect.getsource(module)


def _helpers(folder: str) -> Iterable[str]:
    """Yields the texts of the helper modules that have been loaded from a folder."""
    for module in list(sys.modules.values()):
        file = getattr(module, "__file__", None)
        if folder and isinstance(file, str) and Path(file).is_relative_to(folder):
            with suppress(OSError, TypeError):
                yield inspect.getsource(module)


def _slots(text: str) -> set[str]:
    """Returns the slots that the patterns and chunks of a text name."""
    with suppress(SyntaxError, ValueError, RecursionError):
        nodes = ast.walk(syntax_tree(text))
        texts = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str) and "\n" not in node.value]
        return {slot for each in texts for slot in _SLOT.findall(each)}
    return set()


def _computes_slots(text: str) -> bool:
    """Tells whether a text makes names of slots, as by `f"{name}:{value}"`."""
    with suppress(SyntaxError, ValueError, RecursionError):
        for node in ast.walk(syntax_tree(text)):
            parts = node.values if isinstance(node, ast.JoinedStr) else []
            if any(_names_slot(part, after) for part, after in pairwise(parts)):
                return True
    return False


def _names_slot(part: ast.expr, after: ast.expr) -> bool:
    return isinstance(part, ast.FormattedValue) and isinstance(after, ast.Constant) and str(after.value).startswith(":")
