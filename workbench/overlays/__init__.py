"""Overlays of the 3D scene, one in each file; a new file with an overlay is found by itself."""

from actr3d.world.command_registry import import_modules
from workbench.overlays.overlay import OVERLAYS, Drawn, Observed, Overlay

import_modules(__name__, __path__)

__all__ = ["OVERLAYS", "Drawn", "Observed", "Overlay"]
