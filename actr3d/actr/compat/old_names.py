"""The old import names, `python_actr`, `ccm` and their submodules, for model files that are loaded here."""

from __future__ import annotations

import importlib
import importlib.abc
import sys
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from importlib.machinery import ModuleSpec
from threading import RLock
from types import ModuleType

ROOTS = ("python_actr", "ccm")
"""The old names of the library."""

_EVERYTHING = ("actr3d.actr", "actr3d.actr.loading.sweep", "actr3d.actr.compat.display")
_PARTS: dict[str, tuple[str, ...]] = {
    "": _EVERYTHING,
    "actr": ("actr3d.actr",),
    "lib": (),
    "lib.actr": ("actr3d.actr",),
    "lib.grid": ("actr3d.actr.compat.grid",),
    "lib.cellular": ("actr3d.actr.compat.grid",),
    "model": ("actr3d.actr.kernel.model", "actr3d.actr.kernel.log"),
    "scheduler": ("actr3d.actr.kernel.scheduler", "actr3d.actr.kernel.events"),
    "logger": ("actr3d.actr.kernel.log", "actr3d.actr.compat.log_files"),
    "pattern": ("actr3d.actr.chunks.pattern", "actr3d.errors"),
    "production": ("actr3d.actr.procedural.production", "actr3d.actr.procedural.actr"),
    "runner": ("actr3d.actr.loading.sweep",),
    "display": ("actr3d.actr.compat.display",),
    "version": ("actr3d.actr.compat.python_actr_version",),
    "actr.buffer": ("actr3d.actr.kernel.buffer", "actr3d.actr.chunks.chunk"),
    "actr.dm": tuple(
        f"actr3d.actr.declarative.{part}" for part in ("memory", "activation", "association", "blending", "partial_matching", "spreading")
    ),
    "actr.pm": ("actr3d.actr.procedural.utility", "actr3d.actr.kernel.noise"),
    "actr.core": ("actr3d.actr.procedural.actr",),
    "actr.compile": ("actr3d.actr.procedural.compilation",),
    "actr.imaginal": ("actr3d.actr.modules.imaginal",),
    "actr.motor": ("actr3d.actr.modules.motor",),
    "actr.sosvision": ("actr3d.actr.modules.sos_vision",),
    "actr.text": ("actr3d.actr.modules.text",),
    "actr.timer": ("actr3d.actr.modules.timer",),
    "actr.vision": ("actr3d.actr.modules.vision",),
}
"""Each submodule of the old library, and the modules here whose names it contains."""

PACKAGES = frozenset({"", "actr", "lib", "lib.actr"})
ROOT_ONLY = frozenset({"Model", "ProductionSystem", "display", "finished", "log", "log_everything", "run"})
"""Names that only the root package exports; models use variables of the same names before they import the rest."""


class OldNames:
    """The old library as one program sees it: modules with the names of this library, made on demand.

    Args:
        used: Called whenever the program imports one of them.
    """

    def __init__(self, used: Callable[[], None] = lambda: None) -> None:
        self.modules: dict[str, ModuleType] = {}
        self.used = used

    def imported(self, name: str, wanted: Sequence[str] | None) -> ModuleType:
        """Returns the result of an import statement: the module for `from ... import`, its root for a plain import.

        Raises:
            ModuleNotFoundError: If the old library has no such module.
        """
        self.used()
        roots = name.split(".")
        *_, module = [self.module(".".join(roots[:length])) for length in range(1, len(roots) + 1)]
        return module if wanted else self.modules[roots[0]]

    def module(self, name: str) -> ModuleType:
        """Returns the module of an old name.

        Raises:
            ModuleNotFoundError: If the old library has no such module.
        """
        with _LOCK:
            return self.modules.get(name) or self._make(name)

    def _make(self, name: str) -> ModuleType:
        part = _part(name)
        if part is None or part not in _PARTS:
            raise ModuleNotFoundError(f"No module named '{name}'", name=name)
        names = {short: getattr(importlib.import_module(source), short) for short, source in _sources(part).items()}
        module = self.modules[name] = ModuleType(name)
        module.__spec__ = _spec(name, part)
        if part in PACKAGES:
            module.__path__ = []
        module.__dict__.update(names)
        # Every submodule is available after `import ccm`, and those of the root package also after `from ccm import *`.
        inner = _inner_parts(part)
        for short in inner:
            if short not in names:
                setattr(module, short, self.module(f"{name}.{short}"))
        if names:
            module.__dict__["__all__"] = _exported(part)
        above, _, short = name.rpartition(".")
        if above in self.modules:
            setattr(self.modules[above], short, module)
        return module


