"""Experiments with models: designs, trials on a cluster, and their analysis beside human data."""

from __future__ import annotations

from typing import TYPE_CHECKING

from actr3d.experiment.design import Design, Group, Measured, Trial, design
from actr3d.experiment.distributions import Normal, Uniform
from actr3d.registry import import_modules

if TYPE_CHECKING:
    from actr3d.simulation.measure import Measure

__all__ = ["Design", "Group", "Measured", "Normal", "Trial", "Uniform", "design"]


def find_measures() -> dict[str, type[Measure]]:
    """Imports all modules of this package; returns the measures that they register, by the name of their class."""
    from actr3d.simulation.measure import MEASURES

    import_modules(__name__, __path__, inner=True)
    return MEASURES
