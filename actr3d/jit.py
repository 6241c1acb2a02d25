"""Wrappers of numba's compiler with type annotations; type checkers see compiled functions as plain Python."""

from __future__ import annotations

from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

P = ParamSpec("P")
R = TypeVar("R")

OPTIONS: Any = {"error_model": "numpy", "nogil": True, "_nrt": False, "no_cfunc_wrapper": True}
"""Division by zero gives infinity; no compiled function allocates memory, so that no references need to be counted."""


def _njit(**options: Any) -> Any:
    import numba  # takes half a second

    return cast("Any", numba).njit(**options)


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Returns the function compiled, callable only by other compiled functions."""
    return _njit(no_cpython_wrapper=True, forceinline=True, **OPTIONS)(function)


def kept(function: Callable[P, R], *sources: Path) -> Callable[P, R]:
    """Returns the function compiled, and cached on disk for the next process if a cache folder is writable.

    Numba's cache checks only the file of the function itself, cannot even be read where a module of the old code is gone, and is
    found by the function's name. So the name says of which sources it was compiled.

    Args:
        function: A function that may call compiled functions.
        sources: The files of the function and of those functions, or folders of such files.
    """
    function.__qualname__ += f"-{sources_digest(*sources):x}"
    try:
        return _njit(cache=True, **OPTIONS)(function)
    except RuntimeError:  # no writable cache folder
        return _njit(**OPTIONS)(function)


def sources_digest(*sources: Path) -> int:
    """Returns a digest of this file, and of other files and folders of files."""
    digest = sha256()
    for source in (Path(__file__), *sources):
        for path in sorted(source.glob("*.py")) if source.is_dir() else (source,):
            digest.update(path.read_bytes())
    return int(digest.hexdigest()[:15], 16)
