"""Reads a model file's text and compiles it; reports in one sentence why a file is not Python 3."""

from __future__ import annotations

import io
import re
import tokenize
import warnings
from functools import lru_cache
from pathlib import Path
from types import CodeType

from actr3d.actr.kernel.source_code import syntax_tree, with_filename
from actr3d.actr.loading.python2 import print_to, python_2_reason
from actr3d.errors import ModelFileError, did_you_mean, reason_of

LONGEST = 200
"""The maximum length of a quoted line [characters]."""


def read_source(path: Path) -> str:
    """Reads a model file in the encoding that it declares, and returns its text.

    Raises:
        ModelFileError: If the file does not exist or is not text.
    """
    return decode_source(read_bytes(path), path)


def read_bytes(path: Path) -> bytes:
    """Reads the bytes of a model file.

    Raises:
        ModelFileError: If the file does not exist or cannot be read.
    """
    try:
        return path.read_bytes()
    except FileNotFoundError:
        near = [p.name for p in path.parent.glob("*.py")] if path.parent.is_dir() else []
        raise ModelFileError(f"no model file '{path}'{did_you_mean(path.name, near)}") from None
    except IsADirectoryError:
        raise ModelFileError(f"'{path}' is a folder; name a model file in it") from None
    except OSError as error:
        raise ModelFileError(f"cannot read the model file '{path}': {reason_of(error)}") from None


def decode_source(data: bytes, path: Path) -> str:
    """Returns the text of a model file, in the encoding that it declares.

    Args:
        data: The content of the file.
        path: The file, for messages.

    Raises:
        ModelFileError: If it is not text.
    """
    data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    try:
        encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
        return data.decode(encoding)
    except (SyntaxError, UnicodeDecodeError, LookupError) as error:
        raise ModelFileError(f"'{path}' is not Python source: {_why_no_text(data, error)}") from None


def _why_no_text(data: bytes, error: Exception) -> str:
    """Returns what is wrong with a file's encoding; if it declares none, the line that is not UTF-8."""
    if "encoding declaration" in str(error) or getattr(error, "encoding", None) == "utf-8":
        try:
            data.decode("utf-8")
        except UnicodeDecodeError as wrong:
            line = data.count(b"\n", 0, wrong.start) + 1
            return f"line {line} is not UTF-8; save it as UTF-8, or name its encoding in the first line (# -*- coding: latin-1 -*-)"
    return str(error)


def compile_source(source: str, filename: str) -> CodeType:
    """Compiles a model's text.

    Raises:
        ModelFileError: If it is not Python 3; the message names the line, and Python 2 if that is the reason.
    """
    if "\0" in source:
        line = source.count("\n", 0, source.index("\0")) + 1
        raise ModelFileError(f"{filename}:{line}: there is a NUL character; this is not Python source")
    reason: tuple[int, str] | None = None
    try:
        known = _compiled(source)
        code = compile(source, filename, "exec", dont_inherit=True) if known is None else with_filename(known, filename)
        number = _print_to(source)
        if number is None:
            return code
        reason = number, "a print statement"
    except SyntaxError as error:
        reason = python_2_reason(source, error)
        if reason is None:
            text = (error.text or "").strip()[:LONGEST]
            raise ModelFileError(f"{filename}:{error.lineno or 0}: {error.msg}" + (f": {text}" if text else "")) from None
    except (RecursionError, MemoryError):
        lengths = [len(line) for line in source.split("\n")]
        line = lengths.index(max(lengths)) + 1
        raise ModelFileError(f"{filename}:{line}: something here (the longest line of the file) is nested too deeply for Python") from None
    except ValueError as error:  # a text that no encoding can hold
        raise ModelFileError(f"'{filename}' is not Python source: {error}") from None
    raise ModelFileError(f"{filename}:{reason[0]}: this file is written for Python 2 ({reason[1]}); convert it to Python 3")


@lru_cache(maxsize=64)
def _compiled(source: str) -> CodeType | None:
    """Compiles a text, once for all files with this text; returns None if the compiler warns about it, as it must for each file.

    Raises:
        SyntaxError: If it is not Python, and other errors as `compile` does.
    """
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        code = compile(source, "<model>", "exec", dont_inherit=True)
    return None if found else code


@lru_cache(maxsize=64)
def _print_to(source: str) -> int | None:
    """Returns the line of the first `print >> file, ...` of a text; None if there is none."""
    return print_to(syntax_tree(source)) if re.search(r"\bprint\s*>>", source) else None
