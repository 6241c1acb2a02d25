"""Import isolation: what the files of one program share, namely the meaning of `import`, and their texts.

Every file that is loaded here, including helper modules, has its own builtins, whose `__import__` is the program's. Therefore
`python_actr` and `ccm` mean this library in these files, at any time and in any thread, and in no other files. Helper modules
are those beside the program, and those in folders that the program has added to `sys.path`.
"""

from __future__ import annotations

import builtins
import importlib
import importlib.abc
import importlib.util
import sys
from collections.abc import Generator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any
from weakref import WeakValueDictionary

from actr3d.actr.compat.old_names import OldNames, aliases, is_old_name
from actr3d.actr.kernel import log as logs
from actr3d.actr.kernel.source_code import SOURCE, WRITTEN_FOR_PYTHON_ACTR, FileName, keep_lines
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.actr.loading.source_text import compile_source, read_source

LIBRARY = "actr3d"
"""This library: never a helper module, also for a file in a copy of its repository."""


class Program:
    """The files of one program.

    It has no reference to the program's main module, which refers to it: helper modules, which `sys.modules` keeps alive, must
    not keep the main module alive.

    Args:
        folder: The folder of its helper modules; None for none.
        helpers: Stores the texts of helper modules, or provides recorded ones; None for a new store.
    """

    def __init__(self, folder: Path | None, helpers: HelperTexts | None = None) -> None:
        self.folder = folder
        self.helpers = helpers or HelperTexts()
        self.files: list[FileName] = []
        """The names under which tracebacks find the lines of its texts."""
        self.used_old_names = False
        """Whether it has imported python_actr or ccm."""
        self.old = OldNames(self._note_old_names)
        self._package: str | None = None
        self._path: list[str] = []
        self._builtins = ModuleType("builtins")
        vars(self._builtins).update(vars(builtins))
        vars(self._builtins)["__import__"] = self.imported

    def prepare(self, source: str, filename: str, module: ModuleType) -> CodeType:
        """Compiles a text, and prepares a module to run it.

        Raises:
            ModelFileError: If it is not Python 3.
        """
        name = FileName(filename)
        code = compile_source(source, name)
        keep_lines(source, name)
        self.files.append(name)
        module.__dict__.update({SOURCE: source, "__builtins__": vars(self._builtins)})
        return code

    def as_package(self, name: str) -> dict[str, ModuleType]:
        """Puts the helper modules into a package of this name, so that those of several programs can exist at once.

        Returns:
            The entries for `sys.modules`: the package; none if the program has no folder.
        """
        if self.folder is None:
            return {}
        package = ModuleType(name)
        package.__path__ = [str(self.folder)]
        self._package = name
        self._path = list(sys.path)
        self.helpers.packages.add(name)
        _PACKAGES[name] = self
        return {name: package}

    @contextmanager
    def running(self) -> Generator[None]:
        """Puts the helper modules into `sys.modules` by their own names inside the block."""
        self._path = list(sys.path)
        _RUNNING.append(self)
        try:
            yield
        finally:
            _RUNNING.remove(self)

    def owns(self, place: str) -> bool:
        """Returns whether a file or folder belongs to the program."""
        if not place or self.folder is None:
            return False
        path = Path(place).resolve()
        roots = (self.folder, *(Path(entry).resolve() for entry in self._added()))
        return any(path.is_relative_to(root) for root in roots) and not _is_installed(path)

    def _added(self) -> list[str]:
        """Returns the folders that the program has added to `sys.path`."""
        return [entry for entry in sys.path if entry not in self._path]

    def owns_module(self, module: ModuleType) -> bool:
        """Returns whether a module is one of the program's helper modules."""
        return any(self.owns(place) for place in (getattr(module, "__file__", None) or "", *getattr(module, "__path__", ())))

    def short_name(self, fullname: str) -> str:
        """Returns the name of a module inside the program."""
        return fullname if self._package is None else fullname.removeprefix(f"{self._package}.")

    def _note_old_names(self) -> None:
        self.used_old_names = True
        if self in _RUNNING:
            logs.LOG.announce = True

    # -- the meaning of `import`

    def imported(
        self,
        name: str,
        globals: Mapping[str, Any] | None = None,
        locals: Mapping[str, Any] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        """Executes an import statement in one of the program's files; the parameters are those of `__import__`.

        Raises:
            ImportError: If the module cannot be imported.
        """
        if level == 0:
            if is_old_name(name):
                if isinstance(globals, dict):
                    globals[WRITTEN_FOR_PYTHON_ACTR] = True
                return self.old.imported(name, fromlist)
            if name == "builtins":
                return self._builtins
            if self._is_helper(name.partition(".")[0]):
                return self._helper(name, fromlist)
        if level or name in sys.modules:
            return builtins.__import__(name, globals, locals, fromlist or (), level)
        with aliases(self.old):  # an installed package may also use the old names
            return builtins.__import__(name, globals, locals, fromlist or (), level)

    def _is_helper(self, root: str) -> bool:
        """Returns whether a name is that of a helper module in the program's own package."""
        if self._package is None or root == LIBRARY or (root in sys.modules and root in sys.stdlib_module_names):
            return False
        full = f"{self._package}.{root}"
        if full in sys.modules or self.helpers.has(root):
            return True
        if self.helpers.folder is not None:
            return False
        where = [str(self.folder), *self._added()]
        sys.modules[self._package].__path__[:] = where
        spec = PathFinder.find_spec(full, where)
        # Everything else of that name takes precedence over a folder without `__init__.py`.
        return spec is not None and (spec.loader is not None or importlib.util.find_spec(root) is None)

    def _helper(self, name: str, fromlist: Sequence[str] | None) -> ModuleType:
        full = f"{self._package}.{name}"
        if fromlist:
            return builtins.__import__(full, None, None, fromlist)
        importlib.import_module(full)
        return sys.modules[f"{self._package}.{name.partition('.')[0]}"]


class _HelperLoader(SourceFileLoader):
    """Loads a helper module in the same way as the program; from its file, or from a recorded text."""

    def __init__(self, program: Program, name: str, path: str, text: str | None = None) -> None:
        super().__init__(name, path)
        self.program = program
        self.text = text

    def exec_module(self, module: ModuleType) -> None:
        program, path = self.program, str(self.path)
        text = read_source(Path(path)) if self.text is None else self.text
        program.helpers.keep(program.short_name(self.name), path, program.folder, text)
        exec(program.prepare(text, path, module), module.__dict__)


class _HelperFinder(importlib.abc.MetaPathFinder):
    """Finds the helper modules of loaded programs, and of the running one."""

    def find_spec(self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        program = _PACKAGES.get(fullname.partition(".")[0]) or (_RUNNING[-1] if _RUNNING else None)
        if program is None or fullname in sys.builtin_module_names or fullname.partition(".")[0] == LIBRARY:
            return None
        if program.folder is not None:
            name = program.short_name(fullname)
            known = program.helpers.spec(name, fullname, program.folder, partial(_HelperLoader, program))
            if known is not None or program.helpers.folder is not None:
                return known
        spec = PathFinder.find_spec(fullname, path)
        loader = spec.loader if spec is not None else None
        if type(loader) is not SourceFileLoader or not program.owns(str(loader.path)):
            return None
        assert spec is not None
        spec.loader = _HelperLoader(program, loader.name, str(loader.path))
        return spec


_PACKAGES: WeakValueDictionary[str, Program] = WeakValueDictionary()
_RUNNING: list[Program] = []
sys.meta_path.insert(0, _HelperFinder())  # it is never removed; see the finder of the old names


def _is_installed(path: Path) -> bool:
    """Returns whether a file is one of an installed package or of Python itself."""
    return "site-packages" in path.parts or path.is_relative_to(Path(sys.prefix).resolve())
