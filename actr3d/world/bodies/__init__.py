"""The kinds of bodies, one file each.

A new kind is a class with the decorator `@body_kind`: in a file of this folder, or in any other module.
"""

from actr3d.registry import import_modules
from actr3d.world.bodies.car import Car
from actr3d.world.bodies.imported import ImportedBody
from actr3d.world.bodies.load import Load
from actr3d.world.bodies.mannequin import Mannequin

import_modules(__name__, __path__)

__all__ = ["Car", "ImportedBody", "Load", "Mannequin"]
