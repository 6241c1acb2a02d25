"""The texts of a program's helper modules, for recordings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
from typing import Any


class HelperTexts:
    """Keeps the text of each helper module that a program loads; a replayed program gets the recorded texts.

    Args:
        known: `loaded` of the recorded run: these modules are loaded from it, whatever their files contain now.
        folder: A folder that contains them as files, if there are no others; see `actr3d.actr.loading.sealed`. None if others may
            come from the program's own folder.
    """

    def __init__(self, known: Mapping[str, Sequence[str]] | None = None, folder: Path | None = None) -> None:
        self._known = dict(known or {})
        self.folder = folder
        self.packages: set[str] = set()
        """The packages that contain them in `sys.modules`, if they are not there by their own names."""
        self.loaded: dict[str, Sequence[str]] = {}
        """By a module's name in the program: its file, relative to the program's folder if it is inside, and its text."""
        self.on_load: Callable[[dict[str, Sequence[str]]], object] = lambda _: None
        """Called with all of `loaded` after each new module."""

    def keep(self, name: str, file: str, folder: Path | None, text: str) -> None:
        """Stores the text of a module that is about to run."""
        path = Path(file)
        inside = folder is not None and path.is_relative_to(folder)
        self.loaded[name] = (path.relative_to(folder).as_posix() if folder is not None and inside else file, text)
        self.on_load(self.loaded)

    def owns(self, fullname: str) -> bool:
        """Returns whether a module belongs to the program, recorded or not."""
        root = fullname.partition(".")[0]
        return self.has(root) or root in self.packages

    def has(self, root: str) -> bool:
        """Returns whether a top module or package of this name, or something in it, was recorded."""
        return any(name.partition(".")[0] == root for name in self._known)

    def spec(self, name: str, fullname: str, folder: Path, load: Callable[[str, str, str], Any]) -> ModuleSpec | None:
        """Returns the import spec of a recorded module; None for others.

        Args:
            name: Its name in the program.
            fullname: Its name in `sys.modules`.
            folder: The program's folder.
            load: Makes the loader from the full name, the file and the text.
        """
        if name in self._known:
            file, text = self._known[name]
            path = folder / file
            inner = [str(path.parent)] if path.name == "__init__.py" else None
            return spec_from_file_location(fullname, path, loader=load(fullname, str(path), text), submodule_search_locations=inner)
        if any(known.startswith(f"{name}.") for known in self._known):  # a folder without `__init__.py`
            spec = ModuleSpec(fullname, None, is_package=True)
            spec.submodule_search_locations = [str(folder.joinpath(*name.split(".")))]
            return spec
        return None
