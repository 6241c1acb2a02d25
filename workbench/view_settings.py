"""Stores which overlays a session's 3D view shows. They are the same for all who watch; each browser chooses its own camera."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from workbench.overlays import OVERLAYS


@dataclass(frozen=True)
class ViewSettings:
    """Holds the set of overlays that are shown."""

    shown: frozenset[str] = field(default_factory=lambda: frozenset(n for n, one in OVERLAYS.items() if one.shown_at_first))

    def with_overlay(self, name: str, shown: bool) -> ViewSettings:
        """Returns the settings with an overlay shown or hidden."""
        return replace(self, shown=self.shown | {name} if shown else self.shown - {name})

    def as_dict(self) -> dict[str, Any]:
        """Returns the entry for pages: `overlays`, each with `name`, `title` and whether it is `shown`."""
        return {"overlays": [{"name": name, "title": overlay.title, "shown": name in self.shown} for name, overlay in OVERLAYS.items()]}
