"""The files that are made from recordings, each by one function. They run in workers, never in the server.

A recording may come from anybody. Reading it or loading its compiled scene may take too long, use too much memory or crash, which
must not harm the server.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.recording.opening import opened
from actr3d.values import to_json
from workbench.csv_files import write_events_csv, write_states_csv
from workbench.curves import CurveReader, joined, stretch, thinned
from workbench.event_curves import EventCurves
from workbench.experiment_means import means
from workbench.experiment_table import Table, counts
from workbench.html_replay.make import write_replay
from workbench.program_time import timed_events
from workbench.recorded_simulations import RecordedSimulation, simulations_of
from workbench.recorded_start import RecordedStart, recorded_start_of
from workbench.recording_diff import compare


def copy(path: Path, to: Path) -> None:
    """Copies a recording that may still be written, page by page including any damage, without blocking the run that writes it.

    Raises:
        RecordingError: If it cannot be read, or the copy cannot be written (for example because the disk is full).
    """
    try:
        with closing(opened(path)) as source, closing(sqlite3.connect(to, isolation_level=None)) as target:
            target.execute("PRAGMA synchronous=OFF")
            source.backup(target)  # in one step: with several, each write in between would restart the copy
            target.execute("PRAGMA journal_mode=DELETE")  # as after a run that has ended: a single file without -wal and -shm files
    except sqlite3.Error as error:
        reason = "the disk is full" if "full" in str(error) else str(error)
        raise RecordingError(f"the recording cannot be copied: {reason}") from None


def curves_of(path: Path, *, names: Sequence[str] | None, first: float, most: int, last: float | None = None) -> dict[str, Any]:
    """Returns the curves of a recorded run over time, even if the run is still going on.

    What they are, and the options, are those of `workbench.page_commands.bodies.Curves`; without `last`, up to the end of the recording.

    Raises:
        RecordingError: If the recording cannot be read.
    """
    with Recorded(path) as recorded:
        found = simulations_of(recorded)
        of_events = EventCurves()
        of_events.take(timed_events(recorded))

    def sampled(one: RecordedSimulation) -> dict[str, Any]:
        known = partial(one.past.between, *stretch(first, last, one.period, one.begin))
        return CurveReader(one.mj_model, one.facts["world"]).sampled(thinned(known, most, one.past.every), names, one.period, one.begin)

    return of_events.added_to(joined(map(sampled, found)), names, first, last, most)


def _rows(path: Path, **options: Any) -> Any:
    """Returns rows of a table of trials, as `Table.rows` does."""
    with closing(Table(path)) as table:
        return table.rows(**options)


def _write(make: Callable[..., Any], as_text: Callable[[Any], str] = to_json) -> Callable[..., None]:
    """Returns a function that writes what `make` returns to a file, whose path is its last argument; by default as JSON."""

    def write(*paths: Path, **options: Any) -> None:
        *sources, to = paths
        to.write_text(as_text(make(*sources, **options)), encoding="utf-8")

    return write


EXPORTS: dict[str, Callable[..., None]] = {
    "sqlite": copy,
    "events.csv": write_events_csv,
    "states.csv": write_states_csv,
    "replay.html": write_replay,
    "curves": _write(curves_of),
    "comparison": _write(compare),
    "recorded start": _write(recorded_start_of, RecordedStart.to_json),
    "trial counts": _write(lambda *tables: counts(*tables)),
    "trial rows": _write(_rows),
    "trial means": _write(means),
}
"""By the kind of file, the function that writes it: called with the paths of recordings or tables, that of the new file, and options."""
