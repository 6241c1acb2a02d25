"""Finds the slots that chunks have now, and infers all that they can ever have, if a program's text contains them all."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable
from functools import lru_cache
from typing import Any, cast

from actr3d.actr.chunks.chunk import Slot, parse_slots
from actr3d.actr.chunks.pattern import by_variable
from actr3d.actr.declarative.memory import Memory
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.class_members import is_modellers
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.source_code import source_of, syntax_tree
from actr3d.actr.kernel.tree import TreeNode, subtree, top_of
from actr3d.actr.lint.slot_names import GIVERS, is_production
from actr3d.actr.modules.imaginal import ImaginalModule
from actr3d.actr.modules.motor import Motor
from actr3d.actr.modules.text import TextOutput
from actr3d.actr.modules.timer import Timer
from actr3d.actr.procedural.production import Production
from actr3d.actr.procedural.utility import ProceduralSubModule

_LIBRARIES = frozenset({"actr3d", "python_actr", "ccm", "__future__"})
_PLAIN = (Buffer, Memory, ImaginalModule, Motor, ProceduralSubModule, TextOutput, Timer)
"""Modules that put only chunks from the program's texts into buffers."""
_UNPREDICTABLE = frozenset(
    {
        "SOSVision",
        "Vision",
        "Chunk",
        "chunk",
        "dm",
        "eval",
        "exec",
        "getattr",
        "setattr",
        "vars",
        "globals",
        "locals",
        "__dict__",
        "__import__",
        "add_adaptor",
    }
)
"""Names through which chunks can be made or changed in ways that are not analysed here."""


def all_slots(production: Production) -> frozenset[Slot] | None:
    """Returns every slot that a chunk can ever have in the run of a production's program.

    None unless that is certain: the program is one file, its agents have only parts of the library that make no chunks of their
    own, and every chunk that is set or added is written as one literal text.
    """
    func = production.original_func
    if func.__module__ != "__main__" or func.__globals__.get("__file__") != func.__code__.co_filename:
        return None
    top = top_of(cast("TreeNode", production.system))
    for part in subtree(top):
        kind: type[Any] = part.__class__
        library = [klass for klass in kind.__mro__ if not is_modellers(klass)]
        if is_modellers(kind):
            if kind.__module__ != "__main__" or issubclass(library[0], _PLAIN):
                return None
        elif not isinstance(part, _PLAIN):
            return None
    return _literal_slots(source_of(func))


def slots_held(parts: Iterable[object]) -> set[Any]:
    """Returns the slots of the chunks that are in buffers and memories now, and those that a library sets in buffers."""
    found: set[Any] = set()
    for part in parts:
        if isinstance(part, Buffer):
            found.update(part.chunk or (), slots_of(type(part)))
        elif isinstance(part, Memory):
            for chunk in part.dm:
                found.update(chunk)
    return found


def slots_of(kind: type[Model]) -> frozenset[str]:
    """Returns the slots that a class of the library gives to chunks."""
    return kind._slots  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


@lru_cache(maxsize=16)
def _literal_slots(text: str) -> frozenset[Slot] | None:
    """Returns the slots of all literal texts that chunks are made from, or None if there may be others."""
    tree = syntax_tree(text)
    found: set[Slot] = set()
    called: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in (*GIVERS, "modify"):
            called.add(id(node.func))
            if not _is_plain(node, node.func.attr):
                return None
            for arg in node.args[:1]:
                assert isinstance(arg, ast.Constant)
                found.update(_slots(str(arg.value)))
    for node in ast.walk(tree):
        name = node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else None
        if name in _UNPREDICTABLE or (name in (*GIVERS, "modify") and isinstance(node, ast.Attribute) and id(node) not in called):
            return None
        if isinstance(node, ast.FunctionDef) and node.name in (*GIVERS, "modify", "request") and not is_production(node):
            return None
        if isinstance(node, ast.Import) and not all(_is_known(alias.name) for alias in node.names):
            return None
        if isinstance(node, ast.ImportFrom) and (node.level or not _is_known(node.module or "")):
            return None
    return None if any(map(by_variable, found)) else frozenset(found)


def _slots(text: str) -> list[Slot]:
    """Returns the slots of a chunk's text; a numbered slot may be meant by name, and a slot named by digits by number."""
    slots = [slot for slot, _ in parse_slots(text)]
    return [*slots, *(int(slot) for slot in slots if isinstance(slot, str) and slot.isdecimal()), *map(str, slots)]


def _is_plain(call: ast.Call, method: str) -> bool:
    """Returns whether a call's slots are certain: one literal text, or keywords of `modify`, which requires that the slots exist."""
    if method == "modify":
        return not call.args and all(keyword.arg for keyword in call.keywords)
    texts = [arg for arg in call.args[:1] if isinstance(arg, ast.Constant) and isinstance(arg.value, str)]
    return len(texts) == 1 and all(keyword.arg for keyword in call.keywords)


def _is_known(module: str) -> bool:
    """Returns whether a module belongs to the library or to Python, and so sets nothing by itself."""
    root = module.partition(".")[0]
    return root in _LIBRARIES or root in sys.stdlib_module_names
