"""Experiments with models: designs, trials on a cluster, and their analysis beside human data."""

from __future__ import annotations

import pkgutil
from importlib import import_module
from typing import TYPE_CHECKING

from actr3d.experiment.design import Design, Group, Measured, Normal, Trial, Uniform, design

if TYPE_CHECKING:
    from actr3d.simulation.measure import Measure

__all__ = ["Design", "Group", "Measured", "Normal", "Trial", "Uniform", "design", "find_measures"]


def find_measures() -> dict[str, type[Measure]]:
    """Imports all modules of this package; returns the measures that they register, by the name of their class."""
    from actr3d.simulation.measure import MEASURES

    for module in pkgutil.walk_packages(__path__, f"{__name__}."):
        if not module.name.endswith(".__main__"):
            import_module(module.name)
    return MEASURES
