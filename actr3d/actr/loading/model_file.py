"""Loads and runs model files: as programs, unchanged, from a file or from text.

A file that is run is a program: `__main__`, the only entry of `sys.argv`, with its folder first on the path. A process therefore
runs one program at a time (or one inside another, as a parameter sweep does). A text that is loaded is a module; any number of
modules can be loaded and used at once, also by several threads. See `actr3d.actr.loading.program` for the common part.
"""

from __future__ import annotations

import importlib
import sys
import weakref
from collections.abc import Generator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from threading import Lock
from types import CodeType, ModuleType
from typing import Any
from zlib import crc32

from actr3d.actr.compat.log_files import finished
from actr3d.actr.compat.old_names import aliases
from actr3d.actr.kernel import log as logs
from actr3d.actr.kernel.run_limits import EndOfRun, RunLimits
from actr3d.actr.kernel.source_code import WRITTEN_FOR_PYTHON_ACTR, drop_lines
from actr3d.actr.loading.global_seed import shared_random
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.actr.loading.program import Program
from actr3d.actr.loading.source_text import read_source
from actr3d.registry import MODEL_TEXT

_LOADING = Lock()


@contextmanager
def _as_main(module: ModuleType, program: Program) -> Generator[None]:
    """Makes a module the program: `__main__`, in `sys.argv`, with its folder first on the path; removes helper modules afterwards."""
    main, path, argv, known = sys.modules.get("__main__"), list(sys.path), list(sys.argv), set(sys.modules)
    importlib.invalidate_caches()  # helper modules may be newer than the last look into their folder
    sys.modules["__main__"] = module
    sys.path.insert(0, str(program.helpers.folder or program.folder))
    sys.argv[:] = [str(module.__file__)]
    try:
        with program.running():
            yield
    finally:
        helpers = [name for name in set(sys.modules) - known if program.owns_module(sys.modules[name])]
        sys.path[:], sys.argv[:] = path, argv
        if main is not None:
            sys.modules["__main__"] = main
        for name in helpers:
            del sys.modules[name]


def _module(name: str, filename: str, program: Program) -> ModuleType:
    """Makes the module for a model's text; its lines for tracebacks are removed with the last object of the module."""
    module = ModuleType(name)
    # Functions hold only the globals of their module; this entry keeps the module alive as long as its functions.
    module.__dict__.update({"__file__": filename, "__actr3d_module__": module})
    weakref.finalize(module, drop_lines, program.files).atexit = False
    return module


def run_text(
    source: str,
    filename: str = "<model>",
    *,
    limits: RunLimits | None = None,
    folder: Path | None = None,
    helpers: HelperTexts | None = None,
) -> ModuleType:
    """Runs a model's text as a program, until it and the threads it has started end.

    Args:
        source: The program.
        filename: Its name in tracebacks.
        limits: Its seed, end and trace; None for a new seed, no end and no trace.
        folder: The folder of its helper modules; by default the current folder.
        helpers: Stores the texts of its helper modules, or provides recorded ones.

    Returns:
        The program's module after the run.

    Raises:
        ModelFileError: If it, or a helper module, is not Python 3.
        Exception: Whatever the program raises.
    """
    program = Program((folder or Path.cwd()).resolve(), helpers)
    module = _module("__main__", filename, program)
    code = program.prepare(source, filename, module)
    _execute(code, module, program, limits or RunLimits())
    return module


def _execute(code: CodeType, module: ModuleType, program: Program, limits: RunLimits) -> None:
    """Runs a program's code within its limits, and restores everything afterwards."""
    outer = RunLimits.current()
    with ExitStack() as stack:
        stack.callback(logs.begin())
        stack.enter_context(limits)
        stack.enter_context(aliases(program.old))
        stack.enter_context(_as_main(module, program))
        stack.enter_context(shared_random(limits.program_seed))
        logs.LOG.source = module.__file__
        stack.callback(_finish)  # also if the program fails: what it has logged is written
        try:
            exec(code, module.__dict__)
        except EndOfRun:
            if outer is not None and outer.ended:
                raise  # the outer program has no time left either
        finally:
            limits.wait_for_threads()
        module.__dict__[WRITTEN_FOR_PYTHON_ACTR] = logs.LOG.announce


