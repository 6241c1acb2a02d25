"""Checks the names in patterns of buffers into which a module puts what it finds: kinds of things, and the slots of their chunks."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from actr3d.actr.chunks.chunk import Slot
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tree import subtree
from actr3d.actr.lint.slot_names import SURE
from actr3d.actr.modules.port import Searching, kinds_put_into
from actr3d.errors import did_you_mean

KIND = "feature"
"""The slot that names the kind of thing."""
Kinds = Mapping[str, Collection[str]]
"""The kinds of things that can be found, with the slots of their chunks besides `feature`."""


def kinds_in(buffer: Buffer, agent: Model) -> dict[str, Collection[str]]:
    """Returns the kinds of things whose chunks modules put into a buffer; none if other modules of the agent fill it, too."""
    found: dict[str, Collection[str]] = {}
    for part in subtree(agent):
        if isinstance(part, Searching):
            found.update(kinds_put_into(buffer, part))
        elif part.__dict__.get("_buffer") is buffer:
            return {}
    return found


def wrong_names(tests: Iterable[tuple[Slot, str, Any]], kinds: Kinds, own: Collection[Any]) -> dict[str, str]:
    """Returns the names in a pattern that look like misspelt kinds of things or slots, with what is wrong with each.

    Args:
        tests: Slot, operation or sign, and word of each test of the pattern.
        kinds: What modules put into its buffer.
        own: The names that the model itself may give to slots and kinds.
    """
    tests = [test for test in tests if isinstance(test[0], str)]
    found = {word: wrong_kind(word, kinds, own) for slot, sign, word in tests if slot == KIND and sign in ("is", "not")}
    asked = sorted({word for slot, sign, word in tests if slot == KIND and sign == "is"})
    if kinds.keys() >= {*asked}:
        known = {KIND}.union(*(kinds[kind] for kind in asked or kinds))
        whose = f"the feature '{asked[0]}'" if asked else "a feature"
        for slot in dict.fromkeys(str(slot) for slot, _, _ in tests):
            if slot[:1] not in ("", "?") and "." not in slot and slot not in known and slot not in own:
                hint = did_you_mean(slot, known)
                found[slot] = hint and f"no chunk of {whose} has a slot '{slot}'{hint}"
    return {name: wrong for name, wrong in found.items() if wrong}


def wrong_kind(word: str, kinds: Kinds, own: Collection[Any]) -> str:
    """Returns what is wrong with the name of a kind of things; an empty text if it is known, or is not similar to a known one."""
    hint = "" if word in kinds or word in own else did_you_mean(word, kinds, SURE)
    return hint and f"nothing finds a feature '{word}'{hint}"
