"""Stores which overlays a session's 3D view shows. They are the same for all who watch; each browser chooses its own camera."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from workbench import protocol as say

TITLES: dict[say.OverlayName, str] = {
    "frustum": "field of view",
    "edges": "edges seen",
    "features": "obstacles and openings",
    "path": "path walked",
    "posture": "planned posture",
    "contacts": "contacts",
}
"""The titles of the overlays, in the order of the menu."""


@dataclass(frozen=True)
class Look:
    """Holds the set of overlays that are shown."""

    shown: frozenset[say.OverlayName] = frozenset({"features", "path", "contacts"})

    def after(self, said: say.Overlay) -> Look:
        """Returns the overlays that are shown after a command."""
        return replace(self, shown=self.shown | {said.name} if said.shown else self.shown - {said.name})

    def told(self) -> dict[str, Any]:
        """Returns the entry for pages: `overlays`, each with `name`, `title` and whether it is `shown`."""
        return {"overlays": [{"name": name, "title": title, "shown": name in self.shown} for name, title in TITLES.items()]}
