"""Human data: published means, and trials of single participants, from CSV files.

A file has a header and one of two forms. In both, the columns `group` and those with the names of the design's factors are
conditions; a missing one stands for all of its values.

| form | columns besides the conditions |
|---|---|
| published means | `measure`, `mean`; if known `sd`, `n` (participants) and `source` |
| trials | `participant`; every other column is a measure, empty where it was not taken |

The files of the library, in `actr3d/experiment/human/`, are published means, named by `Design.human`.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from statistics import fmean, stdev
from typing import Annotated, Any

from annotated_types import Ge

from actr3d.configuration import Configuration
from actr3d.errors import ExperimentError, did_you_mean

LIBRARY = Path(__file__).parent / "human"
"""The folder of the library's own human data."""
OF_MEANS = ("measure", "mean", "sd", "n", "source")
"""The columns of published means besides the conditions."""
SHOWN = 10
"""The number of errors of a file that are reported at once."""

_Cell = tuple[tuple[str, Any], ...]


@dataclass(frozen=True, kw_only=True)
class PublishedMean(Configuration):
    """The mean of a measure in one condition, over participants."""

    conditions: Mapping[str, Any] = field(default_factory=dict[str, Any])
    """The group, and the levels of factors."""
    measure: str
    mean: float
    sd: Annotated[float, Ge(0)] | None = None
    """The standard deviation between participants; None if it is not known."""
    n: Annotated[int, Ge(1)] | None = None
    """The number of participants; None if it is not known."""
    source: str = ""


def library_data() -> dict[str, Path]:
    """Returns the files of the library's human data by name."""
    return {path.stem: path for path in sorted(LIBRARY.glob("*.csv"))}


def load_means(name: str | Path, factors: Collection[str]) -> tuple[PublishedMean, ...]:
    """Loads human data as means by condition; means of trials are those of the participants' means.

    Args:
        name: The name of data of the library, or a file.
        factors: The names of the design's factors.

    Raises:
        ExperimentError: If there are no such data, or the file is not valid: names the file, and each line and column that is wrong.
    """
    known = library_data()
    path = known.get(str(name), Path(name))
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        near = "" if path.suffix else did_you_mean(str(name), known)
        why = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text"
        raise ExperimentError(f"human data '{name}': cannot be read ({why}){near}; the library has: {', '.join(known) or 'none'}") from None
    return _Reader(str(path), text, {"group", *factors}).means()


class _Reader:
    """Reads one file, and collects what is wrong with it."""

    def __init__(self, file: str, text: str, conditions: set[str]) -> None:
        self._file = file
        self._errors: list[str] = []
        reader = csv.reader(io.StringIO(text))
        first: list[str] = next(iter(reader), list[str]())
        self._header = [name.strip() for name in first]
        self._rows = [(reader.line_num, row) for row in reader if any(cell.strip() for cell in row)]
        self._conditions = [name for name in self._header if name in conditions]
        self._all_conditions = conditions

    def means(self) -> tuple[PublishedMean, ...]:
        """Returns the means of the file.

        Raises:
            ExperimentError: If the file is not valid.
        """
        doubled = sorted({name for name in self._header if self._header.count(name) > 1})
        if doubled:
            raise ExperimentError(f"{self._file}:1: has two columns '{doubled[0]}'")
        if not self._rows:
            raise ExperimentError(f"{self._file}: must have a header and at least one row (found {len(self._header)} columns and no rows)")
        if "mean" in self._header:
            found = self._published()
        elif "participant" in self._header:
            found = self._of_trials()
        else:
            raise ExperimentError(
                f"{self._file}:1: must have the column 'mean' (published means) or 'participant' (trials); found: {', '.join(self._header)}"
            )
        if self._errors:
            more = f"\n... and {len(self._errors) - SHOWN} more" if len(self._errors) > SHOWN else ""
            raise ExperimentError("\n".join(self._errors[:SHOWN]) + more)
        return found

    def _published(self) -> tuple[PublishedMean, ...]:
        unknown = [name for name in self._header if name not in {*OF_MEANS, *self._conditions}]
        if unknown or "measure" not in self._header:
            wrong = f"column '{unknown[0]}' is not a condition of the design" if unknown else "the column 'measure' is missing"
            near = did_you_mean(unknown[0], self._all_conditions | {*OF_MEANS}) if unknown else ""
            raise ExperimentError(f"{self._file}:1: {wrong}{near}; conditions: {', '.join(sorted(self._all_conditions))}")
        found: list[PublishedMean] = []
        for line, row in self._records():
            mean = self._number(line, row, "mean")
            sd, n = (self._number(line, row, name) if row.get(name) else None for name in ("sd", "n"))
            if not row["measure"]:
                self._wrong(line, "measure", "", "the name of a measure")
            if mean is None:
                if not row["mean"]:
                    self._wrong(line, "mean", "", "a number")
                continue
            if sd is not None and sd < 0:
                self._wrong(line, "sd", row["sd"], "a number >= 0")
            elif n is not None and (n < 1 or n != int(n)):
                self._wrong(line, "n", row["n"], "a whole number >= 1")
            else:
                conditions = {name: value_of(row[name]) for name in self._conditions if row[name]}
                source, count = row.get("source", ""), None if n is None else int(n)
                found.append(PublishedMean(conditions=conditions, measure=row["measure"], mean=mean, sd=sd, n=count, source=source))
        return tuple(found)

    def _of_trials(self) -> tuple[PublishedMean, ...]:
        measures = [name for name in self._header if name not in {"participant", "trial", "source", *self._conditions}]
        if not measures:
            raise ExperimentError(f"{self._file}:1: has no measure: a column besides participant and conditions")
        values: dict[tuple[str, _Cell], dict[str, list[float]]] = {}
        for line, row in self._records():
            if not row["participant"]:
                self._wrong(line, "participant", "", "the name of a participant")
            cell = tuple((name, value_of(row[name])) for name in self._conditions if row[name])
            for name in measures:
                if row[name] and (value := self._number(line, row, name)) is not None:
                    values.setdefault((name, cell), {}).setdefault(row["participant"], []).append(value)
        found: list[PublishedMean] = []
        for (name, cell), people in values.items():
            means = [fmean(trials) for trials in people.values()]
            sd, source = stdev(means) if len(means) > 1 else None, Path(self._file).name
            found.append(PublishedMean(conditions=dict(cell), measure=name, mean=fmean(means), sd=sd, n=len(means), source=source))
        return tuple(found)

    def _records(self) -> list[tuple[int, dict[str, str]]]:
        found: list[tuple[int, dict[str, str]]] = []
        for line, row in self._rows:
            if len(row) != len(self._header):
                self._errors.append(f"{self._file}:{line}: must have {len(self._header)} values, one for each column (has {len(row)})")
            else:
                found.append((line, {name: cell.strip() for name, cell in zip(self._header, row, strict=True)}))
        return found

    def _number(self, line: int, row: Mapping[str, str], column: str) -> float | None:
        try:
            value = float(row[column])
        except ValueError:
            value = math.nan
        if math.isfinite(value):
            return value
        if row[column]:
            self._wrong(line, column, row[column], "a number")
        return None

    def _wrong(self, line: int, column: str, given: str, right: str) -> None:
        self._errors.append(f"{self._file}:{line}: column '{column}': must be {right} (got {given!r})")


def value_of(text: str) -> Any:
    """Returns the value of a cell: a number, True or False, or else the text."""
    if text in ("True", "False"):
        return text == "True"
    for kind in (int, float):
        try:
            value = kind(text)
        except ValueError:
            continue
        return value if math.isfinite(value) else text
    return text
