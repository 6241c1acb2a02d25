"""What a recording is told of a simulation before it begins, with the source of its models."""

from __future__ import annotations

import linecache
import sys
from collections.abc import Iterable, Mapping
from typing import Any

from actr3d.actr.kernel.source_code import SOURCE
from actr3d.errors import RecordingError
from actr3d.recording.form import OWN_FACTS


def sources_of(factories: Iterable[Any]) -> dict[str, str]:
    """Returns the text of every file that factories of minds are written in, by its name; without those that have none."""
    found: dict[str, str] = {}
    for factory in factories:
        module = sys.modules.get(getattr(factory, "__module__", ""))
        name = getattr(module, "__file__", None)
        if module is not None and name is not None and name not in found:
            text = module.__dict__.get(SOURCE) or "".join(linecache.getlines(name))
            if text:
                found[name] = text
    return found


def told_facts(own: Mapping[str, Any], given: Mapping[str, Any], factories: Iterable[Any]) -> dict[str, Any]:
    """Returns the facts of a simulation: what it tells of itself, what else its user tells, and the source of its minds.

    Raises:
        RecordingError: If the user tells what is not the user's to tell.
    """
    if taken := sorted({*own, *OWN_FACTS} & given.keys()):
        raise RecordingError(f"a recording tells '{taken[0]}' by itself; give that fact another name")
    return {"kind": "simulation", **own, **given, "sources": given.get("sources") or sources_of(factories)}
