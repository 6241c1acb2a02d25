"""Runs a recorded program only with its recorded files: none of its modules come from elsewhere on this machine."""

from __future__ import annotations

import importlib.abc
import os
import site
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from contextlib import contextmanager, suppress
from importlib.machinery import ModuleSpec, PathFinder
from importlib.metadata import Distribution, DistributionFinder, MetadataPathFinder
from pathlib import Path
from threading import RLock
from types import ModuleType
from typing import Any

from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.errors import RecordingError

_LOCK = RLock()  # everything here affects the whole process
OWN = ("actr3d", "workbench", "__main__")
"""Modules that are kept in every replay, wherever they come from."""
_IN_USE = frozenset(sys.modules) & sys.stdlib_module_names
"""Modules of Python that this library has loaded before any program runs: none of a program's own modules takes their place."""


@contextmanager
def sealed(file: str, source: str, helpers: Mapping[str, Sequence[str]], within: Path | None = None) -> Generator[HelperTexts]:
    """Restricts imports inside the block to the recorded modules, the standard library and installed packages.

    The texts are also written to a new temporary folder, first on the path, for processes that the program starts. The file names
    in tracebacks and `__file__` are the recorded ones.

    Args:
        file: The recorded name of the program's file.
        source: Its text.
        helpers: Its helper modules, in the form of `HelperTexts.loaded`.
        within: Where the temporary folder is made; None for the system's folder for temporary files.

    Yields:
        The helper modules, for loading or running the program.

    Raises:
        RecordingError: If no program can have loaded one of them, because the module of Python of that name is in use.
    """
    foreign = sorted(_IN_USE & {name.partition(".")[0] for name in helpers})
    if foreign:
        raise RecordingError(
            "the recording contains helper modules that no program can have loaded: "
            f"Python uses modules of these names ({', '.join(foreign)})"
        )
    with _LOCK, tempfile.TemporaryDirectory(prefix="actr3d-replay-", dir=within) as name:
        folder, folders = Path(name), installed_folders()
        _lay_out(folder, [(Path(file).name, source), *helpers.values()])
        texts = HelperTexts(helpers, folder)
        path, finders = list(sys.path), list(sys.meta_path)
        hidden = _hide(lambda root: texts.has(root) or not _is_installed(root, folders))
        sys.path[:] = folders
        sys.meta_path[:] = [_SealedFinder(texts, finders, folders)]
        try:
            yield texts
        finally:
            sys.path[:], sys.meta_path[:] = path, finders
            sys.modules.update(hidden)


class _SealedFinder(importlib.abc.MetaPathFinder):
    """Finds modules with the usual finders, only where packages are installed, and none that the recording contains."""

    def __init__(self, texts: HelperTexts, finders: Sequence[Any], folders: Sequence[str]) -> None:
        self._texts = texts
        self._finders = finders
        self._folders = folders

    def find_spec(self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        where = list(self._folders) if path is None else path
        for finder in self._finders:
            if finder is PathFinder and self._texts.owns(fullname):
                return None
            spec = finder.find_spec(fullname, where if finder is PathFinder else path, target)
            if spec is not None:
                return spec
        return None

    def find_distributions(self, context: DistributionFinder.Context | None = None) -> Iterable[Distribution]:
        """Returns the metadata of installed packages, such as their versions."""
        return MetadataPathFinder.find_distributions(context or DistributionFinder.Context())


def installed_folders() -> list[str]:
    """Returns the folders on the path where packages are installed, without the current folder and that of the script."""
    known = {sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    known |= {*site.getsitepackages(), site.getusersitepackages()}
    links = {line for folder in list(known) for line in _linked(Path(folder))}
    given = {entry for entry in os.environ.get("PYTHONPATH", "").split(os.pathsep) if Path(entry).is_absolute()}
    inside = tuple(f"{folder}{os.sep}" for folder in known)
    zipped = tuple(entry for entry in sys.path if entry.endswith(f"python{sys.version_info[0]}{sys.version_info[1]}.zip"))
    return [entry for entry in sys.path if entry in {*known, *links, *given, *zipped} or entry.startswith(inside)]


def _linked(folder: Path) -> Generator[str]:
    """Yields the folders that `.pth` files add to the path, as editable installations do."""
    with suppress(OSError):
        for file in folder.glob("*.pth"):
            for line in file.read_text(encoding="utf-8", errors="replace").splitlines():
                if line.strip() and not line.startswith(("#", "import ", "import\t")):
                    yield str(folder / line.strip())


def _hide(unwanted: Callable[[str], bool]) -> dict[str, ModuleType]:
    """Removes packages and modules whose first name is unwanted from `sys.modules`, and returns them."""
    roots = {name.partition(".")[0] for name in list(sys.modules)}
    gone = {root for root in roots if root not in OWN and unwanted(root)}
    return {name: sys.modules.pop(name) for name in list(sys.modules) if name.partition(".")[0] in gone}


def _is_installed(root: str, folders: Iterable[str]) -> bool:
    """Returns whether a loaded module or package is built in, or comes from one of the given folders."""
    module = sys.modules.get(root)
    file = getattr(module, "__file__", None)
    places = [file] if isinstance(file, str) else [f"{folder}/__init__.py" for folder in getattr(module, "__path__", ())]
    if root in sys.stdlib_module_names or not places:
        return True  # or it was made without a file
    paths = [Path(place) for place in places]
    return any("site-packages" in path.parts or any(str(parent) in folders for parent in path.parents[:2]) for path in paths)


def _lay_out(folder: Path, texts: Iterable[Sequence[str]]) -> None:
    """Writes texts to files of these names below a folder; ignores names that point elsewhere."""
    for name, text in texts:
        with suppress(OSError, ValueError):  # not a valid file name
            target = folder.joinpath(name).resolve()
            if target.is_relative_to(folder.resolve()):
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_text(text, encoding="utf-8", errors="replace")