class _Finder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finds the modules of the active program; without one, it finds nothing."""

    def find_spec(self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        part = _part(fullname)
        return _spec(fullname, part) if _ACTIVE and part is not None and part in _PARTS else None

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        if not _ACTIVE:
            raise ModuleNotFoundError(f"No module named '{spec.name}'", name=spec.name)
        names = _ACTIVE[-1]
        names.used()
        return names.module(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        """Does nothing, because the module is complete."""


_LOCK = RLock()
_ACTIVE: list[OldNames] = []
_ORIGINALS: dict[str, ModuleType] = {}
"""The modules of the old names before the first program became active, such as the real python_actr."""
_FINDER = _Finder()
# It is never removed: while another thread iterates over the list, that would hide the next finder from it.
sys.meta_path.insert(0, _FINDER)


def _spec(name: str, part: str) -> ModuleSpec:
    return ModuleSpec(name, _FINDER, is_package=part in PACKAGES)


def _inner_parts(part: str) -> list[str]:
    """Returns the short names of the submodules directly inside a module."""
    inside = "actr" if part == "lib.actr" else part
    prefix = f"{inside}." if inside else ""
    return [
        name.removeprefix(prefix) for name in _PARTS if name != part and name.startswith(prefix) and "." not in name.removeprefix(prefix)
    ]


def _sources(part: str) -> dict[str, str]:
    """Returns the names that a part contains, and the module of this library from which each comes."""
    found: dict[str, str] = {}
    for source in _PARTS[part]:
        offered = importlib.import_module(source)
        public: Sequence[str] = getattr(offered, "__all__", None) or [n for n in vars(offered) if n[0] != "_"]
        found.update(dict.fromkeys(public, source))
    hidden = {"annotations", *(ROOT_ONLY if part in ("actr", "lib.actr") else ())}
    return {name: source for name, source in found.items() if name not in hidden}


def _exported(part: str) -> list[str]:
    """Returns the names that `from ... import *` imports from a part."""
    return sorted({*_sources(part), *(_inner_parts(part) if part == "" else ())} - {"lib"})


def text_of(name: str) -> str | None:
    """Returns a Python text with the names of an old module, for tools that only read; None if the old library has no such module."""
    part = _part(name)
    if part is None or part not in _PARTS:
        return None
    names = _sources(part)
    lines = [f"from {source} import {short}" for short, source in names.items()]
    lines += [f"import {name}.{short} as {short}" for short in _inner_parts(part) if short not in names]
    return "\n".join([*lines, f"__all__ = {_exported(part)}", ""])


def is_package(name: str) -> bool:
    """Returns whether an old module contains others."""
    return _part(name) in PACKAGES


def _part(fullname: str) -> str | None:
    """Returns the part of a dotted name after the root, `actr.dm` also for `lib.actr.dm`; None for other packages."""
    root, _, part = fullname.partition(".")
    if root not in ROOTS:
        return None
    return part.removeprefix("lib.") if part.startswith("lib.actr.") else part


def is_old_name(name: str) -> bool:
    """Returns whether a dotted name is one of the old library."""
    return name.partition(".")[0] in ROOTS


@contextmanager
def aliases(names: OldNames | None = None) -> Generator[None]:
    """Makes the old names importable for all code inside the block, also by `importlib.import_module`.

    Blocks of several threads may end in any order: while any is open, the names are those of the last one that began. After
    all have ended, everything is restored, including a real python_actr.
    """
    names = names or OldNames()
    with _LOCK:
        if not _ACTIVE:
            _ORIGINALS.update(_remove())
        _ACTIVE.append(names)
        _install()
    try:
        yield
    finally:
        with _LOCK:
            del _ACTIVE[max(i for i, one in enumerate(_ACTIVE) if one is names)]
            _install()


def _install() -> None:
    """Puts the active old names into `sys.modules`, or the real modules if none are active."""
    _remove()
    if _ACTIVE:
        sys.modules.update(_ACTIVE[-1].modules)
    else:
        sys.modules.update(_ORIGINALS)
        _ORIGINALS.clear()


def _remove() -> dict[str, ModuleType]:
    """Removes all modules of the old names from `sys.modules`, and returns them."""
    return {name: sys.modules.pop(name) for name in list(sys.modules) if is_old_name(name)}
