"""Overlays of the 3D scene, one in each file; a new file with an overlay is found by itself.

What only the worker of a run needs is imported in `data`, because the server starts without it.
"""

from actr3d.registry import import_modules
from workbench.overlays.overlay import OVERLAYS, Observed, Overlay, OverlayCanvas, ViewSettings

import_modules(__name__, __path__)

__all__ = ["OVERLAYS", "Observed", "Overlay", "OverlayCanvas", "ViewSettings"]
