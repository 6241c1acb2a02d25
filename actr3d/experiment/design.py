"""Designs of experiments: factors, participants and trials, and the table of trials that follows from them."""

from __future__ import annotations

import itertools
import math
import signal
import threading
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from random import Random
from typing import Annotated, Any, Literal, TypeVar, cast

from annotated_types import Ge, Gt

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError, DesignError, alternatives, did_you_mean
from actr3d.experiment.distributions import DIGITS, Distribution
from actr3d.experiment.plain_values import as_python, check_plain, plain_text
from actr3d.parameter_schema import Parameter

FAR = 1e-9
"""Probability in the tails of an unbounded distribution within which the bounds of a parameter are checked."""
MAX_TRIALS = 10_000_000
"""Maximum number of trials of an experiment."""
LONGEST_NAME = 100
"""Maximum number of bytes of the name of a measure, in UTF-8."""
LONGEST_TIMER = 1e8
"""A timer of the system cannot be much longer than this [s]."""
AGAIN = 1.0
"""The interval at which what has run out of time is ended again if it goes on [s]."""
OWN_COLUMNS = ("trial", "participant", "group", "position", "repetition", "seed", "end", "error", "versions", "wall_s", "worker")
"""The columns of every table of trials, whatever the design."""
RESERVED = ("value", "mean", "sd", "low", "high", "n", "trials", "measure", "unit", "source", "model", "beside", "end", "error")
"""Names of columns of human data and of the tables of a report; a factor with one of these names has an underscore added there: `n_`."""
OWN_NUMBERS = ("seed", "until", "limit")
"""Numbers of a design that `Design.changed` changes under these names."""


@dataclass(frozen=True, kw_only=True)
class Group(Configuration):
    """A group of participants."""

    participants: Annotated[int, Ge(1)] = 1
    """Their number."""
    parameters: Mapping[str, Any] = field(default_factory=dict[str, Any])
    """Values of the model's parameters. From a `Normal` or `Uniform`, one value is drawn for each participant."""

    def __post_init__(self) -> None:
        """Checks the values.

        Raises:
            ConfigurationError: If the number is out of bounds.
            DesignError: If a value cannot be stored.
        """
        super().__post_init__()
        _check_names(self.parameters, "Group.parameters")
        object.__setattr__(self, "parameters", {name: as_python(value) for name, value in self.parameters.items()})
        for name, value in self.parameters.items():
            check_plain(value, f"Group.parameters['{name}']", name, drawn=True)


@dataclass(frozen=True, kw_only=True)
class Measured(Configuration):
    """A measure of a trial: `Measured(name="latency", unit="s", over="block")`."""

    name: str
    """The name of its column, which is that of a variable of the program or a field of the model's measure."""
    unit: str | None = None
    """Its unit, such as `s`; None for that of its name's ending, such as `latency_s`, or none."""
    meaning: str = ""
    """What it means, for the list of columns."""
    over: str | None = None
    """What is numbered if a trial has a list of values, such as `block`; None if it has one value. The table of trials has a column for
    each number, `latency_1`, `latency_2`, ...; fits and reports take the number as another factor."""

    def __post_init__(self) -> None:
        """Checks the name, which is also that of files of a report.

        Raises:
            ConfigurationError: If a field has the wrong type.
            DesignError: If the name cannot be that of a column and of a file.
        """
        super().__post_init__()
        if self.over is not None:
            _check_names([self.over], "Measured.over")
        if not 0 < len(self.name.encode("utf-8", "surrogatepass")) <= LONGEST_NAME or "/" in self.name or not self.name.isprintable():
            right = f"1 to {LONGEST_NAME} bytes of printable characters without '/'"
            raise DesignError(f"measure: its name must be {right} (got {self.name[:LONGEST_NAME]!r})", "measures")

    def columns(self, value: Any) -> dict[str, Any]:
        """Returns the columns that a value fills.

        Raises:
            DesignError: If it must be a list, and is none.
        """
        if self.over is None:
            return {self.name: value}
        value = as_python(value)
        if not isinstance(value, (list, tuple)):
            raise DesignError(f"measure '{self.name}': must be a list, with a value for each {self.over} (got {value!r})", self.name)
        return {f"{self.name}_{number}": one for number, one in enumerate(cast("Sequence[Any]", value), start=1)}

    def values(self, row: Mapping[str, Any]) -> Iterator[tuple[dict[str, Any], Any]]:
        """Yields the values in a row of the table of trials, each with its number by the name of `over`."""
        if self.over is None:
            yield {}, row.get(self.name)
        else:
            numbers = itertools.takewhile(lambda number: f"{self.name}_{number}" in row, itertools.count(1))
            yield from (({self.over: number}, row[f"{self.name}_{number}"]) for number in numbers)


