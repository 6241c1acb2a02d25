"""Creates files from recordings: each kind of file has one function that writes it. These functions run in workers, never in the server.

A recording may come from anybody. Reading it or loading its compiled scene may take too long, use too much memory or crash, which
must not harm the server.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Collection, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from actr3d.clock import seconds
from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.recording.opening import opened
from actr3d.values import to_json

Maker = Callable[..., None]
"""Called with the path of each recording, the path of the new file, and options by name."""
EXPORTS: dict[str, Maker] = {}
"""The functions by the kinds of files that they write."""


def export(kind: str) -> Callable[[Maker], Maker]:
    """Registers a function that writes files of a kind."""

    def add(maker: Maker) -> Maker:
        EXPORTS[kind] = maker
        return maker

    return add


@export("sqlite")
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


@export("events.csv")
def events_csv(path: Path, to: Path) -> None:
    """Writes a recording's events as CSV."""
    from workbench.csv_files import write_events_csv

    write_events_csv(path, to)


@export("states.csv")
def states_csv(path: Path, to: Path) -> None:
    """Writes a recording's states as CSV."""
    from workbench.csv_files import write_states_csv

    write_states_csv(path, to)


@export("replay.html")
def replay_html(path: Path, to: Path) -> None:
    """Writes one HTML file that plays a recording's scene beside its trace."""
    from workbench.html_replay.make import write_replay

    write_replay(path, to)


@export("curves")
def curves(path: Path, to: Path, *, names: Sequence[str] | None, first: float, most: int, last: float | None) -> None:
    """Writes the curves of a recorded run over time as JSON, even if the run is still going on; see `protocol.Curves`.

    Args:
        path: The recording.
        to: The new file.
        names: Which curves; None for all.
        first: The start of the interval [s].
        most: Maximum number of times, evenly spaced; the last moment is included.
        last: The end of the interval [s]; None for the end of the recording.
    """
    to.write_text(to_json(curves_of(path, names, first, most, last)), encoding="utf-8")


def curves_of(path: Path, names: Sequence[str] | None, first: float, most: int, last: float | None = None) -> dict[str, Any]:
    """Returns the curves of a recorded run over time; see `curves`.

    Raises:
        RecordingError: If the recording cannot be read.
    """
    from actr3d.world.compiled import from_text, loaded
    from workbench.curves import NOTHING, CurveReader, stretch, stride

    with Recorded(path) as recorded:
        facts = recorded.facts
        if "compiled" not in facts:
            return NOTHING
        period, ticks = facts["period_us"], recorded.ticks
        begin, end = stretch(first, last, period)
        end = ticks if end is None else min(end, ticks)
        every = stride(end + 1 - begin, most - 1)
        states = ((tick, state) for _, tick, state, _ in recorded.states() if begin <= tick <= end)
        moments = ((seconds(tick * period), state) for tick, state in states if tick % every == 0 or tick == end)
        return CurveReader(loaded(from_text(facts["compiled"])), facts["world"]).sampled(moments, names)


@export("comparison")
def comparison(first: Path, second: Path, to: Path, *, kinds: Collection[str]) -> None:
    """Writes the differences of two recordings as JSON; see `compare`."""
    from workbench.recording_diff import compare

    to.write_text(to_json(compare(first, second, kinds)), encoding="utf-8")


@export("beginning")
def beginning(path: Path, to: Path) -> None:
    """Writes what a recorded run began with and the commands of users, as JSON; see `Beginning`."""
    from workbench.recorded_start import beginning_of, written

    to.write_text(written(beginning_of(path)), encoding="utf-8")


@export("trial counts")
def trial_counts(*paths: Path) -> None:
    """Writes the numbers of finished and of failed trials of experiments as JSON; the last path is that of the new file."""
    from workbench.experiment_table import counts

    *tables, to = paths
    to.write_text(to_json(counts(*tables)), encoding="utf-8")


@export("trial rows")
def trial_rows(path: Path, to: Path, **options: Any) -> None:
    """Writes rows of an experiment as JSON; the options are those of `Table.rows`."""
    from workbench.experiment_table import Table

    with closing(Table(path)) as table:
        to.write_text(to_json(table.rows(**options)), encoding="utf-8")


@export("trial means")
def trial_means(path: Path, to: Path, **options: Any) -> None:
    """Writes the means of a measure of an experiment as JSON; the options are those of `Table.means`."""
    from workbench.experiment_table import Table

    with closing(Table(path)) as table:
        to.write_text(to_json(table.means(**options)), encoding="utf-8")
