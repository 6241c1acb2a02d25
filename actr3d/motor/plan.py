"""The posture that an agent plans, for observers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A posture that an agent plans, and a text about the expected result.

    An agent that has a method `planned`, which returns its plan or None, shows it in the workbench's 3D view: the posture as a
    translucent copy of the body, the text as a label above it. The method changes nothing, and draws no random numbers.
    """

    posture: Mapping[str, float] = field(default_factory=dict[str, float])
    """The angles of joints [degrees], or positions of slides [m]; joints that are not named stay as they are."""
    text: str = ""
    """One line, or a few."""
