"""Mean angles of the original ACT-R 3D's walker, beside which reports show a model's."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any


def original_means() -> dict[tuple[str, str, float], float]:
    """Returns the mean angles [degrees] by group, condition and aperture [m].

    Source: its own trials, 150 per cell (docs/human-data.md).
    """
    return {(row["group"], row["speed"], int(row["A"]) / 100): float(row["mean_deg"]) for row in _rows("original_means.csv")}


def original_bar_means() -> dict[tuple[float, float], float]:
    """Returns the mean angles [degrees] by ratio of the aperture to the total width, and bar in body widths.

    Source: its own trials, 360 per cell (docs/human-data.md).
    """
    return {(float(row["APRatio"]), float(row["BarRatio"])): float(row["mean_deg"]) for row in _rows("original_bar_means.csv")}


def _rows(name: str) -> list[dict[str, Any]]:
    with (Path(__file__).parent / name).open(encoding="utf-8") as file:
        return list(csv.DictReader(file))
