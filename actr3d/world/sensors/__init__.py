"""The sensors of bodies, one function each; all readings are of the present state.

A new sensor is a function with the decorator `@sensor`: in a file of this folder, or in any other module that is imported.
"""

from actr3d.registry import import_modules
from actr3d.world.body import SENSORS

import_modules(__name__, __path__)

__all__ = ["SENSORS"]
