"""Specifications of experiments: everything that determines the rows of an experiment, as one JSON document.

A specification holds the texts of the design and of the model, so that workers need none of these files, and later changes to them
change nothing. It does not hold other files that a model reads, such as a table of words: each worker reads them when a trial runs, so
they must be there, and stay the same.
"""

from __future__ import annotations

import ast
import inspect
import itertools
import json
import pkgutil
import re
import sys
from collections.abc import Collection, Generator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from copy import copy
from dataclasses import asdict, dataclass, field, fields
from importlib import import_module
from pathlib import Path
from traceback import extract_tb
from types import ModuleType
from typing import TYPE_CHECKING, Any, cast

import actr3d
from actr3d.actr.compat.old_names import is_old_name
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.kernel.source_code import last_name
from actr3d.actr.loading import load_text
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.actr.loading.sealed import sealed
from actr3d.actr.loading.source_text import compile_source, read_source
from actr3d.actr.loading.sweep import parameters as variables_of
from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError, DesignError, ExperimentError, alternatives, did_you_mean, reason_of
from actr3d.experiment import designs
from actr3d.experiment.design import Design, Group, Measured, is_design
from actr3d.experiment.distributions import Normal, Uniform
from actr3d.experiment.human_data import library_human_data
from actr3d.experiment.versions import experiment_versions
from actr3d.output import printing_nothing
from actr3d.parameter_schema import Parameter, default_of
from actr3d.runner.build_check import check_build, has_build

if TYPE_CHECKING:
    from actr3d.runner.model_factory import Blueprint

FORMAT = 1
"""The version of the format of a specification."""


@dataclass(frozen=True, kw_only=True)
class Source(Configuration):
    """The text of a Python file, with those of its own helper modules."""

    file: str
    """Its name in tracebacks."""
    text: str
    helpers: Mapping[str, Any] = field(default_factory=dict[str, Any])
    """The modules beside it that it imports, directly or through others; see `HelperTexts.loaded`."""

    def __post_init__(self) -> None:
        """Checks the values.

        Raises:
            ConfigurationError: If one has the wrong type.
        """
        super().__post_init__()
        for name, module in self.helpers.items():
            if not isinstance(module, (list, tuple)) or [*map(type, cast("Sequence[Any]", module))] != [str, str]:
                raise ConfigurationError(f"Source.helpers['{name}']: must be a file and its text (got {module!r})")


