"""Overlays of the 3D scene, one in each file; a new file with an overlay is found by itself.

What only the worker of a run needs is imported in `data`, because the server starts without it.
"""

import pkgutil
from importlib import import_module

from workbench.overlays.overlay import OVERLAYS, Drawn, Observed, Overlay

for _module in pkgutil.iter_modules(__path__):
    import_module(f"{__name__}.{_module.name}")

__all__ = ["OVERLAYS", "Drawn", "Observed", "Overlay"]
