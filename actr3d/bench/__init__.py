"""Benchmarks: each measures figures with the limits that they must meet.

Most figures are ratios of two costs, measured in one run.
"""

from __future__ import annotations

import actr3d.experiment
from actr3d.benchmark import BENCHMARKS, Benchmark
from actr3d.registry import import_modules


def find_benchmarks() -> dict[str, Benchmark]:
    """Imports all modules of `actr3d.bench`, and those called `benchmark` of `actr3d.experiment`; returns what they register."""
    import_modules(__name__, __path__)
    import_modules(actr3d.experiment.__name__, actr3d.experiment.__path__, inner=True, named="benchmark")
    return BENCHMARKS
