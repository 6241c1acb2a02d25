"""ACT-R modules besides memory and the production systems, one in each file; a new file with a module is found by itself."""

from actr3d.actr.modules.registry import MODULES, module
from actr3d.registry import import_modules

import_modules(__name__, __path__)

__all__ = ["MODULES", "module"]
