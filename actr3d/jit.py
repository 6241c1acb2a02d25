"""Wrappers of numba's compiler with type annotations; type checkers see compiled functions as plain Python."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from types import FunctionType
from typing import Any, ParamSpec, TypeVar, cast

P = ParamSpec("P")
R = TypeVar("R")

OPTIONS: Any = {"error_model": "numpy", "nogil": True, "_nrt": False, "no_cfunc_wrapper": True}
"""Division by zero gives infinity; no compiled function allocates memory, so that no references need to be counted."""


BLAS = "scipy.linalg.cython_blas"
"""The module of SciPy for which numba looks."""

_marked: set[FunctionType] = set()
"""The functions that are marked with `inner_compiled`."""
_compiled_alone: dict[FunctionType, Any] = {}
"""The functions that are compiled on their own, as `compile_cached` returns them."""


@cache
def _numba() -> Any:
    """Returns numba, which takes a third of a second to load.

    Before it compiles anything, numba looks for SciPy's linear algebra, and to load that takes as long again. Here numba does not find it:
    no function of the library needs it. A function that does, such as one of a model, still loads it when it is compiled.
    """
    if BLAS not in sys.modules:
        sys.modules[BLAS] = cast("Any", None)
        try:
            import_module("numba.np.arraymath")
        finally:
            del sys.modules[BLAS]
    return import_module("numba")


def _njit(**options: Any) -> Any:
    return _numba().njit(**options)


def inner_compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Marks a function that only compiled functions call: it is compiled with the first of these, as numba takes long to load."""
    _marked.add(cast("FunctionType", function))
    return function


@cache
def _compiled(function: FunctionType) -> Any:
    """Returns a marked function compiled, callable only by other compiled functions."""
    return _njit(no_cpython_wrapper=True, forceinline=True, **OPTIONS)(_linked(function))


def _linked(function: FunctionType) -> FunctionType:
    """Returns a function that calls the compiled forms of the marked functions, and of those that are compiled on their own."""
    there = {name: function.__globals__.get(name) for name in function.__code__.co_names}
    functions = {name: value for name, value in there.items() if isinstance(value, FunctionType)}
    inner = {name: _compiled(value) for name, value in functions.items() if value in _marked}
    inner |= {name: _compiled_alone[value] for name, value in functions.items() if value in _compiled_alone}
    linked = FunctionType(function.__code__, function.__globals__ | inner, function.__name__, function.__defaults__, function.__closure__)
    linked.__qualname__ = function.__qualname__
    return linked


def compile_cached(function: Callable[P, R], *sources: Path) -> Callable[P, R]:
    """Returns the function compiled, and cached on disk for the next process if a cache folder is writable.

    Numba's cache checks only the file of the function itself, cannot even be read where a module of the old code is gone, and is
    found by the function's name. So a digest of the sources is added to the name.

    Args:
        function: A function that may call compiled functions, and others for which this was called before: these are compiled on their
            own, so that another process can compile them meanwhile.
        sources: The files of the function and of those functions, or folders of such files.
    """
    linked = _linked(cast("FunctionType", function))
    linked.__qualname__ += f"-{sources_digest(*sources):x}"
    try:
        made = _njit(cache=True, **OPTIONS)(linked)
    except RuntimeError:  # no writable cache folder
        made = _njit(**OPTIONS)(linked)
    _compiled_alone[cast("FunctionType", function)] = made
    return made


def compiled_on_demand(*sources: Path):
    """Replaces a function `f` by one that returns `f` compiled, so that it is called as `f()(...)`.

    `compile_cached` is called for it and `sources` when it is first needed, and just once.
    """

    def decorate(function: Callable[P, R]):
        @cache
        def compiled() -> Callable[P, R]:
            return compile_cached(function, *sources)

        compiled.__doc__, compiled.__module__ = function.__doc__, function.__module__
        return compiled

    return decorate


def sources_digest(*sources: Path) -> int:
    """Returns a digest of this file, and of other files and folders of files."""
    digest = sha256()
    for source in (Path(__file__), *sources):
        for path in sorted(source.glob("*.py")) if source.is_dir() else (source,):
            digest.update(path.read_bytes())
    return int(digest.hexdigest()[:15], 16)