@dataclass(frozen=True, kw_only=True)
class Specification(Configuration):
    """Everything that determines the rows of an experiment, except data files that the model reads."""

    name: str
    """The name of the design."""
    design: Source
    model: Source
    participants: int | None = None
    """The number of participants of each group; None for that of the design."""
    trials: int | None = None
    """The number of trials of each combination of levels; None for that of the design."""
    values: Mapping[str, Any] = field(default_factory=dict[str, Any])
    """Values that replace those of the design, as JSON has them; see `Design.changed`."""
    versions: Mapping[str, str] = field(default_factory=dict[str, str])
    """The versions of everything that the rows may depend on."""
    format: int = FORMAT

    def __post_init__(self) -> None:
        """Converts the values to those that JSON has on a worker: seeds name them.

        Raises:
            ConfigurationError: If a field has the wrong type.
        """
        super().__post_init__()
        object.__setattr__(self, "values", _as_json(self.values))

    def to_json(self) -> str:
        """Returns the specification as JSON."""
        return json.dumps(asdict(self), ensure_ascii=False, indent=1)

    def content(self) -> dict[str, Any]:
        """Returns all that determines the rows, as JSON has it: without the places of the files, and with the versions."""
        content = json.loads(self.to_json())
        for one in ("design", "model"):
            del content[one]["file"]
        return content

    def differences_from(self, there: Specification) -> list[str]:
        """Returns in words how its texts differ from those of another specification ("there")."""
        before, now = there.content(), self.content()
        found: list[str] = []
        if self.name != there.name:
            found.append(f"the design is '{there.name}' there, '{self.name}' now")
        for one in ("design", "model"):
            if before[one]["text"] != now[one]["text"]:
                lines = itertools.zip_longest(before[one]["text"].split("\n"), now[one]["text"].split("\n"))
                first = next(number for number, (old, new) in enumerate(lines, start=1) if old != new)
                found.append(f"the {one} differs from line {first} on ({getattr(self, one).file})")
            modules = (before[one]["helpers"], now[one]["helpers"])
            names = [name for name in {**modules[0], **modules[1]} if modules[0].get(name) != modules[1].get(name)]
            found += [f"the module '{name}' beside the {one} differs" for name in names]
        return found

    def sealed(self) -> AbstractContextManager[HelperTexts]:
        """Restricts imports inside the block to the texts of the specification, the standard library and installed packages.

        The block is given the helper modules of design and model, for `Experiment` and `run_trial`.
        """
        return sealed(self.model.file, self.model.text, {**self.design.helpers, **self.model.helpers})

    @classmethod
    def from_json(cls, text: str, where: str) -> Specification:
        """Returns the specification that a JSON document describes.

        Args:
            text: The document.
            where: Its name, for errors.

        Raises:
            ExperimentError: If it is not a specification.
        """
        try:
            given = json.loads(text)
            if given["format"] != FORMAT:
                raise ExperimentError(f"{where}: has format {given['format']!r}; this version reads format {FORMAT}")
            sources = {name: Source.from_mapping(given.pop(name)) for name in ("design", "model")}
            return cls.from_mapping({**given, **sources})
        except (ValueError, TypeError, KeyError, AttributeError, ConfigurationError) as error:
            raise ExperimentError(f"{where}: is not the description of an experiment ({error})") from None


class Experiment:
    """A design that was loaded, with its model.

    Args:
        specification: The texts.
        helpers: Provides the helper modules of design and model; see `Specification.sealed`. None for those of the specification.

    Raises:
        DesignError: If the design is not valid, or does not fit the model; names the file and the line.
        ModelFileError: If the model file is not valid.
        Exception: Any error that the files themselves raise.
    """

    def __init__(self, specification: Specification, helpers: HelperTexts | None = None) -> None:
        self.specification = specification
        source, model = specification.design, specification.model
        with naming_the_line(source, specification.name):
            self._module = load_quietly(source, helpers)
        self.written = design_in(self._module, specification.name, source)
        """The design as its file has it, without the numbers and values of the specification."""
        with naming_the_line(source, specification.name, specification.values):
            self.design = self._changed_as(specification)
        compile_source(model.text, model.file)
        check_build(model.text, model.file)
        self.blueprint: Blueprint | None = None
        """Builds the model's simulations; None for a program."""
        if has_build(model.text):
            with RunLimits(), printing_nothing():
                self.blueprint = load_blueprint(model, helpers or HelperTexts(model.helpers))
        self.parameters: tuple[Parameter, ...] = (
            self.blueprint.fields
            if self.blueprint is not None
            else tuple(
                Parameter(name=name, takes="value", line=node.lineno, **default_of(node.value, {}))
                for name, node in variables_of(model.text).items()
            )
        )
        """The parameters of the model: the fields of its dataclass, or the variables that the first lines of a program set."""
        self.about: dict[str, dict[str, str | None]] = {}
        """Units and meanings of the columns, as far as they are known."""
        self.describe(self.parameters)
        with naming_the_line(source, specification.name, specification.values):
            first = "" if self.blueprint is not None else " (the variables that its first lines set, before any import)"
            self.design.check(self.parameters, first)
            if self.blueprint is None and self.design.results is None and not self.design.measures:
                raise DesignError("Design.measures: must name the variables of the program that are its measures (got none)", "measures")

    def load_again(self, helpers: HelperTexts | None = None) -> None:
        """Loads the file of the design again, so that `derive` and `results` find none of its variables as an earlier trial left them.

        Args:
            helpers: Provides the helper modules of the design; see `Specification.sealed`.
        """
        if self.written.derive is None and self.written.results is None:
            return
        source, name = self.specification.design, self.specification.name
        written, fresh = design_in(load_quietly(source, helpers), name, source), copy(self.design)
        for function in ("derive", "results"):  # the table of trials stays, which takes long to compute
            object.__setattr__(fresh, function, getattr(written, function))
        self.design = fresh

    def _changed_as(self, specification: Specification) -> Design:
        """Returns the design of the file with the numbers and values of a specification."""
        return self.written.changed(participants=specification.participants, trials=specification.trials, values=specification.values)

    @property
    def changes(self) -> dict[str, Any]:
        """The numbers and values of the specification that are not those of the design as its file has it, by name."""
        counts = {"participants": self.specification.participants, "trials": self.specification.trials}
        different = {name.removeprefix("--") for name in self.design.changed_names(self.written)}
        return {name: value for name, value in {**counts, **self.specification.values}.items() if name in different}

    def differences_from(self, there: Specification) -> list[str]:
        """Returns in words how this experiment differs from a stored one ("there"), apart from versions.

        If their texts are the same, the resulting designs are compared, however their numbers and values were given.
        """
        return self.specification.differences_from(there) or self.design.differences_from(self._changed_as(there))

    @property
    def description(self) -> str:
        """The docstring of the design."""
        return inspect.getdoc(getattr(self._module, self.specification.name)) or ""

    def describe(self, fields_of_result: Sequence[Parameter]) -> None:
        """Adds units and meanings of measures, once they are known."""
        self.about |= {field.name: {"unit": field.unit, "meaning": field.help} for field in fields_of_result}

    def describe_column(self, name: str, measure: Measured) -> None:
        """Adds the unit and meaning that the design gives a measure, for one of its columns."""
        if measure.unit or measure.meaning:
            which = "" if measure.over is None else f" ({measure.over} {name.rpartition('_')[2]})"
            self.about[name] = {"unit": measure.unit, "meaning": measure.meaning and f"{measure.meaning.removesuffix('.')}{which}."}


