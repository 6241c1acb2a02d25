"""Loads and runs model files: as programs, unchanged, from a file or from text."""

from __future__ import annotations

import importlib
import io
import linecache
import random
import sys
import tokenize
from collections.abc import Callable, Generator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from types import ModuleType
from typing import Any
from zlib import crc32

from actr3d.actr import logger as logs
from actr3d.actr.aliases import aliases
from actr3d.actr.limits import EndOfRun, RunLimits
from actr3d.actr.python2 import python_2_reason
from actr3d.actr.sources import SOURCE, WRITTEN_FOR_PYTHON_ACTR
from actr3d.errors import ModelFileError, did_you_mean


def read_source(path: Path) -> str:
    """Returns a model file's text, in the encoding it declares.

    Raises:
        ModelFileError: If there is no such file, or it is no text.
    """
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        near = [p.name for p in path.parent.glob("*.py")] if path.parent.is_dir() else []
        raise ModelFileError(f"no model file '{path}'{did_you_mean(path.name, near)}") from None
    except IsADirectoryError:
        raise ModelFileError(f"'{path}' is a folder; name a model file in it") from None
    except OSError as error:
        raise ModelFileError(f"cannot read the model file '{path}': {error.strerror}") from None
    data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    try:
        encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
        return data.decode(encoding)
    except (SyntaxError, UnicodeDecodeError, LookupError) as error:
        raise ModelFileError(f"'{path}' is no Python source: {_why_no_text(data, error)}") from None


def _why_no_text(data: bytes, error: Exception) -> str:
    """Says what is wrong with a file's encoding; where it declares none, which line is no UTF-8."""
    if "encoding declaration" in str(error) or getattr(error, "encoding", None) == "utf-8":
        try:
            data.decode("utf-8")
        except UnicodeDecodeError as wrong:
            line = data.count(b"\n", 0, wrong.start) + 1
            return f"line {line} is no UTF-8; save it as UTF-8, or name its encoding in the first line (# -*- coding: latin-1 -*-)"
    return str(error)


def compile_source(source: str, filename: str) -> Any:
    """Compiles a model's text, and makes it known to tracebacks.

    Raises:
        ModelFileError: If it is no Python 3; the message names the line, and says so where it is Python 2.
    """
    linecache.cache[filename] = (len(source), None, [f"{line}\n" for line in source.split("\n")], filename)
    try:
        return compile(source, filename, "exec", dont_inherit=True)
    except SyntaxError as error:
        reason = python_2_reason(source, error)
        line = error.lineno or 0
        text = (error.text or "").strip()
        if reason is not None:
            line, reason = reason
            raise ModelFileError(f"{filename}:{line}: this file is written for Python 2 ({reason}); convert it to Python 3") from None
        raise ModelFileError(f"{filename}:{line}: {error.msg}" + (f": {text}" if text else "")) from None
    except ValueError as error:  # NUL bytes
        raise ModelFileError(f"'{filename}' is no Python source: {error}") from None


@contextmanager
def _as_main(module: ModuleType, folder: Path) -> Generator[None]:
    """Lets a module be the program: `__main__`, alone in `sys.argv`, its folder first on the path; its helper modules go with it."""
    main, path, argv, known = sys.modules.get("__main__"), list(sys.path), list(sys.argv), set(sys.modules)
    importlib.invalidate_caches()  # helper modules may be newer than the last look into their folder
    sys.modules["__main__"] = module
    sys.path.insert(0, str(folder))
    sys.argv[:] = [str(module.__file__)]
    try:
        yield
    finally:
        sys.path[:], sys.argv[:] = path, argv
        if main is not None:
            sys.modules["__main__"] = main
        for name in set(sys.modules) - known:
            helper = sys.modules[name]
            places = [getattr(helper, "__file__", None) or "", *getattr(helper, "__path__", ())]
            if any(_is_in(place, folder) and not _is_in(place, Path(sys.prefix)) for place in places):
                del sys.modules[name]


def _is_in(place: str, folder: Path) -> bool:
    return bool(place) and Path(place).is_relative_to(folder)


def _module(name: str, source: str, filename: str) -> ModuleType:
    """Makes the module that a model's text is to run in."""
    module = ModuleType(name)
    module.__dict__.update({"__file__": filename, SOURCE: source})
    return module


def run_text(
    source: str,
    filename: str = "<model>",
    *,
    limits: RunLimits | None = None,
    folder: Path | None = None,
    names: dict[str, Any] | None = None,
    prepare: Callable[[ModuleType], None] | None = None,
) -> ModuleType:
    """Runs a model's text as a program.

    Args:
        source: The program.
        filename: How tracebacks call it.
        limits: Its seed, end and trace; None for a fresh seed, no end and no trace.
        folder: Where it finds its own helper modules; the present folder unless given.
        names: Globals it starts with.
        prepare: Called with the module before it runs.

    Returns:
        The program's module, as it is in the end.

    Raises:
        ModelFileError: If it is no Python 3.
        Exception: Whatever the program raises.
    """
    code = compile_source(source, filename)
    module = _module("__main__", source, filename)
    module.__dict__.update({"__builtins__": __builtins__, **(names or {})})
    if prepare is not None:
        prepare(module)
    limits = limits or RunLimits()
    with ExitStack() as stack:
        stack.callback(random.setstate, random.getstate())
        stack.callback(logs.begin())
        stack.enter_context(limits)
        stack.enter_context(aliases())
        stack.enter_context(_as_main(module, (folder or Path.cwd()).resolve()))
        random.seed(limits.program_seed)
        logs.LOG.source = filename
        stack.callback(logs.finished)  # also where the program fails: what it logged until then is kept
        with suppress(EndOfRun):
            exec(code, module.__dict__)
        module.__dict__[WRITTEN_FOR_PYTHON_ACTR] = logs.LOG.announce
    return module


def run_file(path: Path | str, *, limits: RunLimits | None = None) -> ModuleType:
    """Runs a model file as a program; see `run_text`.

    Raises:
        ModelFileError: If there is no such file, or it is no Python 3.
        Exception: Whatever the program raises.
    """
    path = Path(path)
    return run_text(read_source(path), str(path), limits=limits, folder=path.parent)


def load_text(source: str, filename: str = "<model>") -> ModuleType:
    """Loads a model's text as a module; its classes can be used afterwards.

    Raises:
        ModelFileError: If it is no Python 3.
        Exception: Whatever its top level raises.
    """
    code = compile_source(source, filename)
    module = _module(f"actr3d_model_{crc32(filename.encode(errors='replace')):08x}", source, filename)
    sys.modules[module.__name__] = module  # dataclasses and pickling look a class's module up
    before, logs.LOG.announce = logs.LOG.announce, False
    try:
        with aliases():
            exec(code, module.__dict__)
        module.__dict__[WRITTEN_FOR_PYTHON_ACTR] = logs.LOG.announce
    finally:
        logs.LOG.announce = before
    return module
