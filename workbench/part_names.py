"""The names that users see for what adds to the activation of a chunk."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType

NAMES: Mapping[str, str] = MappingProxyType(
    {
        "DMBaseLevel": "base level",
        "DMFixed": "fixed",
        "DMSpreading": "spreading",
        "DMSalience": "salience",
        "DMAssociate": "association",
        "DMInhibition": "inhibition",
        "DMNoise": "noise",
        "partial": "partial match",
    }
)
"""The names of the components that library modules add, by the class of the module."""
_NUMBERED = re.compile(r"(.*?)( \d+)?", re.DOTALL)


def part_name(part: str) -> str:
    """Returns the name of a component of an activation; of several modules of one class, each has a number."""
    found = _NUMBERED.fullmatch(part)
    name, number = found.groups("") if found else (part, "")
    return NAMES.get(name, name) + number
