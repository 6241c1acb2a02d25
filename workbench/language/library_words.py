"""The words that the library gives to models: what bodies do and sense, what vision finds, and the slots of these answers."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

from actr3d import actr, world
from actr3d.actr.declarative.activation import MemorySubModule
from actr3d.actr.kernel.hooks import is_hook
from actr3d.actr.kernel.model import Model
from actr3d.actr.lint.slot_inference import slots_of
from actr3d.actr.procedural.production import defaults_of
from actr3d.actr.procedural.production_system import ProductionSystem
from actr3d.motor import Motor
from actr3d.simulation import Simulation  # noqa: F401 # pyright: ignore[reportUnusedImport] # registers the sensor `view`
from actr3d.vision import DETECTORS
from actr3d.vision.feature import slot_names
from actr3d.world.bodies.mannequin_limits import LIMITS
from actr3d.world.body import ACTUATORS, SENSORS
from workbench.language.field_texts import parameter_text, texts_of


@dataclass(frozen=True, kw_only=True)
class Word:
    """A word that begins a request, a command or a chunk."""

    word: str
    text: str
    takes: str = ""
    """Its arguments."""
    slots: dict[str, str] = dataclasses.field(default_factory=dict[str, str])
    """The slots of the chunk that answers it, with their meanings."""
    conditions: dict[str, str] = dataclasses.field(default_factory=dict[str, str])
    """The other keyword arguments of a request for it, with their meanings: other names of slots, and parameters."""


@cache
def commands() -> tuple[Word, ...]:
    """Returns the commands of bodies."""
    return tuple(Word(word=name, text=one.meaning, takes=one.takes) for name, one in sorted(ACTUATORS.items()))


@cache
def senses() -> tuple[Word, ...]:
    """Returns what bodies sense."""
    found: list[Word] = []
    for name, one in sorted(SENSORS.items()):
        kind = one.returns
        slots: dict[str, str] = {}
        if isinstance(kind, type) and dataclasses.is_dataclass(kind):
            texts = texts_of(kind)
            slots = {field.name: texts.get(field.name, "") for field in dataclasses.fields(kind)}
        found.append(Word(word=name, text=one.meaning, takes=one.takes, slots=slots))
    return tuple(found)


@cache
def features() -> tuple[Word, ...]:
    """Returns what vision finds."""
    found: list[Word] = []
    for name, one in sorted(DETECTORS.items()):
        texts = texts_of(one.finds)
        slots = {slot: texts.get(slot, "") for slot in slot_names(one.finds)}
        conditions = {other: f"{slot}: {slots[slot]}".rstrip(": ") for other, slot in one.finds.aliases.items()}
        conditions |= {given: parameter_text(inspect.getdoc(one.detect) or "", given) for given in one.parameters}
        found.append(Word(word=name, text=(one.finds.__doc__ or "").split("\n\n")[0], slots=slots, conditions=conditions))
    return tuple(found)


@cache
def scene_parts() -> tuple[Word, ...]:
    """Returns the kinds of parts of a scene."""
    names: list[str] = vars(world)["__all__"]
    kinds = {name: getattr(world, name) for name in names}
    return tuple(Word(word=name, text=(kind.__doc__ or "").split("\n\n")[0]) for name, kind in kinds.items() if hasattr(kind, "add_to"))


def words_for(kind: str, method: str) -> tuple[Word, ...]:
    """Returns the words that may begin the text of a module's method."""
    if kind == "BodyPort":
        return commands() if method == "set" else senses()
    return ()


def answers_of(kind: str) -> tuple[Word, ...]:
    """Returns the chunks that a module puts into its buffer."""
    return senses() if kind == "BodyPort" else ()


def features_of(kind: str) -> tuple[Word, ...]:
    """Returns the features that a module searches for, which its requests and chunks name in the slot `feature`."""
    return features() if kind == "Vision" else ()


@cache
def joints() -> frozenset[str]:
    """Returns the names of the joints of the library's persons, which the motor module's chunks have as slots."""
    return frozenset(f"{side}{part}_{axis}" for part, axes in LIMITS.items() for axis in axes for side in ("", "left_", "right_"))


def gives_joints(kind: type) -> bool:
    """Returns whether a class of the library gives chunks the joints of a body as slots, of which a text knows nothing."""
    return issubclass(kind, Motor)


def slots_given(kind: type) -> set[str]:
    """Returns the slots that a class of the library gives to chunks, itself or by the buffers that its agents have."""
    members = [one for base in kind.__mro__ for one in vars(base).values() if isinstance(one, Model)]
    own = slots_of(kind) if issubclass(kind, Model) else ()
    return {*own, *(slot for one in members for slot in slots_of(type(one)))}


def is_called_by_library(kind: type, name: str) -> bool:
    """Returns whether a method of one of the library's classes is called by the library alone: a hook or a production."""
    if is_hook(kind, name):
        return True
    found = inspect.getattr_static(kind, name, None)
    return issubclass(kind, ProductionSystem) and inspect.isfunction(found) and defaults_of(found) is not None


def only_reads(kinds: Iterable[str]) -> bool:
    """Returns whether a part of these classes only reads the buffers that it is made with: an activation module, unlike its memory."""
    found = (getattr(actr, kind, None) for kind in kinds)
    return any(isinstance(kind, type) and issubclass(kind, MemorySubModule) for kind in found)
