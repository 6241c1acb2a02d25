"""Exports the table of trials as CSV and Parquet, and a description of its columns."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from importlib import import_module
from itertools import islice
from pathlib import Path
from typing import Any, cast

import numpy as np

from actr3d.errors import ExperimentError, reason_of
from actr3d.experiment.plain_values import text_cell
from actr3d.experiment.store import ROWS_AT_ONCE, Column, Store
from actr3d.replacing import replacing

CSV, PARQUET, COLUMNS = "trials.csv", "trials.parquet", "columns.csv"
"""The names of the exported files in the folder of an experiment."""
DTYPES: dict[str, Any] = {"integer": np.int64, "real": np.float64}
"""The types of numbers by the type of their column."""


def export(store: Store) -> list[Path]:
    """Writes all rows that are there to files beside the store, and returns these files.

    Raises:
        ExperimentError: If a file cannot be written.
    """
    columns, folder = store.columns, store.folder
    try:
        with replacing(folder / COLUMNS) as part:
            _write_columns(part, columns)
        with replacing(folder / CSV) as part:
            _write_csv(part, columns, store.rows())
        with replacing(folder / PARQUET) as part:
            _write_parquet(part, columns, store.rows())
    except OSError as error:
        raise ExperimentError(f"'{folder}': cannot write the table of trials ({reason_of(error)})") from None
    return [folder / name for name in (COLUMNS, CSV, PARQUET)]


def _write_columns(path: Path, columns: tuple[Column, ...]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["column", "type", "unit", "meaning"])
        writer.writerows([column.name, column.type, column.unit or "", column.meaning] for column in columns)


def _write_csv(path: Path, columns: tuple[Column, ...], rows: Iterator[dict[str, Any]]) -> None:
    names = [column.name for column in columns]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        of_text = {column.name for column in columns if column.type == "text"}
        writer.writerows([text_cell(row.get(name)) if name in of_text else row.get(name) for name in names] for row in rows)


def _write_parquet(path: Path, columns: tuple[Column, ...], rows: Iterator[dict[str, Any]]) -> None:
    arrow, parquet = cast("Any", import_module("pyarrow")), cast("Any", import_module("pyarrow.parquet"))  # they have no types
    types = {"null": arrow.null(), "boolean": arrow.bool_(), "integer": arrow.int64(), "real": arrow.float64(), "text": arrow.string()}
    fields = [
        arrow.field(column.name, types[column.type], metadata={"unit": column.unit or "", "meaning": column.meaning}) for column in columns
    ]
    schema = arrow.schema(fields)
    with parquet.ParquetWriter(path, schema) as writer:
        while found := list(islice(rows, ROWS_AT_ONCE)):
            arrays = [_array(arrow, types[column.type], column.type, [row.get(column.name) for row in found]) for column in columns]
            writer.write_table(arrow.Table.from_arrays(arrays, schema=schema))


def _array(arrow: Any, arrow_type: Any, kind: str, values: list[Any]) -> Any:
    """Returns the values of a column as an array of Arrow; its own conversion imports pandas, which takes half a second."""
    if kind == "null":
        return arrow.nulls(len(values))
    if kind == "text":
        texts = arrow.lib.StringBuilder()
        texts.append_values(list(map(text_cell, values)))
        return texts.finish()
    there = np.packbits(np.array([value is not None for value in values], bool), bitorder="little")
    plain = [0 if value is None else value for value in values]
    numbers: Any = np.packbits(np.array(plain, bool), bitorder="little") if kind == "boolean" else np.array(plain, DTYPES[kind])
    return arrow.Array.from_buffers(arrow_type, len(values), [arrow.py_buffer(there), arrow.py_buffer(numbers)])
