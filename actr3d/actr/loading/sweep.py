"""Parameter sweeps: run a model file many times, with different values for the variables that its first lines set."""

from __future__ import annotations

import ast
import math
import sys
from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from numbers import Integral, Real
from pathlib import Path
from typing import Any, cast

from actr3d.actr.kernel import log as logs
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.kernel.source_code import parse
from actr3d.actr.loading.model_file import run_text
from actr3d.actr.loading.source_text import compile_source, read_source
from actr3d.errors import ParameterError, alternatives


def parameters(source: str) -> dict[str, ast.Assign]:
    """Returns the parameters of a model: the assignments `name = value` before any other code.

    A docstring, comments and imports from `__future__` may come before them.

    Raises:
        SyntaxError: If the text is not Python.
    """
    found: dict[str, ast.Assign] = {}
    for node in parse(source).body:
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            found[node.targets[0].id] = node
        elif not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)) and not (
            isinstance(node, ast.ImportFrom) and node.module == "__future__"
        ):
            break
    return found


def settings(values: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Yields every combination of the values; a list is a set of alternatives, anything else one value."""
    choices = [cast("list[Any]", value) if type(value) is list else [value] for value in values.values()]
    for chosen in product(*choices):
        yield dict(zip(values, chosen, strict=True))


def with_values(source: str, chosen: Mapping[str, Any]) -> str:
    """Returns a model's text with new values for its parameters, on the same lines.

    Raises:
        ParameterError: If the model has no such parameter, or a value cannot be written in a text.
    """
    known = parameters(source)
    text = source.encode()  # Python counts columns in bytes
    starts = [0]
    for line in text.split(b"\n"):
        starts.append(starts[-1] + len(line) + 1)
    values: list[tuple[int, int, str]] = []
    for name, value in chosen.items():
        if name not in known:
            raise ParameterError(f"the model has no parameter '{name}'{alternatives(name, known, 'its first lines set:')}")
        old = known[name].value
        last = old.end_lineno or old.lineno
        start, end = starts[old.lineno - 1] + old.col_offset, starts[last - 1] + (old.end_col_offset or 0)
        new = repr(_written(value, name))
        values.append((start, end, f"({new}{chr(10) * (last - old.lineno)})" if last > old.lineno else new))
    for start, end, new in sorted(values, reverse=True):
        text = text[:start] + new.encode() + text[end:]
    return text.decode()


class _Text:
    """A value that is shown as a text."""

    def __init__(self, text: str) -> None:
        self._text = text

    def __repr__(self) -> str:
        return self._text


def _written(value: Any, name: str) -> Any:
    """Returns a parameter's value in a form whose `repr` is Python text.

    Raises:
        ParameterError: If it, or something in it, is not a number, text, list, tuple, set, dict, range, True, False or None.
    """
    if value is None or isinstance(value, (bool, range)):
        return value
    if isinstance(value, Integral):
        return int(value)
    if isinstance(value, Real):
        number = float(value)
        return number if math.isfinite(number) else _Text(f"float('{number}')")
    if isinstance(value, dict):
        return {_written(key, name): _written(item, name) for key, item in cast("dict[Any, Any]", value).items()}
    for kind in (list, tuple, set, frozenset):
        if isinstance(value, kind):
            return cast("Any", kind)(_written(part, name) for part in cast("Iterable[Any]", value))
    if isinstance(value, (str, bytes)):
        return str(value) if isinstance(value, str) else bytes(value)
    raise ParameterError(
        f"parameter '{name}': {value!r} cannot be written in the model's text; use numbers, texts, lists, tuples, sets and dicts"
    )


def label(source: str, chosen: Mapping[str, Any]) -> str:
    """Returns the name of a setting, used for the folder of its data: `a(3) b(x)`, or `default`."""
    known = parameters(source)
    words = [f"{name}({value})" for name, value in chosen.items() if ast.unparse(known[name].value) != repr(_written(value, name))]
    return " ".join(words) or "default"


def run(_filename: str, _iterations: int = 1, **settings_of: Any) -> None:
    """Runs a model file for every combination of the given values, and writes the log of each run to a data file.

    The data are written to `model/a(3) b(x)/<time>.data`, and a copy of the model's text to `model/code.py`.

    Args:
        _filename: The model file, with or without `.py`; in the current folder, or beside the calling program.
        _iterations: The number of runs of each combination.
        settings_of: For each parameter one value, or a list of values to try.

    Raises:
        ModelFileError: If the file does not exist, or is not Python 3.
        ParameterError: If the model has no such parameter.
    """
    path = Path(_filename if _filename.endswith(".py") else f"{_filename}.py")
    program = getattr(sys.modules.get("__main__"), "__file__", None)
    if not path.exists() and program is not None and (beside := Path(program).parent / path).exists():
        path = beside
    source = read_source(path)
    compile_source(source, str(path))
    _keep_copy(path, source)
    for iteration in range(_iterations):
        for chosen in settings(settings_of):
            text = with_values(source, chosen)
            name = label(source, chosen)
            print(path, f"{iteration}/{_iterations}", name)  # noqa: T201 - as the old one did
            outer = RunLimits.current()
            limits = RunLimits() if outer is None else outer.inner(outer.next_seed())
            restore = logs.begin()
            logs.log(data=True, screen=False, directory=str(path.with_suffix("") / _safe(name)))
            logs.LOG.locked = True
            try:
                run_text(text, str(path), limits=limits, folder=path.parent)
            finally:
                restore()


def _safe(name: str) -> str:
    """Returns a setting's name with the characters replaced that a folder's name must not contain."""
    return "".join("_" if c in '/\\:*?"<>|\0\n' else c for c in name)[:200]


def _keep_copy(path: Path, source: str) -> None:
    """Writes the model's text beside its data; an older, different copy is renamed."""
    folder = path.with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)
    copy = folder / "code.py"
    if copy.exists() and copy.read_text(encoding="utf-8") != source:
        number = 1
        while (older := folder / f"code-{number}.py").exists():
            number += 1
        copy.rename(older)
    copy.write_text(source, encoding="utf-8")


def run_with(script: str) -> None:
    """Raises an error: in python_actr this named another program to run models with; here they run in this one.

    Raises:
        ParameterError: Always.
    """
    raise ParameterError(f"run_with({script!r}): models run inside this program; remove the call")


__all__ = ["run", "run_with"]
