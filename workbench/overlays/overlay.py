"""What all overlays have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from mujoco import MjData


class Overlay(ABC):
    """Something drawn over the scene, of all bodies."""

    asked = True
    """Whether the worker has to tell what there is to draw."""
    visible = False

    @abstractmethod
    def draw(self, data: MjData, drawn: Any) -> None:
        """Draws it as it is now.

        Args:
            data: The present state, its geometry up to date.
            drawn: What the worker tells of it, by body; None where it tells nothing, as just after it was switched on.
        """

    def show(self, visible: bool) -> None:
        """Shows or hides it."""
        if visible != self.visible:
            self.visible = visible
            self.switch()

    @abstractmethod
    def switch(self) -> None:
        """Lets what is drawn already be seen, or not, as `visible` says."""


class Lines:
    """Line segments in the scene, sent again only where they have changed.

    Args:
        server: Viser's server.
        name: What they are called in viser's tree.
        colour: Red, green, blue, 0 to 255.
        width: In pixels.
    """

    def __init__(self, server: Any, name: str, colour: tuple[int, int, int], width: float) -> None:
        self._server, self._name, self._colour, self._width = server, name, colour, width
        self._handle: Any = None
        self._last = b""
        self._visible = True

    def set(self, points: Any, colours: Any = None) -> None:
        """Draws these lines in place of those before.

        Args:
            points: `(n, 2, 3)`, 4-byte numbers [m].
            colours: Those of their ends, `(n, 2, 3)`, 0 to 255; None for the same for all.
        """
        data = points.tobytes() + (b"" if colours is None else colours.tobytes())
        if data == self._last:
            return
        self._last = data
        if self._handle is None and len(points):
            colors = self._colour if colours is None else colours
            self._handle = self._server.scene.add_line_segments(
                self._name, points=points, colors=colors, line_width=self._width, visible=self._visible
            )
        elif self._handle is not None:
            self._handle.visible = self._visible and len(points) > 0
            if len(points):
                self._handle.points = points
                if colours is not None:
                    self._handle.colors = colours

    def show(self, visible: bool) -> None:
        """Shows or hides them."""
        self._visible = visible
        if self._handle is not None:
            self._handle.visible = visible and bool(self._last)