# -- finding designs


def library_designs() -> dict[str, Path]:
    """Returns the files of the library's own designs by the designs' names: the main design, then the others by name."""
    found: dict[str, Path] = {}
    for info in pkgutil.iter_modules(designs.__path__):
        module = import_module(f"{designs.__name__}.{info.name}")
        found |= dict.fromkeys(designs_of(module), Path(str(module.__file__)))
    return {name: found[name] for name in sorted(found, key=lambda name: (name != designs.MAIN, name))}


def library_models() -> Path:
    """Returns the folder of the library's own models: beside the library in a copy of the repository, within it if installed."""
    library = Path(actr3d.__file__).parent
    return library / "models" if (library / "models").is_dir() else library.parent / "models"


def designs_of(module: ModuleType) -> dict[str, Any]:
    """Returns the designs that a module defines, by name."""
    return {name: value for name, value in vars(module).items() if is_design(value) and value.__module__ == module.__name__}


def specify(
    name: str, *, participants: int | None = None, trials: int | None = None, values: Mapping[str, Any] | None = None
) -> Experiment:
    """Finds and checks a design.

    Args:
        name: One of the library's designs; a file that defines one; or `FILE:NAME` if it defines several.
        participants: The number of participants of each group; None for that of the design.
        trials: The number of trials of each combination of levels; None for that of the design.
        values: Values that replace those of the design; see `Design.changed`.

    Raises:
        ExperimentError: If there is no such design.
        DesignError: If the design is not valid, or does not fit the model; names the file and the line.
        ModelFileError: If the model file, or the file of the design, is not valid.
        Exception: Any error that the files themselves raise.
    """
    path, chosen = _file_of(name)
    source = _source_of(path)
    marked = _marked(source)
    if not chosen:
        if len({*marked}) != 1:
            found = f"there are: {', '.join(marked)}; name one as '{path}:NAME'" if marked else "mark a function with @design"
            raise ExperimentError(f"{path}: must define one design (found {len(marked)}); {found}")
        chosen = marked[0]
    if marked.count(chosen) > 1:
        raise ExperimentError(f"{path}: defines the design '{chosen}' {marked.count(chosen)} times; give each another name")
    with naming_the_line(source, chosen):
        module = load_quietly(source)
    of_design = design_in(module, chosen, source)
    with naming_the_line(source, chosen):
        model = _model_of(of_design, path)
    specification = Specification(
        name=chosen,
        design=source,
        model=_source_of(model),
        participants=participants,
        trials=trials,
        values=values or {},
        versions=experiment_versions(),
    )
    experiment, people = Experiment(specification), library_human_data()
    if different := [*of_design.changed_names(experiment.written), *_other_fields(of_design, experiment.written)]:
        with naming_the_line(source, chosen):
            names = ", ".join(different)
            same = f"{chosen}() must return the same design each time, as each process loads it (different: {names}); draw with a seed"
            raise DesignError(same, different[0])
    human = experiment.design.human
    if human is not None and human not in people:
        with naming_the_line(source, chosen):
            hint = alternatives(human, people, "the library has:")
            files = "a file is given to actr3d report --human, or actr3d fit --target"
            raise DesignError(f"Design.human: must name human data of the library (got '{human}'; {files}){hint}", "human")
    return experiment


