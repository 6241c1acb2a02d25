"""Lets unchanged model files import `python_actr`, `ccm` and their parts, for as long as one is being loaded and run."""

from __future__ import annotations

import importlib
import importlib.abc
import importlib.machinery
import importlib.util
import sys
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from types import ModuleType
from typing import Any

from actr3d.actr import logger as logs

ROOTS = ("python_actr", "ccm")
"""The names under which models know the library."""

_EVERYTHING = ("actr3d.actr", "actr3d.actr.sweep", "actr3d.actr.display")
_PARTS: dict[str, tuple[str, ...]] = {
    "": _EVERYTHING,
    "actr": ("actr3d.actr",),
    "lib": (),
    "lib.actr": ("actr3d.actr",),
    "lib.grid": ("actr3d.actr.grid",),
    "lib.cellular": ("actr3d.actr.grid",),
    "model": ("actr3d.actr.model", "actr3d.actr.logger"),
    "scheduler": ("actr3d.actr.scheduler",),
    "logger": ("actr3d.actr.logger",),
    "pattern": ("actr3d.actr.pattern", "actr3d.errors"),
    "production": ("actr3d.actr.production", "actr3d.actr.procedural"),
    "runner": ("actr3d.actr.sweep",),
    "display": ("actr3d.actr.display",),
    "version": ("actr3d.actr.python_actr_version",),
    "actr.buffer": ("actr3d.actr.buffer", "actr3d.actr.chunk"),
    "actr.dm": tuple(f"actr3d.actr.{part}" for part in ("memory", "activation", "association", "blending", "partial", "spreading")),
    "actr.pm": ("actr3d.actr.utility",),
    "actr.core": ("actr3d.actr.procedural",),
    "actr.compile": ("actr3d.actr.compilation",),
    "actr.imaginal": ("actr3d.actr.modules.imaginal",),
    "actr.motor": ("actr3d.actr.modules.motor",),
    "actr.sosvision": ("actr3d.actr.modules.sos_vision",),
    "actr.text": ("actr3d.actr.modules.text",),
    "actr.timer": ("actr3d.actr.modules.timer",),
    "actr.vision": ("actr3d.actr.modules.vision",),
}
"""Each part of the old library, and which of our modules it offers the names of."""

PACKAGES = frozenset({"", "actr", "lib", "lib.actr"})
ROOT_ONLY = frozenset({"Model", "ProductionSystem", "display", "finished", "log", "log_everything", "run"})
"""What the root package alone offers; models name variables like these before they import the rest."""


class _Aliases(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finds the old names, and answers with modules that hold ours."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        part = _part(fullname)
        if part is None or part not in _PARTS:
            return None
        return importlib.util.spec_from_loader(fullname, self, is_package=part in PACKAGES)

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType | None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        part = _part(module.__name__) or ""
        logs.LOG.announce = True
        names: dict[str, Any] = {}
        for source in _PARTS[part]:
            ours = importlib.import_module(source)
            public: Sequence[str] = getattr(ours, "__all__", None) or [n for n in vars(ours) if n[0] != "_"]
            names.update({name: getattr(ours, name) for name in public if name != "annotations"})
        if part in ("actr", "lib.actr"):
            names = {name: value for name, value in names.items() if name not in ROOT_ONLY}
        module.__dict__.update(names)
        # Every part is there after `import ccm`, and those of the root package come with `from ccm import *` too.
        inner = _inner_parts(part)
        for short in inner:
            if short not in names:
                setattr(module, short, importlib.import_module(f"{module.__name__}.{short}"))
        if names:
            module.__dict__["__all__"] = sorted({*names, *inner} - {"lib"} if part == "" else names)


def _inner_parts(part: str) -> list[str]:
    """Returns the short names of the parts directly inside a part."""
    inside = "actr" if part == "lib.actr" else part
    prefix = f"{inside}." if inside else ""
    return [
        name.removeprefix(prefix) for name in _PARTS if name != part and name.startswith(prefix) and "." not in name.removeprefix(prefix)
    ]


def _part(fullname: str) -> str | None:
    """Returns what follows the root in a dotted name, `actr.dm` also for `lib.actr.dm`; None for other packages."""
    root, _, part = fullname.partition(".")
    if root not in ROOTS:
        return None
    return part.removeprefix("lib.") if part.startswith("lib.actr.") else part


def _is_alias(name: str) -> bool:
    return _part(name) is not None


@contextmanager
def aliases() -> Generator[None]:
    """Makes the old names importable inside the block; afterwards everything is as it was, a real python_actr included."""
    finder = _Aliases()
    before = {name: sys.modules.pop(name) for name in list(sys.modules) if _is_alias(name)}
    sys.meta_path.insert(0, finder)
    try:
        yield
    finally:
        sys.meta_path.remove(finder)
        for name in [name for name in sys.modules if _is_alias(name)]:
            del sys.modules[name]
        sys.modules.update(before)
