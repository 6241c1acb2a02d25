"""Checks the slots in a pattern: a run that waits for a chunk with a slot that no chunk can have would wait forever."""

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
from actr3d.actr.lint.slot_names import Vocabulary
from actr3d.errors import Actr3dError, did_you_mean
from workbench.worker.names import there_are

LIBRARY = "actr3d."
"""The prefix of the library's module names; chunks of its modules may have any slot that is named in the text of their package."""
_WORD = re.compile(r"[^\W\d]\w*")
_SLOT = re.compile(r"(?<![\w?])([^\W\d]\w*):(?=\S)")
STATES = {"busy", "error"}
"""States of modules, which patterns match too; no chunk of the library has such slots."""


def check_slots(pattern: str, sources: Iterable[str], modules: Iterable[str], folder: str = "") -> None:
    """Checks that chunks can have the slots that a pattern names. Slot names that are computed are unknown, so the check then passes.

    Args:
        pattern: The pattern.
        sources: The texts of the model.
        modules: The names of the Python modules from which chunks may come, besides the model's own text.
        folder: The folder of its helper modules; an empty text for none.

    Raises:
        Actr3dError: If no text of the model names a slot; the message lists similar names.
    """
    wanted = {slot for slot, _, _ in parse(pattern) if isinstance(slot, str)}
    sources = [*sources, *_helpers(folder)]
    library = list(_texts(modules))
    given = [_given(text) for text in sources]
    known = [*given, *({*_WORD.findall(text)} - STATES for text in library)]
    unknown = wanted.difference(*known) if wanted else set[str]()
    if not unknown or any(_computes_slots(text) for text in sources):
        return
    own = sorted({slot for text, words in zip(sources, given, strict=True) for slot in _slots(text) if slot in words})
    all_slots = sorted({*own, *(slot for text in library for slot in _slots(text))} - STATES)
    for slot in sorted(unknown):
        there = there_are(own) if own else "; its chunks have no named slots"
        near = did_you_mean(slot, own) or did_you_mean(slot, all_slots)
        raise Actr3dError(f"no chunk of this model can have a slot '{slot}'{near or there}")


def _given(text: str) -> set[str]:
    """Returns every name that the code of a text may make a slot; all its words if it is nested too deeply."""
    try:
        return Vocabulary(syntax_tree(text)).giving
    except RecursionError:
        return {*_WORD.findall(text)}


def _texts(modules: Iterable[str]) -> Iterable[str]:
    """Yields the texts of modules; for a library module, those of its whole package, as slots may be named elsewhere in it."""
    names = set(modules)
    packages = {".".join(name.split(".")[:2]) for name in names if name.startswith(LIBRARY)}
    for name, module in list(sys.modules.items()):
        if name in names or any(name == package or name.startswith(f"{package}.") for package in packages):
            with suppress(OSError, TypeError):  # a model without a file; its text is among the sources
                yield inspect.getsource(module)


def _helpers(folder: str) -> Iterable[str]:
    """Yields the texts of the helper modules that have been loaded from a folder."""
    for module in list(sys.modules.values()):
        file = getattr(module, "__file__", None)
        if folder and isinstance(file, str) and Path(file).is_relative_to(folder):
            with suppress(OSError, TypeError):
                yield inspect.getsource(module)


def _slots(text: str) -> set[str]:
    """Returns the slots that are named in the patterns and chunks of a text."""
    nodes = ast.walk(syntax_tree(text))
    texts = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str) and "\n" not in node.value]
    return {slot for each in texts for slot in _SLOT.findall(each)}


def _computes_slots(text: str) -> bool:
    """Returns whether a text computes slot names, for example by `f"{name}:{value}"`."""
    strings = (node for node in ast.walk(syntax_tree(text)) if isinstance(node, ast.JoinedStr))
    return any(_names_slot(part, after) for string in strings for part, after in pairwise(string.values))


def _names_slot(part: ast.expr, after: ast.expr) -> bool:
    return isinstance(part, ast.FormattedValue) and isinstance(after, ast.Constant) and str(after.value).startswith(":")
