"""Which overlays a session's 3D view shows: the same for all who watch. From where it is seen each browser chooses for itself."""

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
"""What overlays are called, in their order."""


@dataclass(frozen=True)
class Look:
    """Which overlays are shown."""

    shown: frozenset[say.OverlayName] = frozenset({"features", "path", "contacts"})

    def after(self, said: say.Overlay) -> Look:
        """Returns what is shown after a command."""
        return replace(self, shown=self.shown | {said.name} if said.shown else self.shown - {said.name})

    def told(self) -> dict[str, Any]:
        """Returns what pages are told: `overlays`, each with `name`, `title` and whether it is `shown`."""
        return {"overlays": [{"name": name, "title": title, "shown": name in self.shown} for name, title in TITLES.items()]}
