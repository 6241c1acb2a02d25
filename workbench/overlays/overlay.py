"""Defines the base of all overlays, their registry, which of them are shown, and lines that they share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol, TypeVar

import numpy as np
from mujoco import MjData, MjModel

from actr3d.registry import Registry

if TYPE_CHECKING:
    from actr3d.camera import CameraParameters
    from actr3d.simulation import Simulation

OVERLAYS: Registry[type[Overlay]] = Registry("overlay")
"""All overlays by name, in the order of the menu."""


class OverlayCanvas(NamedTuple):
    """The 3D view that an overlay draws in."""

    server: Any
    """Viser's server."""
    scene: Any
    """The `ViserMujocoScene` that draws the world."""
    model: MjModel
    """The compiled scene."""
    world: dict[str, Any]
    """The contents of the world, as in `Facts.world`."""
    send: Callable[[Any], None]
    """Sends a command of a user, a `PageCommand`, to the session; may be called from any thread."""


class Observed(NamedTuple):
    """The simulation whose data an overlay draws; overlays change nothing."""

    simulation: Simulation
    eyesight: Callable[[str], CameraParameters]
    """Returns the camera parameters with which a body's agent sees."""
    paths: Callable[[], dict[str, list[list[list[float]]]]]
    """Returns the paths that bodies have walked up to now, by body: pieces of positions (x, y) [m], without what they did not walk."""


class Drawing(Protocol):
    """A part of an overlay that is shown and hidden with it."""

    def show(self, visible: bool) -> None:
        """Shows or hides it."""


class Overlay(ABC):
    """Base of all overlays: draws something over the scene for all bodies.

    An overlay is a subclass with the decorator `@overlay`, in a file of this folder: `data` runs in the worker of the run, `draw` in
    the server.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    """The text in the menu."""
    shown_at_first: ClassVar[bool]
    visible = False
    labels: Sequence[dict[str, Any]] = ()
    """Labels that it wants, each with `text`, `place` [m], whether it is about what an agent attends to (`chosen`), and perhaps the ends of
    a measured `line` [m]; each browser places them where they cover nothing."""
    drawn: Sequence[Drawing] = ()
    """What `switch` shows and hides: its `Lines` and the like."""

    @abstractmethod
    def __init__(self, canvas: OverlayCanvas) -> None: ...

    @staticmethod
    @abstractmethod
    def data(observed: Observed) -> dict[str, Any]:
        """Returns what is to be drawn now, by body; called only while the overlay is shown. The state of the physics is not part of it."""

    @abstractmethod
    def draw(self, data: MjData, by_body: Any) -> None:
        """Draws the overlay for the current state.

        Args:
            data: The current state, with up-to-date geometry.
            by_body: The worker's data by body; None if there is none yet, for example just after the overlay was switched on.
        """

    def show(self, visible: bool) -> None:
        """Shows or hides the overlay."""
        if visible != self.visible:
            self.visible = visible
            self.switch()

    def switch(self) -> None:
        """Shows or hides what is already drawn, according to `visible`; by default `drawn`."""
        for one in self.drawn:
            one.show(self.visible)


Kind = TypeVar("Kind", bound=Overlay)


def overlay(name: str, title: str, *, shown: bool = False) -> Callable[[type[Kind]], type[Kind]]:
    """Registers an overlay.

    Args:
        name: Its name in commands.
        title: Its text in the menu.
        shown: Whether it is shown until somebody hides it.
    """

    def register(cls: type[Kind]) -> type[Kind]:
        cls.name, cls.title, cls.shown_at_first = name, title, shown
        OVERLAYS.add(name, cls)
        return cls

    return register


@dataclass(frozen=True)
class ViewSettings:
    """The overlays that a session's 3D view shows. They are the same for all who watch; each browser chooses its own camera."""

    shown: frozenset[str] = field(default_factory=lambda: frozenset(n for n, one in OVERLAYS.items() if one.shown_at_first))

    def with_overlay(self, name: str, shown: bool) -> ViewSettings:
        """Returns the settings with an overlay shown or hidden."""
        return replace(self, shown=self.shown | {name} if shown else self.shown - {name})

    def as_dict(self) -> dict[str, Any]:
        """Returns the entry for pages: `overlays`, each with `name`, `title` and whether it is `shown`."""
        return {"overlays": [{"name": name, "title": overlay.title, "shown": name in self.shown} for name, overlay in OVERLAYS.items()]}


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

    def set(self, points: Any) -> None:
        """Replaces the lines by those with these ends `(n, 2, 3)`, an array or nested lists [m]."""
        points = np.asarray(points, dtype=np.float32)
        data = points.tobytes()
        if data == self._last:
            return
        self._last = data
        if self._handle is None and len(points):
            self._handle = self._server.scene.add_line_segments(
                self._name, points=points, colors=self._colour, line_width=self._width, visible=self._visible
            )
        elif self._handle is not None:
            self._handle.visible = self._visible and len(points) > 0
            if len(points):
                self._handle.points = points

    def show(self, visible: bool) -> None:
        """Shows or hides the lines."""
        self._visible = visible
        if self._handle is not None:
            self._handle.visible = visible and bool(self._last)
