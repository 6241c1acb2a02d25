"""The changes that a user can make in a world; all modules of this package are imported automatically."""

from actr3d.registry import import_modules

import_modules(__name__, __path__)
