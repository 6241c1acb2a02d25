"""The changes that a user can make in a world; all modules of this package are imported automatically."""

from actr3d.registry import import_modules
from actr3d.world.changes.world_change import WorldChange

import_modules(__name__, __path__)

__all__ = ["WorldChange"]
