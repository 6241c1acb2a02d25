"""Shows where bodies touch something."""

from __future__ import annotations

from typing import Any

from mujoco import MjData

from workbench.overlays.overlay import Observed, Overlay, OverlayCanvas, overlay


@overlay("contacts", "contacts", shown=True)
class Contacts(Overlay):
    """Shows the contact points and the contact forces. The scene of viser draws them."""

    def __init__(self, canvas: OverlayCanvas) -> None:
        self._scene = canvas.scene

    @staticmethod
    def data(observed: Observed) -> dict[str, Any]:
        """Returns nothing: the physics has the contacts."""
        del observed
        return {}

    def draw(self, data: MjData, by_body: Any) -> None:
        """Does nothing: the scene draws them."""

    def switch(self) -> None:
        """Shows or hides the contacts."""
        self._scene.show_contact_points = self._scene.show_contact_forces = self.visible