def _other_fields(one: Design, other: Design) -> list[str]:
    """Returns the names of the fields that differ between two designs, of those that `Design.changed` cannot change."""
    mine, theirs = ({"model": of.model, "measures": of.kept, "order": of.order, "human": of.human} for of in (one, other))
    return [name for name, value in mine.items() if value != theirs[name]]


def _as_json(value: Any) -> Any:
    """Returns a value as JSON has it: a tuple is a list."""
    if isinstance(value, Mapping):
        return {name: _as_json(one) for name, one in cast("Mapping[Any, Any]", value).items()}
    return [*map(_as_json, cast("Sequence[Any]", value))] if isinstance(value, (list, tuple)) else value


def _file_of(name: str) -> tuple[Path, str]:
    """Returns the file of a design, and the name in it, if it is known.

    Raises:
        ExperimentError: If there is no such design or file, or it cannot be read.
    """
    known = library_designs()
    if name in known:
        return known[name], name
    if not name:
        raise ExperimentError("the name of the design must not be empty")
    file, colon, chosen = name.rpartition(":")
    path = Path(name)
    try:
        if colon and file and chosen.isidentifier() and Path(file).exists():
            return Path(file), chosen
        is_folder, there = path.is_dir(), path.exists()
    except OSError as error:
        raise ExperimentError(f"cannot read '{name}' ({reason_of(error)})") from None
    if is_folder:
        raise ExperimentError(f"'{name}' is a folder; name a design, or a file with one")
    if not there:
        hint = alternatives(name, known, "the library has:", path.parent.glob("*.py"))
        raise ExperimentError(f"no design, file or folder '{name}'{hint}")
    return path, ""


def _source_of(path: Path) -> Source:
    """Returns the text of a file; the folder of one of the library's own files is not part of its name."""
    own = path.parent in (library_models(), *map(Path, designs.__path__))
    text = read_source(path)
    return Source(file=path.name if own else str(path), text=text, helpers=modules_beside(path.parent, text))


