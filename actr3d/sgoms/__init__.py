"""SGOMS: planning units, unit tasks, methods and operators on top of ACT-R, with interruption and resumption."""

from actr3d.sgoms.agent import SGOMS
from actr3d.sgoms.units import Ordered, Situated

__all__ = ["SGOMS", "Ordered", "Situated"]
