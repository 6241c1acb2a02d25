"""Runs a model file under the real python_actr, seeded as `actr3d run --seed` seeds it.

Usage: `python tests/golden/peer.py FILE SEED`. The n-th top model of the program draws from `Random(SEED)` for n = 1 and from
`Random("SEED/n")` after that, and the program's own `random` is seeded with SEED; nothing else about python_actr changes,
except what keeps parts of it from running at all on the Pythons of today.
"""

from __future__ import annotations

import collections
import collections.abc
import importlib
import itertools
import random
import runpy
import sys
import types
from pathlib import Path
from typing import Any

peer: Any = importlib.import_module("python_actr")


def seeded(seed: int) -> types.SimpleNamespace:
    """Returns what python_actr is to take for the module `random`: only its generators' seeds differ."""
    numbers = itertools.count(1)

    def make() -> random.Random:
        number = next(numbers)
        return random.Random(seed if number == 1 else f"{seed}/{number}")

    return types.SimpleNamespace(Random=make)


def prepare(seed: int) -> None:
    """Seeds python_actr, and makes those parts run that ask for names which Python no longer has."""
    peer.model.random = seeded(seed)
    peer.logger.random = random.Random(0)  # a log's file name must not draw from the program's random numbers
    # Compiled productions are named after addresses; here after their number.
    compiled = itertools.count(1)

    def number(_: object) -> int:
        return next(compiled)

    importlib.import_module("python_actr.actr.compile").__dict__["id"] = number
    python: Any = collections
    python.Callable = collections.abc.Callable
    random.seed(seed)


def alias_ccm() -> None:
    """Lets a model file import python_actr under its older names."""
    lib: Any = types.ModuleType("ccm.lib")
    lib.actr = peer.actr
    peer.lib = lib
    sys.modules.update({"ccm": peer, "ccm.lib": lib, "ccm.lib.actr": peer.actr})


def main() -> None:
    """Runs the file named on the command line."""
    file, seed = sys.argv[1], int(sys.argv[2])
    prepare(seed)
    alias_ccm()
    sys.argv = [file]
    peer.logger.singleton_log.directory = file.removesuffix(".py")
    sys.path[0] = str(Path(file).resolve().parent)
    runpy.run_path(file, run_name="__main__")


if __name__ == "__main__":
    main()
