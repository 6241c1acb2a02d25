"""Where bodies touch something."""

from __future__ import annotations

from typing import Any

from mujoco import MjData

from workbench.overlays.overlay import Overlay


class Contacts(Overlay):
    """The points of contact, and how hard it presses there.

    Args:
        scene: What draws the scene, and draws contacts itself.
    """

    asked = False

    def __init__(self, scene: Any) -> None:
        self._scene = scene

    def draw(self, data: MjData, drawn: Any) -> None:
        """Does nothing: the scene draws them."""

    def switch(self) -> None:
        """Shows or hides them."""
        self._scene.show_contact_points = self._scene.show_contact_forces = self.visible
