"""Makes the tables and the command-line help of the manual from the registries and parsers of the code."""

from __future__ import annotations

import ast
import contextlib
import inspect
import io
import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple
from unittest import mock

import workbench_pages

import actr3d.actr
import actr3d.cli
import workbench.cli
from actr3d.actr import ACTR, BlendingMemory, Buffer, DMSpreading, Memory, MemorySubModule, Partial, ProceduralSubModule
from actr3d.change import CHANGES
from actr3d.experiment import find_measures
from actr3d.experiment.specification import library_designs, specify
from actr3d.motor import Motor
from actr3d.simulation import Simulation  # noqa: F401 # pyright: ignore[reportUnusedImport] # registers the sensor `view`
from actr3d.trace_kinds import KINDS
from actr3d.vision import DETECTORS
from actr3d.vision.feature import slot_names
from actr3d.world import Car, ImportedBody, Mannequin, Scene, World
from actr3d.world.anatomy import Embodied
from actr3d.world.body import ACTUATORS, SENSORS
from actr3d.world.command_registry import BodyFunction
from workbench.overlays import OVERLAYS

ROBOT = """<mujoco><worldbody><body name="base"><{joint} name="joint"/><geom size="0.1"/><site name="eye"/></body></worldbody>
  <actuator>{actuator}</actuator></mujoco>"""
BODIES: Mapping[str, Embodied] = {
    "mannequin": Mannequin(),
    "car": Car(),
    "imported": ImportedBody(name="plain", text=ROBOT.format(joint="joint", actuator="")),
    "imported with an eye": ImportedBody(name="seeing", text=ROBOT.format(joint="joint", actuator=""), eye="eye"),
    "imported with a free joint": ImportedBody(name="free", text=ROBOT.format(joint="freejoint", actuator="")),
    "imported with a motor": ImportedBody(name="motor", text=ROBOT.format(joint="joint", actuator='<motor joint="joint"/>')),
    "imported with a velocity servo": ImportedBody(name="servo", text=ROBOT.format(joint="joint", actuator='<velocity joint="joint"/>')),
}
"""Bodies by what they are called in the tables; of the imported ones, each has only what its name says."""
WALKER = tuple(Path(__file__).parents[2] / file for file in ("models/predictive_walker.py", "actr3d/world/gait.py"))
KINDS_OF_NUMBERS = ("fitted", "published", "chosen", "derived")
WORDS = {"fitted with": "fitted", "chosen": "chosen", "follows from": "derived"}
"""By a part of a number's docstring, of which kind it is; the others are published."""
COMMANDS = {"actr3d": actr3d.cli.main, "workbench": workbench.cli.main}
TABLES: dict[str, Callable[[], str]] = {}


def table(name: str) -> str:
    """Returns a table as Markdown.

    Raises:
        KeyError: If there is no such table.
    """
    return TABLES[name]()


def command_help(command: str) -> str:
    """Returns what a command prints with `--help`, as a block of text."""
    name, *words = command.split()
    out = io.StringIO()
    with mock.patch.dict(os.environ, {"COLUMNS": "100"}), contextlib.redirect_stdout(out), contextlib.suppress(SystemExit):
        COMMANDS[name]([*words, "--help"])
    return f"```text\n{out.getvalue().strip()}\n```"


def _registered(make: Callable[[], str]) -> Callable[[], str]:
    TABLES[make.__name__.replace("_", " ")] = make
    return make


