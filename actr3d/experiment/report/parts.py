"""The parts of a report: sections with text, tables and figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, kw_only=True)
class Table:
    """A table, on the page and as a CSV file."""

    name: str
    """The name of the file, without its ending."""
    title: str
    frame: Any
    """A `pandas.DataFrame`; its columns are those of the file."""
    note: str = ""
    """What a reader has to know."""
    heads: Mapping[str, str] = field(default_factory=dict[str, str])
    """What the page shows instead of the names of columns."""
    units: Mapping[str, str] = field(default_factory=dict[str, str])
    """Units of columns; the page shows them in the head of the table."""
    digits: Mapping[str, int] = field(default_factory=dict[str, int])
    """Decimals of columns on the page; others have three significant digits."""
    hidden: Sequence[str] = ()
    """Columns that only the file has."""
    folded: bool = False
    """Whether the page shows it only after a click."""


@dataclass(frozen=True, kw_only=True)
class Plot:
    """A figure, on the page and as PNG and SVG files."""

    name: str
    """The name of the files, without their ending."""
    title: str
    figure: Any
    """A `matplotlib.figure.Figure`."""
    note: str = ""
    """What a reader has to know."""


@dataclass(frozen=True)
class Caution:
    """A text that a reader must not overlook."""

    text: str


Part = str | Table | Plot | Caution
"""A part of a section; a text is a paragraph."""


@dataclass(frozen=True, kw_only=True)
class Section:
    """Parts of a report under a title."""

    title: str
    parts: Sequence[Part]
    folded: bool = False
    """Whether the page shows its parts only after a click."""
    failed: str = ""
    """What could not be made, and the error; the parts are those that could."""