def modules_beside(folder: Path, text: str) -> dict[str, list[str]]:
    """Returns the modules of a folder that a text imports anywhere in it, directly or through others.

    Args:
        folder: The folder of the text.
        text: The text, or "" for none.

    Returns:
        By name, the file relative to the folder and its text, as in `HelperTexts.loaded`. A package is returned whole.
    """
    found: dict[str, list[str]] = {}
    waiting = [text]
    while waiting:
        for root in _imported_roots(waiting.pop()):
            if root in found or root == "actr3d" or is_old_name(root) or (root in sys.stdlib_module_names and root in sys.modules):
                continue
            for path in (folder / f"{root}.py", *sorted((folder / root).rglob("*.py"))):
                if path.is_file():
                    inside = path.relative_to(folder)
                    name = ".".join(inside.with_suffix("").parts).removesuffix(".__init__")
                    found[name] = [inside.as_posix(), read_source(path)]  # a list, as JSON returns it
                    waiting.append(found[name][1])
    return found


def _imported_roots(text: str) -> set[str]:
    """Returns the first names of all modules that a text imports; none if it is not Python 3."""
    try:
        nodes = list(ast.walk(ast.parse(text)))
    except SyntaxError:
        return set()
    names = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    names += [node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.module and not node.level]
    return {name.partition(".")[0] for name in names}


def _model_of(of: Design, path: Path) -> Path:
    if of.model is None:
        return path
    shipped = library_models() / of.model
    if path.parent in map(Path, designs.__path__) and shipped.exists():  # a design and its model may have the same name
        return shipped
    beside = path.parent / of.model
    if not beside.exists() and not shipped.exists():
        near = did_you_mean(of.model, [file.name for folder in (path.parent, library_models()) for file in folder.glob("*.py")])
        raise DesignError(f"Design.model: there is no file '{of.model}' beside it or among the library's models{near}", "model")
    return beside if beside.exists() else shipped


def load_blueprint(model: Source, helpers: HelperTexts) -> Blueprint:
    """Loads a model file with a `build`.

    Raises:
        ModelFileError: If the file is not valid.
        ExperimentError: If it ends the program.
        Exception: Any error that the file itself raises.
    """
    from actr3d.runner.model_factory import Blueprint  # a program does without the world that this loads

    with _refusing_to_end(model.file):
        return Blueprint(model.text, model.file, Path(model.file).parent, helpers)


def load_quietly(source: Source, helpers: HelperTexts | None = None) -> ModuleType:
    """Loads the file of a design; what it prints is dropped.

    Args:
        source: The file.
        helpers: Provides its helper modules; None for those of the file.

    Raises:
        ModelFileError: If it is not Python 3.
        ExperimentError: If it ends the program.
        Exception: Any error that the file itself raises.
    """
    with RunLimits(seed=0), printing_nothing(), _refusing_to_end(source.file):
        return load_text(source.text, source.file, folder=Path(source.file).parent, helpers=helpers or HelperTexts(source.helpers))


@contextmanager
def _refusing_to_end(file: str) -> Generator[None]:
    """Raises an error if a file that is loaded inside the block ends the program.

    Raises:
        ExperimentError: If it does.
    """
    try:
        yield
    except SystemExit as error:
        line = next((f":{one.lineno}" for one in reversed(extract_tb(error.__traceback__)) if one.filename == file), "")
        raise ExperimentError(f"{file}{line}: must not end the program when it is loaded (it ended with {error!r})") from error


def design_in(module: ModuleType, name: str, source: Source) -> Design:
    """Returns a design that a module defines.

    Raises:
        ExperimentError: If it defines no such design.
        DesignError: If the design is not valid; names the file and the line.
    """
    known = designs_of(module)
    if name not in known:
        raise ExperimentError(f"{source.file}: has no design '{name}'{alternatives(name, known, 'it has:')}")
    with naming_the_line(source, name):
        try:
            inspect.signature(known[name]).bind()
        except TypeError as error:
            raise DesignError(f"{name}() must be a function without arguments ({error})") from None
        try:
            found = known[name]()
        except SystemExit as error:
            ended = DesignError(f"{name}() must return a Design (it ended with {error!r})")
            raise ended.with_traceback(error.__traceback__) from None  # names the line
        if not isinstance(found, Design):
            raise DesignError(f"{name}() must return a Design (returned {found!r})")
    return found


