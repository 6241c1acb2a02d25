"""Seeds the random numbers that a whole program shares: those of Python's module `random`, and of numpy if it is imported.

The core does not use numpy, but what a model draws from `numpy.random` also comes from the seed.
"""

from __future__ import annotations

import importlib.abc
import random
import sys
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import Any
from zlib import crc32

NUMPY = "numpy.random"


def seed_shared(seed: int | str) -> None:
    """Seeds all shared generators."""
    random.seed(seed)
    if (numpy_random := _numpy_random()) is not None:
        _seed_numpy(numpy_random, seed)


def _seed_numpy(numpy_random: Any, seed: int | str) -> None:
    numpy_random.seed(crc32(str(seed).encode()))  # it takes 32 bits


@contextmanager
def shared_random(seed: int | str) -> Generator[None]:
    """Seeds all shared generators inside the block, and restores their states afterwards."""
    before, numpy_random = random.getstate(), _numpy_random()
    numpys = None if numpy_random is None else (numpy_random.get_bit_generator(), numpy_random.get_state(legacy=False))
    late = _LateNumpy(seed)
    sys.meta_path.insert(0, late)
    seed_shared(seed)
    try:
        yield
    finally:
        sys.meta_path.remove(late)
        random.setstate(before)
        if numpys is not None and numpy_random is not None:
            numpy_random.set_bit_generator(numpys[0])
            numpy_random.set_state(numpys[1])
        elif (imported := _numpy_random()) is not None:
            imported.seed()


def _numpy_random() -> Any:
    """Returns the module, if it is imported."""
    return sys.modules.get(NUMPY)


class _LateNumpy(importlib.abc.MetaPathFinder):
    """Seeds numpy's generator if numpy is imported later.

    Args:
        seed: The seed.
    """

    def __init__(self, seed: int | str) -> None:
        self._seed = seed

    def find_spec(self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        spec = PathFinder.find_spec(fullname, path) if fullname == NUMPY else None
        if spec is None or spec.loader is None:
            return None
        loader: Any = spec.loader
        execute = loader.exec_module

        def execute_and_seed(module: ModuleType) -> None:
            execute(module)
            _seed_numpy(module, self._seed)

        loader.exec_module = execute_and_seed
        return spec
