"""Numba's compiler, with types; the functions of this package are ordinary ones to the type checker."""

from __future__ import annotations

from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

import numba

P = ParamSpec("P")
R = TypeVar("R")

OPTIONS: Any = {"error_model": "numpy", "nogil": True, "_nrt": False, "no_cfunc_wrapper": True}
"""Division by zero gives infinity; no compiled function allocates memory, so that no references need to be counted."""

_njit = cast("Any", numba).njit


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Returns the function compiled, to be called by other compiled ones only."""
    return _njit(no_cpython_wrapper=True, forceinline=True, **OPTIONS)(function)


def kept(function: Callable[P, R]) -> Callable[P, R]:
    """Returns the function compiled, and kept on disk for the next process where any folder can be written."""
    try:
        return _njit(cache=True, **OPTIONS)(function)
    except RuntimeError:  # no folder to keep it in
        return _njit(**OPTIONS)(function)


def sources_digest(*folders: Path) -> int:
    """Returns a digest of all files of this package, and of other folders whose functions use it.

    Numba looks only at the file of the kept function itself, and would go on using old code of the others.
    """
    digest = sha256()
    for folder in (Path(__file__).parent, *folders):
        for path in sorted(folder.glob("*.py")):
            digest.update(path.read_bytes())
    return int(digest.hexdigest()[:15], 16)


@compiled
def zero() -> int:
    """Returns 0 as a variable: handed a constant, every function it comes to would be compiled once more for that."""
    return int(0.0)
