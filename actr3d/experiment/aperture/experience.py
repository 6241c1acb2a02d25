"""What a walker remembers of passages: the widths that it saw and felt, its turn, how fast it walked, and what came of it."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Literal

from actr3d.experiment.aperture.passage import PassageResult
from actr3d.world import Mannequin

FILE = Path(__file__).with_name("experience.csv")
MEASURES = ("seen", "felt", "energy", "free", "passed")
COLUMNS = ("gait", "hands", "shoulders", "turn", "speed", *MEASURES)
MASS: float = Mannequin.mass
"""Of the walker [kg]."""


def passage_remembered(committed: Mapping[str, float] | None, result: PassageResult) -> dict[str, float]:
    """Returns the memory of a passage.

    By name: `seen` and `felt`, as given [m]; `energy`, that of all contacts (`PassageResult.impact_j`), but at most the kinetic energy of
    the walking body [J]; `free`, 1 if it passed and touched nothing, otherwise 0; `passed`, 1 if it passed, otherwise 0.

    Args:
        committed: What the walker saw and felt: `seen`, the width of the doorway [m]; `felt`, its own in the posture that it is about to
            take, with what it holds [m]; and its `speed` [m/s]. None if it came to no decision.
        result: What came of it.
    """
    if committed is None:
        raise ValueError("the walker did not come to the doorway")
    moving = MASS * committed["speed"] ** 2 / 2
    energy = min(result.impact_j, moving)
    passed = result.outcome == "passed"
    return {
        "seen": committed["seen"],
        "felt": committed["felt"],
        "energy": round(energy, 2),
        "free": float(passed and result.contacts == 0),
        "passed": float(passed),
    }


@cache
def experiences(*, walks: bool = True, hands: Literal["empty", "bar"] = "empty") -> tuple[dict[str, float], ...]:
    """Returns the memories of simulated passages.

    Each has, by name, the width of the `shoulders` [m], their `turn` [degrees], the `speed` [m/s], and what `passage_remembered` returns.

    Args:
        walks: Whether the body walked with a gait; otherwise it glided.
        hands: What it had in its hands.

    Source: the rows of the designs `doorway_practice` and `bar_practice`; see `experience.csv`.
    """
    with FILE.open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if (row["gait"], row["hands"]) == (str(walks), hands)]
    return tuple({name: float(row[name]) for name in COLUMNS[2:]} for row in rows)
