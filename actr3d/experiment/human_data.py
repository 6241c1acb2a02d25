"""Human data: tables of trials of people, and published means, that reports show beside those of a model.

Both are CSV files (UTF-8, a line of names, then one row a line). Lines that begin with `#` are notes, which the report shows. Factors,
groups and measures have the names that they have in the design and in the table of trials; `columns.csv` in the folder of an experiment
lists them with their units. If the table of trials has numbered columns of a measure, such as `latency_1`, `latency_2`, the measure is one
column here, `latency`, and what is numbered, such as `block`, is a factor with its own column. A level of a parameter of the model must be
within its bounds. A factor with the name of another column here or in the tables of a report has an underscore added, such as `n_`; these
names are `value`, `mean`, `sd`, `low`, `high`, `n`, `trials`, `measure`, `unit`, `source`, `model`, `beside`, `end` and `error`. If not all
levels of a factor are numbers, all of them are texts: `True`, `none`, `fast`.
An empty cell is a value that is missing. The table of trials of an experiment, `trials.csv`, can be read as trials of people.

**Trials** have the columns

- `participant`: a name or number, unique in its group;
- `group`: the name of a group of the design; may be left out if the design has one group;
- a column for each factor of the design, such as `aperture`, `ratio` or `condition`; without one, or with one that is all empty, the data
  are means over its levels;
- a column for each measure, such as `wall_angle_deg` or `speed_m_s`; at least one. `True` counts as 1, `False` as 0;
- columns that an analysis reads: for walks through apertures `shoulder_width` [m], or `ratio`, the aperture divided by it. Figures by A/S
  show people at their own ratios, and only if these are known. Other columns of the table of trials are not used.

**Published means** have the columns

- `group`, and a column for each factor, as above; an empty cell is a mean over all groups or levels;
- `measure`: the name of a measure;
- `mean`, `sd` (between participants) and `n` (participants); `sd` and `n` may be empty; one mean for the same conditions;
- `source`: where the mean is printed.

The published means of the library's own designs are the files of the folder `human` beside this module; `Design.human` names one.
"""

from __future__ import annotations

import csv
import io
import math
import os
import stat
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from actr3d.errors import ConfigurationError, ExperimentError, alternatives, did_you_mean, reason_of
from actr3d.experiment.design import factor_name
from actr3d.experiment.plain_values import HUGE, plain_text
from actr3d.parameter_schema import Parameter
from actr3d.values import shortened

FOLDER = Path(__file__).parent / "human"
"""The folder of the library's published means."""
SHOWN = 20
"""The maximum number of errors that are named at a time."""
LONGEST_GIVEN = 80
"""How many characters of a cell an error shows."""
MAX_BYTES = 256 * 1024 * 1024
"""The maximum size of a file: some two million trials."""
PATIENCE = 5.0
"""The maximum time in which a program must open a pipe to write human data to it [s]; then it may take as long as it needs."""
OF_MEANS = ("measure", "mean", "sd", "n", "source")
"""The columns of published means that are not factors."""


def plain_levels(levels: Sequence[Any]) -> list[float] | list[str]:
    """Returns the levels of a factor as numbers if all of them are numbers, else as texts."""
    if all(isinstance(level, (int, float)) and not isinstance(level, bool) for level in levels):
        return [float(level) for level in levels]
    return [plain_text(level) for level in levels]


def absent_levels(written: Sequence[Any], levels: Sequence[Any]) -> list[str]:
    """Returns the levels of a factor that the file of a design has and an experiment has not.

    Returns none for a factor whose levels are numbers: people may have any number there.
    """
    if not isinstance(plain_levels([*written, *levels])[0], str):
        return []
    there = set(map(plain_text, levels))
    return [text for text in map(plain_text, written) if text not in there]


@dataclass(frozen=True, kw_only=True)
class HumanData:
    """Human data that were checked against a design."""

    name: str
    """The name of the file."""
    published: bool
    """Whether the rows are published means; else they are trials."""
    rows: Sequence[Mapping[str, Any]]
    """The rows: factors are numbers or texts as in the design, or None; numbers are floats or None."""
    measures: Sequence[str]
    """The measures that they have."""
    numbers: Sequence[str] = ()
    """The other columns of trials that an analysis reads; see `Schema.numbers`."""
    notes: Sequence[str]
    """The notes of the file."""

    @property
    def sources(self) -> list[str]:
        """The sources of published means, each once."""
        return list(dict.fromkeys(row["source"] for row in self.rows)) if self.published else []


