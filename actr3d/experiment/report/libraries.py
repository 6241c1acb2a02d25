"""The libraries of the report. They are slow to import and have few types, so they are imported at their first use, as `Any`."""

from __future__ import annotations

import gc
import sys
import warnings
from collections.abc import Generator
from contextlib import contextmanager
from importlib import import_module
from importlib.metadata import version
from typing import Any

import numpy as np

USED = ("pandas", "matplotlib", "pingouin", "statsmodels")
"""The packages whose versions the report names; all are in the extra `experiment`."""


def _loaded(name: str) -> Any:
    """Returns a module. Garbage collections while it is imported would find nothing, and take a tenth of the time of a report."""
    if name in sys.modules or not gc.isenabled():
        return import_module(name)
    gc.disable()
    try:
        return import_module(name)
    finally:
        gc.enable()


def pandas() -> Any:
    """Returns the module `pandas`."""
    return _loaded("pandas")


def pingouin() -> Any:
    """Returns the module `pingouin`."""
    return _loaded("pingouin")


def mixedlm() -> Any:
    """Returns `statsmodels.formula.api.mixedlm`."""
    return _loaded("statsmodels.formula.api").mixedlm


def matplotlib(part: str = "") -> Any:
    """Returns the module `matplotlib`, or one of its modules."""
    return _loaded(f"matplotlib.{part}" if part else "matplotlib")


def versions() -> str:
    """Returns the versions of the libraries as text."""
    return ", ".join(f"{name} {version(name)}" for name in USED)


@contextmanager
def noting_warnings() -> Generator[list[str]]:
    """Collects the warnings of a statistical library inside the block, for the report.

    Left out are deprecations: they concern how a library calls another one, and not the result. Divisions by zero leave values that
    are not finite, which the report shows as missing.

    Yields:
        The texts, which are there after the block.
    """
    notes: list[str] = []
    with warnings.catch_warnings(record=True) as caught, np.errstate(all="ignore"):
        warnings.simplefilter("always")
        yield notes
    for warning in caught:
        text = " ".join(str(warning.message).split())
        if not issubclass(warning.category, (DeprecationWarning, PendingDeprecationWarning, FutureWarning)) and text not in notes:
            notes.append(text)
