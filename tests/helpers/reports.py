"""Experiments for reports: stores with rows that a test computes, of the library's own designs, without running a model."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from actr3d.experiment.aperture.passing import baseline_angle
from actr3d.experiment.design import Trial
from actr3d.experiment.specification import specify
from actr3d.experiment.store import Finished, Store

ABOUT: dict[str, dict[str, str | None]] = {"rt": {"unit": "s", "meaning": "The time until the answer [s]."}}


def store_rows(
    folder: Path,
    design: str,
    measures: Callable[[Trial], Mapping[str, Any]],
    *,
    participants: int | None = None,
    trials: int | None = None,
    values: Mapping[str, Any] | None = None,
    least: int = 0,
) -> Path:
    """Stores a row for each trial of a design, and returns the folder.

    Args:
        folder: The new folder.
        design: The name or file of the design.
        measures: Computes the measures of a trial; a key `error` makes it a failure.
        participants: The number of participants of each group.
        trials: The number of trials of each cell.
        values: Values that replace those of the design.
        least: The number of the first trial that has a row.
    """
    experiment = specify(design, participants=participants, trials=trials, values=values)
    rows: list[Finished] = []
    for trial in list(experiment.design.table())[least:]:
        found = dict(measures(trial))
        error = found.pop("error", None)
        row = {**trial.columns, **({} if error else found), "end": "error" if error else "stop", "error": error}
        rows.append(Finished(row=row, wall_s=0.1 * (trial.number % 7), worker=str(trial.number % 2)))
    with Store.create(folder, experiment.specification) as store:
        store.add(rows, "python 3.11, actr3d 0.1.0", {**experiment.about, **ABOUT})
    return folder


def walk(trial: Trial) -> dict[str, Any]:
    """Returns the measures of a walker whose turn follows from the geometry, with some spread, and is larger at a fast pace."""
    width = trial.values["shoulder_width"]
    need = float(baseline_angle([trial.values["aperture"] / width])[0])
    spread = 0.3 * math.sin(7.0 * trial.number)
    left, right = (0.068, 0.07) if trial.number % 2 else (0.07, 0.068)
    angle = round(min(80.0, need + (4 if trial.values.get("condition") == "fast" else 0) + spread), 2) if need else 0.0
    return {
        "outcome": "passed",
        "peak_angle_deg": angle,
        "wall_angle_deg": angle,
        "logged_angle_deg": angle,
        "onset_distance_m": 1.4 + 0.01 * spread if angle else None,
        "onset_time_s": 9.0 if angle else None,
        "contacts": 0,
        "max_force_n": 0.0,
        "clearance_left_m": left,
        "clearance_right_m": right,
        "speed_m_s": 1.3,
        "time_s": 11.0,
    }
