"""How a session's 3D view is looked at: which overlays are shown, and from where it is seen; the same for all who watch."""

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
VIEWS: tuple[say.CameraView, ...] = ("free", "follow", "eye", "top")


@dataclass(frozen=True)
class Look:
    """Which overlays are shown, and from where the scene is seen."""

    shown: frozenset[say.OverlayName] = frozenset({"frustum", "features", "path", "contacts"})
    camera: say.CameraView = "free"

    def after(self, said: say.Overlay | say.Camera) -> Look:
        """Returns how it is looked at after something was said."""
        if isinstance(said, say.Camera):
            return replace(self, camera=said.view)
        return replace(self, shown=self.shown | {said.name} if said.shown else self.shown - {said.name})

    def told(self) -> dict[str, Any]:
        """Returns what pages are told: `overlays`, each with `name`, `title` and whether it is `shown`, and the `camera`."""
        overlays = [{"name": name, "title": title, "shown": name in self.shown} for name, title in TITLES.items()]
        return {"overlays": overlays, "camera": self.camera, "cameras": VIEWS}
