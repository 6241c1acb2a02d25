"""The commands of bodies, one function each.

A new command is a function with the decorator `@actuator`: in a file of this folder, or in any other module that is imported.
"""

from actr3d.registry import import_modules
from actr3d.world.body import ACTUATORS

import_modules(__name__, __path__)

__all__ = ["ACTUATORS"]
