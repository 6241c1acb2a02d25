"""Shows where bodies touch something."""

from __future__ import annotations

from typing import Any

from mujoco import MjData

from workbench.overlays.overlay import Overlay


class Contacts(Overlay):
    """Shows the contact points and the contact forces.

    Args:
        scene: The `ViserMujocoScene` of the world, which draws contacts itself.
    """

    asked = False

    def __init__(self, scene: Any) -> None:
        self._scene = scene

    def draw(self, data: MjData, drawn: Any) -> None:
        """Does nothing: the scene draws them."""

    def switch(self) -> None:
        """Shows or hides the contacts."""
        self._scene.show_contact_points = self._scene.show_contact_forces = self.visible
