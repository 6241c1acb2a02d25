"""SGOMS (sociotechnical GOMS: goals, operators, methods, selection rules): planning units on top of ACT-R.

They can be interrupted and resumed.
"""

from actr3d.sgoms.agent import SGOMS
from actr3d.sgoms.units import Ordered, Situated

__all__ = ["SGOMS", "Ordered", "Situated"]
