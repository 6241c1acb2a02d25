"""The changes that a user can make in an agent; a module of this package that defines one is found by itself."""

from actr3d.actr.changes.agent_change import AgentChange, Parts
from actr3d.registry import import_modules

import_modules(__name__, __path__)

__all__ = ["AgentChange", "Parts"]