@contextmanager
def naming_the_line(source: Source, function: str, replaced: Collection[str] = ()) -> Generator[None]:
    """Adds the place to the errors of a design that are raised inside the block.

    Args:
        source: The file of the design.
        function: The name of the design.
        replaced: The names of values that replace those of the file.

    Raises:
        DesignError: The same error after `file:line`, or after `--set` for a value that replaces one of the file.
    """
    try:
        yield
    except (ConfigurationError, DesignError) as error:
        known = error if isinstance(error, DesignError) else None
        name = str(error).partition(":")[0].rpartition(".")[2] if known is None else known.name
        place = f"--set {name}" if name in replaced else f"{source.file}:{_line_of(source, function, error, name)}"
        kind, group = (DesignError, "") if known is None else (type(known), known.group)
        raise kind(f"{place}: {error}", name, group) from None
    except TypeError as error:
        found = re.fullmatch(r"(\w+)\.__init__\(\) got an unexpected keyword argument '(\w+)'", str(error))
        kind = next((one for one in (Design, Group, Measured, Normal, Uniform) if found is not None and one.__name__ == found[1]), None)
        if found is None or kind is None:
            raise
        name = found[2]
        near = did_you_mean(name, [field.name for field in fields(kind)])
        place = f"{source.file}:{_line_of(source, function, error, name)}"
        raise DesignError(f"{place}: {found[1]}.{name}: there is no such field{near}", name) from None


def _line_of(source: Source, function: str, error: Exception, name: str) -> int:
    """Returns the line of a design that an error is about.

    It is the first one that mentions the name: in the call that failed; else, if that call was not by a field's name, in the group of the
    error, in the design's function, or anywhere in the file. If none does, it is the line of the call, or of the function.

    Args:
        source: The file of the design.
        function: The name of the design.
        error: The error.
        name: The name that the error is about; empty for none.
    """
    tree = ast.parse(source.text)
    own = [one for one in tree.body if isinstance(one, ast.FunctionDef) and one.name == function]
    begin, end = next(
        ((one.lineno or 1, one.end_lineno or 1) for one in reversed(extract_tb(error.__traceback__)) if one.filename == source.file), (0, 0)
    )
    of_design = isinstance(error, DesignError)
    of_group = [_entries(nodes, error.group) for nodes in (own, [tree])] if of_design and error.group else []
    within = [line for line in _mentions([tree], name) if begin <= line <= end]
    elsewhere = [_mentions(nodes, name) for nodes in (*of_group, own, [tree])] if of_design or not begin else []
    lines = next((found for found in (within, *elsewhere) if found), list[int]())
    return min(lines, default=begin or next((one.lineno for one in own), 1))


def _mentions(nodes: Sequence[ast.AST], name: str) -> list[int]:
    """Returns the lines on which parts of a file mention a name as a text or as the name of an argument."""
    inside = [one for node in nodes for one in ast.walk(node)]
    texts = [one.lineno for one in inside if isinstance(one, ast.Constant) and name and one.value == name]
    return texts + [one.value.lineno for one in inside if isinstance(one, ast.keyword) and one.arg == name]


def _entries(nodes: Sequence[ast.AST], key: str) -> list[ast.expr]:
    """Returns the values that dictionaries in parts of a file have for a key."""
    inside = [one for node in nodes for one in ast.walk(node)]
    pairs = [pair for one in inside if isinstance(one, ast.Dict) for pair in zip(one.keys, one.values, strict=True)]
    return [value for name, value in pairs if isinstance(name, ast.Constant) and name.value == key]


def _marked(source: Source) -> list[str]:
    """Returns the names of the functions of a file that are marked by `design`, without running it."""
    try:
        tree = ast.parse(source.text)
    except SyntaxError:
        load_quietly(source)  # raises the error that names the line
        raise
    return [
        node.name for node in tree.body if isinstance(node, ast.FunctionDef) and any(last_name(d) == "design" for d in node.decorator_list)
    ]
