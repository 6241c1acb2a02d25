"""Every exception and warning of the library, and the «did you mean» hints of their messages."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from functools import lru_cache
from typing import Self

SAME_KIND = 0.1
"""How much more similar two names are that end with the same word."""


class Actr3dError(Exception):
    """The root of every error that this library raises on purpose."""

    location: tuple[str, int] | None = None
    """The file and line of the model that caused the error, if it is not the line that runs when the error is raised."""

    def at(self, file: str, line: int) -> Self:
        """Sets the location; returns the error."""
        self.location = file, line
        return self


class PatternException(Actr3dError):
    """A pattern cannot be parsed; the message quotes the pattern and the invalid text."""


class ChunkError(Actr3dError):
    """A chunk cannot be created or changed as requested: unknown contents, slot, or variable."""


class ProductionException(Actr3dError):
    """A production cannot be built: unknown module, unreadable body, missing source."""


class SchedulerError(Actr3dError):
    """A value was yielded or scheduled that the scheduler cannot wait for."""


class ParameterError(Actr3dError):
    """A parameter of a module, such as `Memory(latency=...)`, or an argument of a function has a wrong name, type or value.

    Code raises it where the object is made or the function is called. For the parameters of a model file, see `SettingError`.
    """


class ConfigurationError(Actr3dError):
    """A field of a configuration has a wrong name, type or value."""


class SettingError(ConfigurationError):
    """A user of a model file gave a parameter of its `build`, or a command-line option, a wrong name or value.

    It is raised before the model runs; the command then exits with 2. For the parameters of modules in a model's code, see
    `ParameterError`.
    """


class WorldError(Actr3dError):
    """A scene cannot be built, or an object or action in a world does not exist or is not possible."""


class MeshError(WorldError):
    """A mesh cannot be read, or is not suitable for a world."""


class SimulationError(Actr3dError):
    """A simulation cannot be set up, stepped or moved to a time as requested."""


class RecordingError(Actr3dError):
    """A recording cannot be written or read."""

    reason = ""
    """Why a file cannot be written, in a few words."""


class NotebookError(Actr3dError):
    """Something cannot be shown in a notebook."""


class UntrustedError(RecordingError):
    """A recording from another installation, or a changed one, was not run because the user has not trusted it."""


class GridError(Actr3dError):
    """A grid world cannot be created, or a body in it placed or moved as requested."""


class PlanError(Actr3dError):
    """A planning unit cannot be declared, started, interrupted or resumed as requested."""


class CameraError(Actr3dError):
    """A camera cannot be created, or cannot look: unknown eye or geom, poses that are missing or not finite."""


class VisionError(Actr3dError):
    """A vision module cannot be created, or cannot search as requested: unknown feature, slot, parameter or comparison."""


class ModelFileError(Actr3dError):
    """A model file cannot be loaded: missing, not Python 3, or not readable as text."""


class ExperimentError(Actr3dError):
    """An experiment cannot be set up, run or continued as requested."""


class DesignError(ExperimentError):
    """A design of an experiment is not valid.

    Args:
        message: What is wrong.
        name: The name in the design that is wrong, such as that of a factor; it leads to the line.
        group: The group whose value is wrong; empty for none.
    """

    def __init__(self, message: str, name: str = "", group: str = "") -> None:
        super().__init__(message)
        self.name = name
        self.group = group


class ModelWarning(UserWarning):
    """Something in a model is most likely not what its author intended.

    A warning never changes what the model does.
    """


WITHOUT_BODY = "an agent without a body needs neither build nor Simulation: its parameters are plain assignments at the top of the file"
"""The hint for users who build a simulation without a world."""


def reason_of(error: Exception) -> str:
    """Returns what an error says; of one of the operating system only the reason, such as `No space left on device`."""
    return error.strerror or str(error) if isinstance(error, OSError) else str(error)


def did_you_mean(word: str, known: Iterable[object], cutoff: float = 0.6) -> str:
    """Returns `"; did you mean 'x'?"` for the known name nearest to `word`, or an empty string."""
    near = nearest(word, tuple(sorted({str(name) for name in known} - {word})), cutoff)
    return f"; did you mean '{near}'?" if near is not None else ""


def followed(hint: str, rest: str) -> str:
    """Returns a hint and the sentence after it: `; did you mean 'x'? There are: x, y`; without a hint `; there are: x, y`."""
    return f"{hint} {rest[:1].upper()}{rest[1:]}" if hint else f"; {rest}"


def alternatives(word: object, known: Iterable[object], has: str = "there are:", also: Iterable[object] = ()) -> str:
    """Returns the known name nearest to `word`, if any is near, and all of them: `; did you mean 'x'? There are: x, y`.

    Args:
        word: The unknown name.
        known: The known names.
        has: The words before them.
        also: More names that may be meant, which are not listed.
    """
    names = [str(name) for name in known]
    hint = did_you_mean(word, [*names, *also]) if isinstance(word, str) else ""
    return followed(hint, f"{has} {', '.join(names) or 'none'}")


@lru_cache(maxsize=1024)
def nearest(word: str, names: tuple[str, ...], cutoff: float) -> str | None:
    """Returns the name that is most similar to `word`; None if no similarity (0 to 1) is at least `cutoff`.

    The last word of a name says what kind of thing it names: of names about equally similar, one with the same last word is preferred.
    """

    def similarity(name: str) -> float:
        return difflib.SequenceMatcher(None, name, word).ratio() + SAME_KIND * (_last_word(name) == _last_word(word))

    return max(sorted(difflib.get_close_matches(word, names, n=5, cutoff=cutoff)), key=similarity, default=None)


def _last_word(name: str) -> str:
    """Returns the last word of a name in CamelCase or snake_case: `Noise` of `DMNoise`."""
    return re.split(r"_|(?<=[a-zA-Z])(?=[A-Z][a-z])", name)[-1]


def hint_for(error: Exception, names: Iterable[object] = ()) -> str:
    """Returns `"; did you mean 'x'?"` for the unknown name or attribute in an error, or an empty string.

    Args:
        error: The error.
        names: The candidates for an unknown name.
    """
    if isinstance(error, NameError) and error.name:
        return did_you_mean(error.name, names)
    if isinstance(error, AttributeError) and error.name and error.obj is not None:
        return did_you_mean(error.name, [name for name in (*dir(error.obj), *vars(type(error.obj))) if name[0] != "_"])
    return ""