class _OutOfTime(BaseException):
    """A function of a design has not returned in time; it is no `Exception`, which such a function may catch."""


@dataclass(frozen=True, kw_only=True)
class Design(Configuration):
    """An experiment with a model.

    Each participant of each group does every combination of the factors' levels `trials` times; the model runs once for each trial.
    """

    model: str | None = None
    """The model file: beside the file of the design, or one of the library's own models; None for the file of the design itself."""
    factors: Mapping[str, Sequence[Any]] = field(default_factory=dict[str, Sequence[Any]])
    """The levels of each parameter that varies within participants."""
    groups: Mapping[str, Group] = field(default_factory=lambda: {"all": Group()})
    """The groups of participants by name."""
    settings: Mapping[str, Any] = field(default_factory=dict[str, Any])
    """Values of other parameters of the model. From a `Normal` or `Uniform`, a value is drawn for each trial."""
    trials: Annotated[int, Ge(1)] = 1
    """The number of trials of each participant in each combination of levels."""
    order: Literal["random", "fixed"] = "random"
    """The order of a participant's trials: drawn for each participant, or as the levels are listed."""
    derive: Callable[[Mapping[str, Any]], Mapping[str, Any]] | None = None
    """Computes more parameters of the model from the values of a trial, such as an aperture from a ratio and a shoulder width. A factor
    that it reads need not be a parameter of the model; it must not return a factor."""
    results: Callable[[Any], Mapping[str, Any]] | None = None
    """Computes the measures of a trial by name: from the simulation at its end, or from the module of a program that has run. None: the
    fields of the simulation's result, or the program's variables named by `measures`."""
    measures: Sequence[str | Measured] = ()
    """The measures to keep, or their names; empty to keep all of them."""
    until: Annotated[float, Gt(0)] = 60.0
    """The maximum simulated time of a trial [s]."""
    limit: Annotated[float, Gt(0)] = 600.0
    """The maximum wall time of a trial [s]: a trial that takes longer is ended, and counts as failed. The first one on a computer
    may have to compile the camera, which takes up to a minute. A `derive` that takes longer for the values of a trial is an error."""
    human: str | None = None
    """The name of human data of the library that the report shows beside the model's; see `actr3d.experiment.human_data`."""
    seed: int = 1
    """The seed of all that is drawn, and of all trials."""

    def __post_init__(self) -> None:
        """Checks what can be checked without the model.

        Raises:
            ConfigurationError: If a field has the wrong type, or is out of bounds.
            DesignError: If there is no trial, a parameter is given twice, or a value cannot be stored.
        """
        super().__post_init__()
        tidy: dict[str, Sequence[Any]] = {}
        for field_name in ("factors", "settings", "groups"):
            _check_names(getattr(self, field_name), f"Design.{field_name}")
        for field_name in ("factors", "settings"):
            object.__setattr__(self, field_name, {name: as_python(value) for name, value in getattr(self, field_name).items()})
        for name, levels in self.factors.items():
            given: Any = levels
            if isinstance(given, (str, bytes)) or not isinstance(given, Sequence):
                raise DesignError(f"Design.factors['{name}']: must be a list of levels (got {given!r})", name)
            if not given:
                raise DesignError(f"Design.factors['{name}']: must have at least one level (got {given!r})", name)
            for number, level in enumerate(levels):
                check_plain(level, f"Design.factors['{name}'][{number}]", name)
            # What `np.arange` gives for 0.3 is the level 0.3, as tables and human data have it.
            tidy[name] = [float(f"{one:.12g}") if type(one) is float else one for one in levels]
            for key, wrong in ((_key, "must name each level once"), (plain_text, "has two levels with the same text")):
                before: dict[Any, Any] = {}
                for level in tidy[name]:
                    if (same := key(level)) in before:
                        raise DesignError(f"Design.factors['{name}']: {wrong} (got {before[same]!r} and {level!r})", name)
                    before[same] = level
        object.__setattr__(self, "factors", tidy)
        for name, value in self.settings.items():
            check_plain(value, f"Design.settings['{name}']", name, drawn=True)
        if not self.groups:
            raise DesignError("Design.groups: must have at least one group (got {})", "groups")
        for name, group in cast("Mapping[str, Any]", self.groups).items():
            if not isinstance(group, Group):
                raise DesignError(f"Design.groups['{name}']: must be a Group (got {group!r})", name)
            for twice in self.factors.keys() & group.parameters.keys():
                raise DesignError(f"Design.groups['{name}']: '{twice}' is a factor already", twice)
        total = math.prod(map(len, self.factors.values())) * self.trials * sum(group.participants for group in self.groups.values())
        if total > MAX_TRIALS:
            raise DesignError(f"Design.trials: must give at most {MAX_TRIALS:,} trials in all (got {total:,})", "trials")
        for twice in self.settings.keys() & {*self.factors, *self.grouped}:
            raise DesignError(f"Design.settings: '{twice}' is already a factor, or a parameter of a group", twice)
        if isinstance(self.measures, (str, bytes)):
            raise DesignError(f"Design.measures: must be a list of names (got {self.measures!r})", "measures")
        given, columns = [one.name for one in self.kept], {*self.factors, *self.settings, *self.grouped, *OWN_COLUMNS}
        self.check_shown(given)
        for measure in self.kept:
            if given.count(measure.name) > 1:
                raise DesignError(f"Design.measures: '{measure.name}' is there twice", measure.name)
            if measure.name in columns:
                raise DesignError(f"Design.measures: '{measure.name}' is already a column of the trials; rename it", measure.name)
            if measure.over in columns:
                raise DesignError(f"Design.measures: '{measure.name}' is over '{measure.over}', which is another column", measure.name)
        for name in {*self.factors, *self.settings, *self.grouped}:
            if (name in OWN_COLUMNS and name != "group") or (name == "group" and name in self.factors):
                raise DesignError(f"Design: '{name}' is a column of every table of trials; rename the parameter", name)
            if name in OWN_NUMBERS:
                raise DesignError(f"Design: '{name}' is a number of the design itself; rename the parameter", name)

    @property
    def grouped(self) -> list[str]:
        """The names of the parameters of groups."""
        return list(dict.fromkeys(name for group in self.groups.values() for name in group.parameters))

    def check_shown(self, measures: Iterable[str]) -> None:
        """Checks that no column of reports has two meanings, as they add an underscore to some names; see `factor_name`.

        Args:
            measures: The names of all measures.

        Raises:
            DesignError: If a column has the name that reports give a factor, a measure, or that which a measure is over.
        """
        given = {*self.grouped, *self.settings}
        renamed = {*self.factors, *measures, *(one.over for one in self.kept if one.over is not None)}
        for name in sorted(renamed):
            if (shown := factor_name(name)) != name and shown in renamed | given:
                raise DesignError(f"Design: '{shown}' is what reports call '{name}'; rename one of them", shown)

    @property
    def kept(self) -> tuple[Measured, ...]:
        """The measures to keep; empty to keep all of them."""
        return tuple(one if isinstance(one, Measured) else Measured(name=one) for one in self.measures)

    def measure(self, name: str) -> Measured:
        """Returns the measure of that name; one that the design does not describe has one value in each trial."""
        return next((one for one in self.kept if one.name == name), Measured(name=name))

    # -- the table of trials

    @cached_property
    def cells(self) -> tuple[Mapping[str, Any], ...]:
        """All combinations of the factors' levels; the last factor varies fastest."""
        return tuple(dict(zip(self.factors, levels, strict=True)) for levels in itertools.product(*self.factors.values()))

    @cached_property
    def participants(self) -> tuple[Participant, ...]:
        """All participants, group by group."""
        found: list[Participant] = []
        for group_name, group in self.groups.items():
            for number in range(1, group.participants + 1):
                name = f"{group_name} {number}"
                drawn = {key: _value(value, f"{self.seed} {name} {key}") for key, value in group.parameters.items()}
                found.append(Participant(name=name, group=group_name, parameters=drawn))
        return tuple(found)

    @property
    def trials_of_each(self) -> int:
        """The number of trials of each participant."""
        return len(self.cells) * self.trials

    def __len__(self) -> int:
        """Returns the number of trials."""
        return self.trials_of_each * len(self.participants)

    def trial(self, number: int) -> Trial:
        """Returns a trial.

        Args:
            number: Its number, from 0: participant by participant, in the order in which they are done.

        Raises:
            DesignError: If there is no such trial, or `derive` fails.
        """
        trial = self.underived_trial(number)
        return replace(trial, values=self.derived(trial.values))

    def underived_trial(self, number: int) -> Trial:
        """Returns a trial without the values that `derive` computes.

        Raises:
            DesignError: If there is no such trial.
        """
        if not 0 <= number < len(self):
            raise DesignError(f"trial: must be a number from 0 to {len(self) - 1} (got {number})")
        who, position = divmod(number, self.trials_of_each)
        participant = self.participants[who]
        repetition, cell = divmod(_order(self, participant.name)[position], len(self.cells))
        levels = self.cells[cell]
        # The seed names the levels and not the number of the cell: another level of a factor changes no other trial.
        conditions = " ".join(f"{name}={value}" for name, value in levels.items())
        seed = " ".join(filter(None, [str(self.seed), participant.name, conditions, str(repetition + 1)]))
        drawn = {name: _value(value, f"{seed} {name}") for name, value in self.settings.items()}
        values = {**drawn, **participant.parameters, **levels}
        return Trial(number=number, participant=participant, position=position + 1, repetition=repetition + 1, values=values, seed=seed)

    def columns_of(self, number: int) -> dict[str, Any]:
        """Returns the columns of a trial that are known before it runs; without derived values if `derive` fails.

        Raises:
            DesignError: If there is no such trial.
        """
        trial = self.underived_trial(number)
        with suppress(DesignError), self._in_time():
            trial = replace(trial, values=self.derived(trial.values))
        return trial.columns

    @cached_property
    def known_columns(self) -> frozenset[str]:
        """The names of the columns of all trials that are known before they run; derived ones are those of a trial of each group."""
        found: set[str] = set()
        for group in self.groups:
            first = next(place for place, one in enumerate(self.participants) if one.group == group) * self.trials_of_each
            found.update(self.underived_trial(first).columns)
            for number in range(first, first + self.trials_of_each):
                with suppress(DesignError):
                    found.update(self.trial(number).columns)
                    break
        return frozenset(found)

    def derived(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Returns the values of a trial with those that `derive` computes from them.

        Raises:
            DesignError: If `derive` fails, or returns something else, a factor, or a value that cannot be stored.
        """
        if self.derive is None:
            return dict(values)
        try:
            more: Any = self.derive(values)
        except (Exception, SystemExit, _OutOfTime) as error:
            kind = "TimeoutError" if isinstance(error, _OutOfTime) else type(error).__name__
            raise DesignError(f"Design.derive: failed with {kind}: {error} (given {dict(values)!r})", "derive") from error
        if not isinstance(more, Mapping):
            raise DesignError(f"Design.derive: must return values by name (returned {more!r})", "derive")
        found = {str(name): as_python(value) for name, value in cast("Mapping[Any, Any]", more).items()}
        for name, value in found.items():
            if name in self.factors or (name in OWN_COLUMNS and name != "group"):
                what = "a factor" if name in self.factors else "a column of every table of trials"
                raise DesignError(f"Design.derive: must not return '{name}', which is {what}; give it another name", "derive")
            check_plain(value, f"Design.derive['{name}']", "derive")
        return {**values, **found}

    @contextmanager
    def _in_time(self) -> Generator[None]:
        """Ends `derive` inside the block at the limit of a trial, if this is the main thread: no other one can be ended. What runs trials
        ends those that take too long.

        Raises:
            _OutOfTime: If it has not returned then.
        """

        def end(*_: object) -> None:
            raise _OutOfTime(f"it did not return within {self.limit:g} s, the limit of a trial")

        if self.derive is None or threading.current_thread() is not threading.main_thread():
            yield
            return
        begin, before = time.monotonic(), signal.signal(signal.SIGALRM, end)
        left, interval = signal.setitimer(signal.ITIMER_REAL, min(self.limit, LONGEST_TIMER), AGAIN)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, max(left - (time.monotonic() - begin), 1e-3) if left else 0, interval)
            signal.signal(signal.SIGALRM, before)

    def table(self) -> Iterator[Trial]:
        """Yields all trials."""
        return map(self.trial, range(len(self)))

    # -- changes

    def changed(self, *, participants: int | None = None, trials: int | None = None, values: Mapping[str, Any] | None = None) -> Design:
        """Returns a copy with other numbers or values.

        Args:
            participants: The number of participants of each group; None to keep it.
            trials: The number of trials of each combination of levels; None to keep it.
            values: New levels of factors (a single value becomes the only level), or values of other parameters; also `seed`, `until`
                and `limit` of the design.

        Raises:
            ConfigurationError: If a value has the wrong type, or is out of bounds.
            DesignError: If no trial is left.
        """
        left = dict(values or {})
        own = {name: left.pop(name) for name in OWN_NUMBERS if name in left}
        factors = {name: _levels(left.pop(name), levels) if name in left else levels for name, levels in self.factors.items()}
        groups = {
            name: replace(
                group,
                participants=group.participants if participants is None else participants,
                parameters={key: left.get(key, value) for key, value in group.parameters.items()},
            )
            for name, group in self.groups.items()
        }
        settings = {**self.settings, **{name: value for name, value in left.items() if name not in self.grouped}}
        number = self.trials if trials is None else trials
        return replace(self, factors=factors, groups=groups, settings=settings, trials=number, **own)

    def changeable(self) -> dict[str, Any]:
        """Returns all that `changed` can change: numbers by their options, and values by name."""
        own = {name: getattr(self, name) for name in OWN_NUMBERS}
        of_groups: dict[str, dict[str, Any]] = {"--participants": {}}
        for group_name, group in self.groups.items():
            for name, value in {"--participants": group.participants, **group.parameters}.items():
                of_groups.setdefault(name, {})[group_name] = value
        return {**of_groups, "--trials": self.trials, **self.factors, **self.settings, **own}

    def changed_names(self, there: Design) -> list[str]:
        """Returns the names of the values that differ from those of another design, as in `changeable`."""
        before, now = there.changeable(), self.changeable()
        return [name for name in {**before, **now} if name not in before or name not in now or _key(before[name]) != _key(now[name])]

    def differences_from(self, there: Design) -> list[str]:
        """Returns in words which of the values that `changed` can change differ from those of another design ("there")."""
        found: list[str] = []
        for name in self.changed_names(there):
            before, now = (repr(given[name]) if name in given else "not set" for given in (there.changeable(), self.changeable()))
            found.append(f"{name}: {before} there, {now} now")
        return found

    # -- checks against the model

    def check(self, parameters: Sequence[Parameter], which: str = "") -> None:
        """Checks all values against the parameters of the model.

        Args:
            parameters: The parameters of the model.
            which: What they are, for the error of an unknown one.

        Raises:
            DesignError: If a name is not a parameter of the model, or a value is not allowed.
        """
        known = {parameter.name: parameter for parameter in parameters}
        given = {**self.settings, **self.factors, **dict.fromkeys(self.grouped)}
        read: set[str] = set()
        measured = {one.name for one in self.kept}
        drawn = any(isinstance(value, Distribution) for value in self.settings.values())
        examples = [{name: _example(value, p) for name, value in self.settings.items()} for p in ((FAR, 0.5, 1 - FAR) if drawn else (0.5,))]
        # What is the same for many participants or cells is checked once: a design may have a million of them.
        people = list({(one.group, repr(one.parameters)): one for one in reversed(self.participants)}.values())[::-1]
        pairs: Iterable[tuple[Participant, Mapping[str, Any]]] = itertools.product(people, self.cells)
        if self.derive is None:  # no value depends on another one
            single = [{name: level} for name, levels in self.factors.items() for level in levels]
            pairs = [*((one, {}) for one in people), *((people[0], one) for one in single)]
        for (participant, cell), example in itertools.product(pairs, examples):
            values = _ReadNames({**example, **participant.parameters, **cell}, read)
            with self._in_time():
                derived = self.derived(values)
            for name, value in derived.items():
                if name in measured:
                    raise DesignError(f"Design.measures: '{name}' is already a column of the trials; rename it", name)
                if name in known:
                    try:
                        known[name].check(value)
                    except ConfigurationError as error:
                        raise DesignError(f"Design, {participant.name}: {error}", name, participant.group) from None
                elif name not in given:
                    raise DesignError(f"Design.derive: the model has no parameter '{name}'{did_you_mean(name, known)}", "derive")
        for name in given:
            if name not in known and name not in read:
                raise DesignError(f"Design: the model has no parameter '{name}'{alternatives(name, known, 'it has:')}{which}", name)


@dataclass(frozen=True, kw_only=True)
class Participant:
    """A participant of an experiment."""

    name: str
    group: str
    parameters: Mapping[str, Any]
    """The values of the parameters of the group."""


@dataclass(frozen=True, kw_only=True)
class Trial:
    """A trial of a design."""

    number: int
    """Its number in the table of trials."""
    participant: Participant
    """The participant who does it."""
    position: int
    """Its place among the trials of its participant, from 1."""
    repetition: int
    """The number of the trial among the participant's trials of the same levels, from 1; a random order need not follow it."""
    values: Mapping[str, Any]
    """All values that the design gives, by name."""
    seed: str
    """The seed of its run."""

    @property
    def columns(self) -> dict[str, Any]:
        """Its columns in the table of trials that are known before it runs."""
        of = {"trial": self.number, "participant": self.participant.name, "group": self.participant.group}
        values = {name: value for name, value in self.values.items() if name not in of}
        return {**of, "position": self.position, "repetition": self.repetition, **values, "seed": self.seed}


D = TypeVar("D", bound=Callable[[], Design])


def design(function: D) -> D:
    """Marks a function without arguments that returns a `Design`; its name names the design, its docstring describes it."""
    function.__dict__["is_design"] = True
    return function


def is_design(value: object) -> bool:
    """Returns whether a value is a function marked by `design`."""
    return getattr(value, "is_design", False) is True


class _ReadNames(dict[str, Any]):
    """Values that store the names of those that are read."""

    def __init__(self, values: Mapping[str, Any], read: set[str]) -> None:
        super().__init__(values)
        self._read = read

    def __getitem__(self, name: str) -> Any:
        self._read.add(name)
        return super().__getitem__(name)

    def get(self, name: str, default: Any = None) -> Any:
        self._read.add(name)
        return super().get(name, default)


def _value(value: Any, seed: str) -> Any:
    """Returns a value, or one that is drawn from it if it is a distribution."""
    return _example(value, Random(seed).random()) if isinstance(value, Distribution) else value


def _example(value: Any, p: float) -> Any:
    return round(as_python(value.quantile(p)), DIGITS) if isinstance(value, Distribution) else value


def _check_names(names: Iterable[Any], where: str) -> None:
    """Checks that names can be those of columns and conditions.

    Raises:
        DesignError: If one is no text, is empty, or has characters that cannot be printed.
    """
    for name in names:
        if not isinstance(name, str) or not name or not name.isprintable():
            raise DesignError(f"{where}: names must be non-empty strings of printable characters (got {name!r})", where.rpartition(".")[2])


def factor_name(name: str) -> str:
    """Returns the name of a factor in human data and in the tables of a report."""
    return f"{name}_" if name in RESERVED else name


def _key(value: Any) -> Any:
    """Returns a key by which values are compared: 1 and 1.0 have equal keys, 1 and True have not."""
    if isinstance(value, (list, tuple)):
        return tuple(map(_key, cast("Sequence[Any]", value)))
    if isinstance(value, Mapping):
        return tuple((name, _key(one)) for name, one in cast("Mapping[str, Any]", value).items())
    if isinstance(value, Distribution) and not isinstance(value, Configuration):  # whose text may be its address in memory
        return (type(value).__name__, *(value.quantile(p) for p in (0.1, 0.5, 0.9)))
    return value if isinstance(value, (int, float)) and not isinstance(value, bool) else repr(value)


def _levels(value: Any, before: Sequence[Any]) -> Sequence[Any]:
    """Returns new levels of a factor. One that equals a level before has its type (0 becomes 0.0), so that its trials stay the same."""
    levels = cast("Sequence[Any]", value) if isinstance(value, (list, tuple)) else [value]
    known = {(level, isinstance(level, bool)): level for level in before if isinstance(level, (int, float))}
    return [known.get((level, isinstance(level, bool)), level) if isinstance(level, (int, float)) else level for level in levels]


@lru_cache(maxsize=4)
def _random_order(seed: int, name: str, length: int) -> tuple[int, ...]:
    order = list(range(length))
    Random(f"{seed} {name} order").shuffle(order)
    return tuple(order)


def _order(of: Design, name: str) -> Sequence[int]:
    """Returns the indices of a participant's trials in the order in which they are done. Index n is cell n modulo the number of cells."""
    return range(of.trials_of_each) if of.order == "fixed" else _random_order(of.seed, name, of.trials_of_each)
