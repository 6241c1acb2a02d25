"""Overlays of the 3D scene, one kind per file."""

from __future__ import annotations

from typing import Any

from mujoco import MjModel

from workbench.look import Look
from workbench.overlays.contacts import Contacts
from workbench.overlays.edges import Edges
from workbench.overlays.features import Features
from workbench.overlays.frustum import Frustum
from workbench.overlays.overlay import Overlay
from workbench.overlays.path import Path
from workbench.overlays.posture import Posture
from workbench.protocol import OverlayName

__all__ = ["Overlay", "make_overlays"]


def make_overlays(server: Any, scene: Any, model: MjModel, world: dict[str, Any], look: Look) -> dict[OverlayName, Overlay]:
    """Returns the overlays of a scene, by the names under which they are switched on and off.

    Args:
        server: Viser's server.
        scene: The `ViserMujocoScene` that draws the world.
        model: The compiled scene.
        world: The contents of the world, as in `Facts.world`.
        look: The overlays that are shown at first.
    """
    overlays: dict[OverlayName, Overlay] = {
        "frustum": Frustum(server, model, world),
        "edges": Edges(server),
        "features": Features(server),
        "path": Path(server),
        "posture": Posture(server, model, world),
        "contacts": Contacts(scene),
    }
    for name, overlay in overlays.items():
        overlay.show(name in look.shown)
    return overlays
