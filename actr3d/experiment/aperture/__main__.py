"""Makes the file of experiences that is shipped: `python -m actr3d.experiment.aperture FOLDER ...`, from runs of its designs."""

from __future__ import annotations

import csv
import sys
from pathlib import Path

from actr3d.experiment.aperture.experience import COLUMNS, FILE
from actr3d.experiment.store import Store


def write(folders: list[str]) -> None:
    """Writes the file from the finished trials of some experiments."""
    with FILE.open("w", encoding="utf-8", newline="") as file:
        rows: csv.DictWriter[str] = csv.DictWriter(file, COLUMNS, extrasaction="ignore", lineterminator="\n")
        rows.writeheader()
        for folder in folders:
            with Store(Path(folder)) as store:
                gait = store.specification.values.get("gait", True)
                for row in store.rows():
                    if row["error"] is None:
                        hands = "bar" if row.get("bar") else "empty"
                        body = {"hands": hands, "shoulders": round(row["shoulder_width"], 3), "speed": round(row["speed"], 3)}
                        rows.writerow({**row, "gait": gait, **body})


if __name__ == "__main__":
    write(sys.argv[1:])
