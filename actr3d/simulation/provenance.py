"""The facts of a simulation for its recording, with the source text of its models."""

from __future__ import annotations

import linecache
import sys
from collections.abc import Iterable, Mapping
from typing import Any

from actr3d.actr.kernel.source_code import SOURCE
from actr3d.errors import RecordingError
from actr3d.recording.form import OWN_FACTS


def sources_of(factories: Iterable[Any]) -> dict[str, str]:
    """Returns by name the text of every file that defines agents; files without text are left out."""
    found: dict[str, str] = {}
    for factory in factories:
        module = sys.modules.get(getattr(factory, "__module__", ""))
        name = getattr(module, "__file__", None)
        if module is not None and name is not None and name not in found:
            text = module.__dict__.get(SOURCE) or "".join(linecache.getlines(name))
            if text:
                found[name] = text
    return found


def facts_of(own: Mapping[str, Any], given: Mapping[str, Any], factories: Iterable[Any]) -> dict[str, Any]:
    """Returns the facts of a simulation: its own, those of its user, and the source of its agents.

    Raises:
        RecordingError: If the user gives a fact that a recording sets itself.
    """
    if taken := sorted({*own, *OWN_FACTS} & given.keys()):
        raise RecordingError(f"a recording sets '{taken[0]}' itself; give that fact another name")
    return {"kind": "simulation", **own, **given, "sources": given.get("sources") or sources_of(factories)}
