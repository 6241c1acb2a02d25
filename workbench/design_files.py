"""Finds designs of experiments, of the library and in the user's model files, without running them; and what users want of them."""

from __future__ import annotations

import ast
import os
import posixpath
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

import actr3d
from actr3d.actr.kernel.source_code import last_name, syntax_tree
from actr3d.actr.loading.source_text import read_source
from actr3d.errors import Actr3dError, ModelFileError, did_you_mean
from actr3d.parameter_schema import literal
from actr3d.values import escape_surrogates
from workbench.files import MAX_FILE_SIZE, ModelFolder, file_stamp
from workbench.page_message import PageMessage

LIBRARY = Path(actr3d.__file__).parent / "experiment" / "designs"
"""The folder of the library's own designs; importing them would load what only experiments need."""


Identifier = Annotated[str, Field(min_length=1, max_length=100, pattern=r"^[A-Za-z_][A-Za-z0-9_]*$")]
Whole = Annotated[int, Field(ge=-(2**63), lt=2**63)]
MOST = {"participants": 1_000_000, "trials": 1_000_000, "workers": 256, "levels": 200, "characters": 1_000}
"""The greatest numbers that are taken, by the names of the fields, also of levels of a factor, and of characters of a level.

The page's form has them from `/api/designs`.
"""
Level = bool | Whole | Annotated[float, Field(allow_inf_nan=False)] | Annotated[str, Field(max_length=MOST["characters"])] | None
LevelText = Annotated[str, Field(max_length=MOST["characters"])]
Workers = Annotated[int, Field(ge=1, le=MOST["workers"])]


class NoSuchDesignError(Actr3dError):
    """There is no design of that name."""

    status = 404


@dataclass(frozen=True, kw_only=True)
class DesignOutline:
    """Describes a design, as far as this is possible without running it."""

    id: str
    """What identifies it for the page: its name, or `FILE:NAME` for one in a model file."""
    name: str
    file: str | None
    """The model file; None for one of the library's."""
    model: str | None
    """The file of its model inside the models folder, or only the name of the library's; None if the text does not say it."""
    description: str
    """Its docstring."""


def designs_of(folder: ModelFolder) -> list[DesignOutline]:
    """Returns the designs of the library and of the model files that can be opened."""
    found = [outline for path in sorted(LIBRARY.glob("*.py")) for outline in _in_file(path, None)]
    return found + [outline for path in folder.paths() if folder.problem_of(path) is None for outline in _in_file(folder.root / path, path)]


def design_argument(folder: ModelFolder, design: str) -> str:
    """Returns the name of a design for the command `actr3d experiment`.

    Args:
        folder: The folder of the models.
        design: The `id` of the design.

    Raises:
        NoSuchDesignError: If there is no such design.
        FileError: If the file is not one of the model files.
    """
    file, colon, name = design.rpartition(":")
    if not colon:
        known = [outline.name for path in LIBRARY.glob("*.py") for outline in _in_file(path, None)]
        if name not in known:
            raise NoSuchDesignError(f"the library has no design '{name}'{did_you_mean(name, known)}")
        return name
    where = folder.locate(file)
    if name not in [outline.name for outline in _in_file(where, file)]:
        raise NoSuchDesignError(f"'{file}' has no design '{name}'")
    return f"{where}:{name}"


def stamp_of(folder: ModelFolder) -> Any:
    """Returns a value that changes whenever a Python file of the models folder changes, whichever of them a design uses."""
    found: list[tuple[str | int, ...]] = []
    for where, folders, names in os.walk(folder.root):
        folders[:] = [name for name in folders if name[0] != "."]
        paths = [Path(where, name) for name in names if name.endswith(".py")]
        found += [(str(path), *file_stamp(path)) for path in paths]
    return sorted(found)


def _in_file(path: Path, file: str | None) -> list[DesignOutline]:
    stamp = file_stamp(path)
    try:
        return list(_read(path, file, stamp)) if stamp and stamp[-1] <= MAX_FILE_SIZE else []
    except (OSError, ModelFileError):
        return []


@lru_cache(maxsize=1000)
def _read(path: Path, file: str | None, _: tuple[int, ...]) -> tuple[DesignOutline, ...]:
    """Reads a file; the stamp changes when the file changes."""
    text = read_source(path)
    if "design" not in text:
        return ()
    functions = [node for node in syntax_tree(text).body if isinstance(node, ast.FunctionDef)]
    return tuple(
        DesignOutline(
            id=node.name if file is None else f"{file}:{node.name}",
            name=node.name,
            file=file,
            model=_model_of(node, file),
            description=escape_surrogates(ast.get_docstring(node) or ""),
        )
        for node in functions
        if "design" in map(last_name, node.decorator_list)  # also as `@experiment.design`
    )


def _model_of(function: ast.FunctionDef, file: str | None) -> str | None:
    """Returns the model file that a design names, as `Design(model="FILE")`; without one, it is the file of the design."""
    made = next((node for node in ast.walk(function) if isinstance(node, ast.Call) and last_name(node.func) == "Design"), None)
    if made is None:
        return None
    given = next((keyword.value for keyword in made.keywords if keyword.arg == "model"), None)
    if given is None:
        return file
    named = given.value if isinstance(given, ast.Constant) and isinstance(given.value, str) else None
    return None if named is None else posixpath.normpath(posixpath.join(posixpath.dirname(file or ""), escape_surrogates(named)))


# -- what a user wants of a design


def _as_literal(text: str) -> str:
    """Returns the literal of Python that the command reads as it reads a text, in ASCII also for a text without quotes."""
    value = literal(text)
    return ascii(value) if isinstance(value, (str, bool)) else text


class WantedDesign(PageMessage):
    """A design, and the values and numbers that replace some of its own."""

    design: Annotated[str, Field(min_length=1, max_length=500)]
    """The name of one of the library's, or `FILE:NAME`."""
    values: dict[Identifier, Level | Annotated[list[Level], Field(max_length=MOST["levels"])]] = Field(default_factory=dict, max_length=100)
    """New levels of factors, or values of other parameters."""
    texts: dict[Identifier, Annotated[list[LevelText], Field(min_length=1, max_length=MOST["levels"])]] = Field(
        default_factory=dict, max_length=100
    )
    """The same as users write them, one text for each level: each is read as the command reads it, so that both give one experiment."""
    participants: Annotated[int, Field(ge=1, le=MOST["participants"])] | None = None
    """The number of participants of each group; null for that of the design."""
    trials: Annotated[int, Field(ge=1, le=MOST["trials"])] | None = None
    """The number of trials of each combination of levels; null for that of the design."""

    def options(self) -> list[str]:
        """Returns what replaces some of the design, as options of the command; values as literals of Python, in ASCII."""
        counts = (("participants", self.participants), ("trials", self.trials))
        sets = [f"--set={name}={value!a}" for name, value in self.values.items()]
        for name, texts in self.texts.items():
            levels = list(map(_as_literal, texts))
            sets.append(f"--set={name}={levels[0] if len(levels) == 1 else '[' + ', '.join(levels) + ']'}")
        return [f"--{name}={count}" for name, count in counts if count is not None] + sets


class CheckRequest(WantedDesign):
    """A design to check."""

    trial: bool = False
    """Whether a trial is run as well, which finds out how long it takes."""


class StartRequest(WantedDesign):
    """A design to run."""

    workers: Workers | None = None
    """The number of processes that run trials; null for one on each processor."""