@dataclass(frozen=True, kw_only=True)
class Schema:
    """What the columns of human data may hold for an experiment."""

    groups: Sequence[str]
    factors: Mapping[str, Sequence[float] | Sequence[str]]
    """The factors of the design, and their levels: all numbers, or all texts."""
    measures: Sequence[str]
    absent: Mapping[str, Sequence[str]] = field(default_factory=dict[str, "Sequence[str]"])
    """Other levels that people may have; see `absent_levels`. Rows with one of them are left out."""
    parameters: Mapping[str, Parameter] = field(default_factory=dict[str, Parameter])
    """The parameters of the model that the factors and `numbers` are; values of people must be within their bounds."""
    switches: Sequence[str] = ()
    """The measures that are True or False, whose means are proportions."""
    numbers: Sequence[str] = ()
    """Other columns with numbers that trials of people may have, because an analysis reads them, such as `shoulder_width`."""
    ignored: Sequence[str] = ()
    """Other columns of the table of trials, which data of people may have, too. They are not used."""


def library_human_data() -> dict[str, Path]:
    """Returns the files of the library's published means by name."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.csv"))}


def _text(path: Path | str) -> str:
    """Returns the text of a file of human data.

    Raises:
        ExperimentError: If it cannot be read.
    """
    try:
        data = _bytes(path)
        if len(data) <= MAX_BYTES:
            return data.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
        why = f"it has more than {MAX_BYTES:,} bytes"
    except IsADirectoryError:
        why = "it is a folder; name a file"
    except (OSError, UnicodeDecodeError) as error:
        why = reason_of(error) if isinstance(error, OSError) else "it is not UTF-8"
    raise ExperimentError(f"{path}: cannot be read as human data ({why})")


def _bytes(path: Path | str) -> bytes:
    """Returns what a file holds, or a pipe receives, up to one byte more than is allowed.

    Raises:
        OSError: If it cannot be read, or is a pipe to which nothing is written in time.
    """
    with open(path, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK)) as file:
        begin: bytes | None = b""
        if stat.S_ISFIFO(os.fstat(file.fileno()).st_mode):
            end = time.monotonic() + PATIENCE
            # Without a writer, reading returns nothing at once; with one that has not written yet, it returns None.
            while (begin := file.raw.read(1)) == b"":
                if time.monotonic() > end:
                    raise OSError(f"it is a pipe, and nothing was written to it within {PATIENCE:g} s")
                time.sleep(0.02)
        os.set_blocking(file.fileno(), True)
        begin = begin or b""
        return begin + file.read(MAX_BYTES + 1 - len(begin))


class HumanFile:
    """A file of human data, and its errors.

    Raises:
        ExperimentError: If it cannot be read, or is not CSV.
    """

    def __init__(self, path: Path | str) -> None:
        self._path = str(path)
        self._schema = Schema(groups=(), factors={}, measures=())
        self._errors: list[str] = []
        self._notes: list[str] = []
        self._lines: list[tuple[int, list[str]]] = []
        reader, end = csv.reader(io.StringIO(_text(path))), 0
        try:
            for cells in reader:
                line, end = end + 1, reader.line_num  # a cell in quotes may have several lines
                if cells and cells[0].lstrip().startswith("#"):
                    if self._lines and 1 < len(cells) == len(self._lines[0][1]):
                        where = f"{path}:{line}"
                        self._errors.append(
                            f"{where}: begins with '#', as a note does: rename {cells[0]!r}, or write notes above the first line"
                        )
                    self._notes.append(",".join(cells).strip().lstrip("#").strip())
                elif any(cell.strip() for cell in cells):
                    self._lines.append((line, [cell.strip() for cell in cells]))
        except csv.Error as error:
            raise ExperimentError(f"{path}:{end + 1}: is not CSV ({error})") from None

    @property
    def columns(self) -> Sequence[str]:
        """The names of the columns; none if the file is empty."""
        return self._lines[0][1] if self._lines else ()

    def cells(self, column: str) -> list[str]:
        """Returns the cells of a column that is there; those of lines that are too short are left out."""
        place = self.columns.index(column)
        return [cells[place] for _, cells in self._lines[1:] if len(cells) > place]

    def is_published(self, measures: Sequence[str]) -> bool:
        """Returns whether the file has published means: the columns `measure` or `mean`, unless these are measures in trials of people."""
        names = set(self.columns) & {"measure", "mean"}
        return bool(names - set(measures) if "participant" in self.columns else names)

    def read(self, schema: Schema) -> HumanData:
        """Returns the data.

        Args:
            schema: What its columns may hold.

        Raises:
            ExperimentError: If the file does not follow the schema. Names up to `SHOWN` errors; each names file, line and column, what was
                given and what would be right.
        """
        self._schema = schema
        if not self._lines:
            raise ExperimentError(f"{self._path}: is empty; the first line must name the columns")
        line, head = self._lines[0]
        published = self.is_published(schema.measures)
        if not published:  # the table of trials has factors by their own names
            head = [shown if (shown := factor_name(name)) in self._schema.factors else name for name in head]
        self._check_head(line, head, published)
        rows = {number: row for number, cells in self._lines[1:] if (row := self._row(number, head, cells, published)) is not None}
        if not self._errors and rows:
            self._check_rows(head, rows, published)
        # A file of published means without rows says in its notes that none are known.
        if not self._errors and not rows and not (published and self._notes):
            self._errors.append(f"{self._path}:{line}: no row follows the names of the columns")
        if self._errors:
            more = len(self._errors) - SHOWN
            raise ExperimentError("\n".join([*self._errors[:SHOWN], *([f"... and {more} more errors"] if more > 0 else [])]))
        absent = [self._absent_in(row) for row in rows.values()]
        if left_out := sum(map(bool, absent)):
            these = ", ".join(dict.fromkeys(text for text in absent if text))
            count = "1 row is" if left_out == 1 else f"{left_out:,} rows are"
            self._notes.append(f"{count} left out: the experiment has no {these}.")
            rows = {line: row for (line, row), text in zip(rows.items(), absent, strict=True) if not text}
        measures = [
            one for one in self._schema.measures if (any(row["measure"] == one for row in rows.values()) if published else one in head)
        ]
        if unused := [name for name in head if name in self._schema.ignored]:
            self._notes.append(f"Columns that are not used: {', '.join(unused)}.")
        numbers = [name for name in self._schema.numbers if name in head and not published]
        return HumanData(
            name=Path(self._path).name, published=published, rows=list(rows.values()), measures=measures, numbers=numbers, notes=self._notes
        )

    def _absent_in(self, row: Mapping[str, Any]) -> str:
        """Returns a factor with its level in a row that the experiment does not have; "" for none."""
        absent = self._schema.absent.items()
        return next((f"{name} '{row[name]}'" for name, levels in absent if row[name] in levels), "")

    def _check_rows(self, head: list[str], rows: Mapping[int, Mapping[str, Any]], published: bool) -> None:
        """Checks the rows together.

        Published means must have one mean for the same conditions. In trials, a factor must be given in all rows or in none, and some row
        must have a value of a measure.
        """
        factors = list(self._schema.factors)
        if published:
            seen: dict[tuple[Any, ...], int] = {}
            for line, row in rows.items():
                first = seen.setdefault(tuple(row[name] for name in ("group", *factors, "measure")), line)
                if first != line:
                    self._errors.append(f"{self._path}:{line}: is a second mean of '{row['measure']}' for the conditions of line {first}")
            return
        for name in factors:
            if any(row[name] is not None for row in rows.values()):
                for line, row in rows.items():
                    if row[name] is None:
                        self._add(line, name, "", "given, as in other rows; without the column, the data are means over its levels")
        measures = [name for name in self._schema.measures if name in head]
        if all(row[name] is None for row in rows.values() for name in measures):
            self._errors.append(f"{self._path}: no row has a value of a measure: {', '.join(measures)}")

    def _check_head(self, line: int, head: list[str], published: bool) -> None:
        """Checks the names of the columns."""
        schema, where = self._schema, f"{self._path}:{line}"
        measures, numbers = ([], []) if published else (list(schema.measures), list(schema.numbers))
        known = [*(["group", *OF_MEANS] if published else ["participant", "group"]), *schema.factors, *measures, *numbers]
        accepted = known if published else [*known, *schema.ignored]
        if len(head) == 1 and (";" in head[0] or "\t" in head[0]):
            raise ExperimentError(f"{where}: the columns must be separated by commas (got {head[0]!r})")
        wrong = [f"{where}: column '{name}' is there twice" for name in dict.fromkeys(head) if head.count(name) > 1]
        wrong += [f"{where}: unknown column '{name}'{alternatives(name, known, 'there may be:')}" for name in head if name not in accepted]
        needed = ["measure", "mean", "source"] if published else ["participant"]
        needed += ["group"] if not published and len(schema.groups) > 1 else []
        wrong += [f"{where}: column '{name}' is missing; {self._form(published)}" for name in needed if name not in head]
        if not published and not any(name in measures for name in head):
            wrong.append(f"{where}: no column is a measure; there may be: {', '.join(measures)}")
        if wrong:
            raise ExperimentError("\n".join(wrong))

    @staticmethod
    def _form(published: bool) -> str:
        if published:
            return "published means need: measure, mean, source, and may have group, factors, sd, n"
        return "trials need: participant, group, factors and measures; published means: group, factors, measure, mean, sd, n, source"

    def _row(self, line: int, head: list[str], cells: list[str], published: bool) -> dict[str, Any] | None:
        if len(cells) != len(head):
            hint = "; a quote that begins in it may not be closed" if any("\n" in cell or "," in cell for cell in cells) else ""
            self._errors.append(f"{self._path}:{line}: must have {len(head)} cells, as the first line has (got {len(cells)}){hint}")
            return None
        given, before = dict(zip(head, cells, strict=True)), len(self._errors)
        row: dict[str, Any] = {"group": self._one_of(line, "group", given.get("group", ""), self._schema.groups)}
        for name, levels in self._schema.factors.items():
            # The table of trials has an empty cell for the level None.
            none = "none" if name in given and not published and "none" in (*levels, *self._schema.absent.get(name, ())) else ""
            row[name] = self._level(line, name, given.get(name, "") or none, levels)
        if published:
            row["measure"] = self._one_of(line, "measure", given["measure"], self._schema.measures, needed=True)
            row["mean"] = self._value(line, "mean", given["mean"], row["measure"], needed=True)
            row["sd"] = self._number(line, "sd", given.get("sd", ""), least=0)
            row["n"] = self._number(line, "n", given.get("n", ""), least=1, whole=True)
            row["source"] = self._given(line, "source", given["source"])
        else:
            row["participant"] = self._given(line, "participant", given["participant"])
            if len(self._schema.groups) == 1:
                row["group"] = row["group"] or self._schema.groups[0]
            elif not row["group"] and len(self._errors) == before:
                self._add(line, "group", "", f"one of: {', '.join(self._schema.groups)}")
            as_number = {"True": "1", "False": "0"}
            row |= {
                name: self._value(line, name, as_number.get(given[name], given[name]), name)
                for name in self._schema.measures
                if name in given
            }
            row |= {name: self._level(line, name, given[name], ()) for name in self._schema.numbers if name in given}
        return row if len(self._errors) == before else None

    # -- cells

    def _add(self, line: int, column: str, given: str, right: str) -> None:
        self._errors.append(f"{self._path}:{line}: column '{column}': must be {right} (got {shortened(given, LONGEST_GIVEN)!r})")

    def _given(self, line: int, column: str, text: str) -> str:
        if not text:
            self._add(line, column, text, "given")
        return text

    def _one_of(self, line: int, column: str, text: str, known: Sequence[str], *, needed: bool = False) -> str | None:
        if text in known or (not text and not needed):
            return text or None
        if text and (around := next((name for name in known if name.strip() == text), None)) is not None:
            return around  # cells are read without the spaces around them
        self._errors.append(
            f"{self._path}:{line}: column '{column}': must be one of: {', '.join(known)} (got {text!r}){did_you_mean(text, known)}"
        )
        return None

    def _level(self, line: int, column: str, text: str, levels: Sequence[float] | Sequence[str]) -> float | str | None:
        """Returns a level of a factor. A number need not be one of the levels of the design, because people can be drawn between them, but
        the model's parameter must allow it."""
        texts, absent = [level for level in levels if isinstance(level, str)], self._schema.absent.get(column, ())
        if texts or text in absent:
            return self._one_of(line, column, text, [*texts, *absent])
        value, parameter = self._number(line, column, text), self._schema.parameters.get(column)
        if value is not None and parameter is not None:
            try:
                parameter.check(int(value) if value.is_integer() else value)
            except ConfigurationError as error:
                unit = f" [{parameter.unit}]" if parameter.unit else ""
                self._errors.append(f"{self._path}:{line}: column '{column}': the model's parameter {error}{unit}")
                return None
        return value

    def _value(self, line: int, column: str, text: str, measure: str | None, *, needed: bool = False) -> float | None:
        """Returns a value of a measure, or a mean of it."""
        if measure in self._schema.switches:
            return self._number(line, column, text, needed=needed, least=0, most=1)
        return self._number(line, column, text, needed=needed)

    def _number(
        self, line: int, column: str, text: str, *, needed: bool = False, least: float = -HUGE, most: float = HUGE, whole: bool = False
    ) -> float | None:
        if not text and not needed:
            return None
        try:
            value = math.nan if "_" in text else float(text)
        except ValueError:
            value = math.nan
        if not least <= value <= most or (whole and value != int(value)):
            kind = "a whole number" if whole else "a number"
            bound = "" if least == -HUGE else f" from {least:g} on" if most == HUGE else f" from {least:g} to {most:g}"
            if abs(value) > HUGE and any(map(str.isdigit, text)):
                bound = f" from {max(least, -HUGE):g} to {HUGE:g}"
            point = "; write the decimal point as '.'" if "," in text else ""
            self._add(line, column, text, f"{kind}{bound}{point}")
            return None
        return value