def _finish() -> None:
    """Finishes the program's log, without a last line if its output is closed."""
    out = sys.stdout
    if getattr(out, "closed", False):
        sys.stdout = None
    try:
        finished()
    finally:
        sys.stdout = out


def run_file(path: Path | str, *, limits: RunLimits | None = None) -> ModuleType:
    """Runs a model file as a program; see `run_text`.

    Raises:
        ModelFileError: If the file does not exist, or it or a helper module is not Python 3.
        Exception: Whatever the program raises.
    """
    path = Path(path)
    return run_text(read_source(path), str(path), limits=limits, folder=path.parent)


def load_text(
    source: str, filename: str = "<model>", *, folder: Path | str | None = None, helpers: HelperTexts | None = None
) -> ModuleType:
    """Loads a model's text as a module, whose classes can be used afterwards without restriction.

    Its entries in `sys.modules`, and its lines for tracebacks, are removed when nothing of the module is in use any more: neither
    the module itself nor a function, class or instance of it. A text whose top level fails leaves nothing in `sys.modules`.

    Args:
        source: The text.
        filename: Its name in tracebacks; several texts may have the same name.
        folder: The folder of its helper modules, now and later; None for none. Each text loads its own instances of them.
        helpers: Stores the texts of its helper modules, or provides recorded ones.

    Raises:
        ModelFileError: If it, or a helper module, is not Python 3.
        Exception: Whatever its top level raises.
    """
    importlib.invalidate_caches()
    program = Program(None if folder is None else Path(folder).resolve(), helpers)
    with _LOADING:
        # The name depends on the text only, so that two processes give it the same; a second module of one text gets a number.
        name = stem = f"{MODEL_TEXT}{crc32(f'{filename}:{source}'.encode(errors='replace')):08x}"
        number = 1
        while name in sys.modules:
            number += 1
            name = f"{stem}_{number}"
        module = _module(name, filename, program)
        # dataclasses and pickle look up a class's module; `sys.modules` must not keep it alive.
        known: dict[str, Any] = {name: _Loaded(module), **program.as_package(f"{name}_files")}
        sys.modules.update(known)
    weakref.finalize(module, _forget, known).atexit = False
    try:
        exec(program.prepare(source, filename, module), module.__dict__)
    except BaseException:
        _forget(known)
        raise
    if program.used_old_names:
        module.__dict__[WRITTEN_FOR_PYTHON_ACTR] = True
    for value in list(vars(module).values()):
        if isinstance(value, type) and value.__module__ == name:
            # A function holds the globals of its module; a class without functions holds nothing of it.
            type.__setattr__(value, "__actr3d_module__", module)
    return module


class _Loaded(ModuleType):
    """Represents a loaded text in `sys.modules` without keeping it alive; it is empty when the text's module no longer exists."""

    def __init__(self, module: ModuleType) -> None:
        super().__init__(module.__name__)
        _MODULES[self] = weakref.ref(module)

    @property
    def __dict__(self) -> dict[str, Any]:  # pyright: ignore[reportIncompatibleVariableOverride]
        module = _MODULES[self]()
        return {} if module is None else module.__dict__

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__[name]
        except KeyError:
            raise AttributeError(f"module '{self.__name__}' has no attribute '{name}'", name=name, obj=self) from None

    def __setattr__(self, name: str, value: Any) -> None:
        self.__dict__[name] = value


_MODULES: weakref.WeakKeyDictionary[_Loaded, weakref.ref[ModuleType]] = weakref.WeakKeyDictionary()


def _forget(known: dict[str, Any]) -> None:
    """Removes a loaded text, and its helper modules, from `sys.modules`, unless another has replaced it."""
    for name, entry in known.items():
        if sys.modules.get(name) is entry:
            for inner in [inner for inner in list(sys.modules) if inner == name or inner.startswith(f"{name}.")]:
                del sys.modules[inner]