def _rows(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Returns a Markdown table."""
    lines = [header, ["---"] * len(header), *([_cell(text) for text in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _cell(text: str) -> str:
    """Returns a text for a cell of a table: bars do not end it, and units in brackets are not links."""
    text = text.replace("|", "\\|")
    return text if text.startswith("`") else text.replace("[", "\\[")


def _code(text: str) -> str:
    return f"`{text}`" if text else ""


def _first_sentence(of: Callable[..., object]) -> str:
    return (inspect.getdoc(of) or "").partition("\n\n")[0].replace("\n", " ").partition(". ")[0].rstrip(".") + "."


def _body_functions(functions: Mapping[str, BodyFunction[Any]]) -> str:
    bodies = {called: World(Scene(parts=(part,))).bodies[part.name] for called, part in BODIES.items()}
    rows: list[Sequence[str]] = []
    for name, function in functions.items():
        has = [kind for kind, body in bodies.items() if function.available(body)]
        rows.append((_code(name), _code(function.takes), "any" if len(has) == len(bodies) else ", ".join(has), function.meaning))
    return _rows(("Name", "Arguments", "Bodies", "Meaning"), rows)


@_registered
def actuators() -> str:
    """Returns the table of all actuators."""
    return _body_functions(ACTUATORS)


@_registered
def sensors() -> str:
    """Returns the table of all sensors."""
    return _body_functions(SENSORS)


@_registered
def features() -> str:
    """Returns the table of all features that vision finds."""
    rows: list[Sequence[str]] = []
    for name, one in sorted(DETECTORS.items()):
        if one.builtin:
            slots = [*slot_names(one.finds), *(f"{other} (alias of {slot})" for other, slot in one.finds.aliases.items())]
            rows.append((_code(name), ", ".join(slots), ", ".join(map(_code, one.parameters))))
    return _rows(("Feature", "Slots", "Parameters of the request"), rows)


@_registered
def motor_commands() -> str:
    """Returns the table of all commands of the motor module: the public methods that return nothing, without the start of the module."""
    own = [method for name, method in vars(Motor).items() if not name.startswith("_") and inspect.isfunction(method)]
    commands = [method for method in own if inspect.signature(method).return_annotation == "None" and method is not Motor.start]
    rows: list[Sequence[str]] = []
    for command in commands:
        parameters = list(inspect.signature(command).parameters.values())[1:]
        takes = ", ".join(str(parameter.replace(annotation=inspect.Parameter.empty)) for parameter in parameters)
        rows.append((_code(f"{command.__name__}({takes})"), _first_sentence(command)))
    return _rows(("Command", "Meaning"), rows)


@_registered
def defaults() -> str:
    """Returns the table of the numbers of an agent, its memory and their modules where a model gives none."""
    spreading = DMSpreading(Memory(Buffer()))
    rows = [("an agent (`ACTR`)", _code(f"production_time={inspect.getattr_static(ACTR, 'production_time')}"))]
    for kind in (Memory, BlendingMemory, *_below(MemorySubModule), Partial, *_below(ProceduralSubModule)):
        given = inspect.signature(kind).parameters.values()
        numbers = [f"{one.name}={one.default}" for one in given if isinstance(one.default, (int, float))]
        numbers += [f"strength={spreading.strength}"] if kind is DMSpreading else []
        if numbers:
            rows.append((_code(kind.__name__), ", ".join(map(_code, numbers))))
    return _rows(("Of", "Defaults"), rows)


def _below(kind: type) -> list[type]:
    """Returns the classes of `actr3d.actr` that derive from a class."""
    return [one for _, one in inspect.getmembers(actr3d.actr, inspect.isclass) if issubclass(one, kind)]


@_registered
def changes() -> str:
    """Returns the table of all changes that a user can make by hand."""
    rows: list[Sequence[str]] = []
    for word, kind in CHANGES.items():
        takes = ", ".join(str(one.replace(annotation=one.empty)) for one in inspect.signature(kind).parameters.values())
        rows.append((_code(f"{word}({takes})"), _first_sentence(kind)))
    return _rows(("Command", "What it does"), rows)


@_registered
def measures() -> str:
    """Returns the table of all measures of the library."""
    rows = [(_code(name), _code(kind.__module__), _first_sentence(kind)) for name, kind in sorted(find_measures().items())]
    return _rows(("Measure", "Module", "What it measures"), rows)


@_registered
def designs() -> str:
    """Returns the table of all designs of the library."""
    rows = [(_code(name), specify(name).description.partition("\n\n")[0].replace("\n", " ")) for name in library_designs()]
    return _rows(("Design", "What it is"), rows)


@_registered
def overlays() -> str:
    """Returns the table of all overlays of the 3D view."""
    rows = [(kind.title, _first_sentence(kind)) for kind in OVERLAYS.values()]
    return _rows(("Overlay", "What it does"), rows)


@_registered
def parts_of_the_page() -> str:
    """Returns the table of the parts of the workbench's page."""
    return workbench_pages.table()


@_registered
def trace_kinds() -> str:
    """Returns the table of all kinds of trace events."""
    rows = [(_code(name), kind.level, kind.source, kind.data, kind.meaning) for name, kind in KINDS.items()]
    return _rows(("Kind", "Level", "Source", "Data", "Meaning"), rows)


@_registered
def numbers_of_the_walker() -> str:
    """Returns how many numbers the predictive walker and its gait have, and a table of them all, from their code."""
    found = sorted((row for file in WALKER for row in _numbers(file)), key=lambda row: KINDS_OF_NUMBERS.index(row.kind))
    counts = Counter[str]()
    for row in found:
        counts[row.kind] += len(row.names)
    text = ", ".join(f"{counts[kind]} {kind}" for kind in KINDS_OF_NUMBERS)
    rows = [(row.kind, row.file, ", ".join(map(_code, row.names)), _code(row.value), row.said) for row in found]
    return f"{text}.\n\n{_rows(('Kind', 'File', 'Names', 'Values', 'Meaning and source'), rows)}"


class _Number(NamedTuple):
    """One or more numbers that share a docstring."""

    kind: str
    file: str
    names: tuple[str, ...]
    value: str
    said: str


def _numbers(file: Path) -> Iterator[_Number]:
    """Yields the constants of a file, and the fields of its configurations, whose docstrings say where they are from."""
    body = ast.parse(file.read_text(encoding="utf-8")).body
    for block in (body, *(part.body for part in body if isinstance(part, ast.ClassDef))):
        names, values = list[str](), list[str]()
        for node in block:
            match node:
                case ast.Assign(targets=[ast.Name(id=name)]) if name.startswith("_"):
                    pass
                case ast.Assign(targets=[target], value=value) | ast.AnnAssign(target=target, value=ast.expr() as value):
                    parts = target.elts if isinstance(target, ast.Tuple) else [target]
                    names += map(ast.unparse, parts)
                    text = ast.unparse(value)
                    values.append(text[1:-1] if len(parts) > 1 else text if len(text) < 60 else f"{text[:50]} …")
                case ast.Expr(value=ast.Constant(value=str(said))) if names:
                    said = " ".join(said.split())
                    kind = next((kind for word, kind in WORDS.items() if word in said), "published")
                    if kind == "fitted" or ("Source:" in said and (block is body or file.name == "gait.py")):
                        yield _Number(kind, file.name, tuple(names), "; ".join(values), said)
                    names, values = [], []
                case _:
                    names, values = [], []
