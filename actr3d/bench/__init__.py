"""Benchmarks: each prints its figures with their bars, as ratios of things measured in one run."""

from __future__ import annotations

import pkgutil
from collections.abc import Callable
from importlib import import_module

import actr3d.experiment
from actr3d.benchmark import BENCHMARKS


def find_benchmarks() -> dict[str, Callable[..., int]]:
    """Imports all modules of `actr3d.bench`, and those called `benchmark` of `actr3d.experiment`; returns what they register."""
    for name, path in ((__name__, __path__), (actr3d.experiment.__name__, actr3d.experiment.__path__)):
        for module in pkgutil.walk_packages(path, f"{name}."):
            if name == __name__ or module.name.endswith(".benchmark"):
                import_module(module.name)
    return BENCHMARKS
