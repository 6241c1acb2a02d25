"""Defines the base of all overlays, and lines that they share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from mujoco import MjData


class Overlay(ABC):
    """Base of all overlays: draws something over the scene for all bodies."""

    asked = True
    """Whether the overlay needs data from the worker."""
    visible = False

    @abstractmethod
    def draw(self, data: MjData, drawn: Any) -> None:
        """Draws the overlay for the current state.

        Args:
            data: The current state, with up-to-date geometry.
            drawn: The worker's data by body; None if there is none yet, for example just after the overlay was switched on.
        """

    def show(self, visible: bool) -> None:
        """Shows or hides the overlay."""
        if visible != self.visible:
            self.visible = visible
            self.switch()

    @abstractmethod
    def switch(self) -> None:
        """Shows or hides what is already drawn, according to `visible`."""


class Lines:
    """Draws line segments in the scene; they are sent again only if they have changed.

    Args:
        server: Viser's server.
        name: Their name in viser's tree.
        colour: Red, green, blue, 0 to 255.
        width: Line width [pixels].
    """

    def __init__(self, server: Any, name: str, colour: tuple[int, int, int], width: float) -> None:
        self._server, self._name, self._colour, self._width = server, name, colour, width
        self._handle: Any = None
        self._last = b""
        self._visible = True

    def set(self, points: Any, colours: Any = None) -> None:
        """Replaces the lines.

        Args:
            points: The ends of the lines `(n, 2, 3)`, 4-byte floats [m].
            colours: The colours of the ends `(n, 2, 3)`, 0 to 255; None for the same colour for all.
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
        """Shows or hides the lines."""
        self._visible = visible
        if self._handle is not None:
            self._handle.visible = visible and bool(self._last)
