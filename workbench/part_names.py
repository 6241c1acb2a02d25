"""The names that users see for what adds to the activation of a chunk."""

from __future__ import annotations

import re

from actr3d.actr.declarative.activation_parts import ACTIVATION_PARTS


def part_name(part: str) -> str:
    """Returns the name of a component of an activation; of several modules of one class, each has a number."""
    name = re.sub(r" \d+\Z", "", part)
    return ACTIVATION_PARTS.get(name, name) + part.removeprefix(name)
