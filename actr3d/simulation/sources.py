"""The source of models, for a recording."""

from __future__ import annotations

import linecache
import sys
from collections.abc import Iterable
from typing import Any

from actr3d.actr.sources import SOURCE


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
