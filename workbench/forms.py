"""What can be made of recordings: each form by one function that writes a file. They run in workers, never in the server.

A recording may come from anybody; what is in it is read, and a compiled scene is loaded, only where that may take too long, take too
much memory or crash.
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
"""Gets the path of each recording, that of the new file, and options by name."""
FORMS: dict[str, Maker] = {}
"""By the names of forms, what makes them."""


def form(name: str) -> Callable[[Maker], Maker]:
    """Adds what makes a form."""

    def add(maker: Maker) -> Maker:
        FORMS[name] = maker
        return maker

    return add


@form("sqlite")
def copy(path: Path, to: Path) -> None:
    """Copies a recording that is being written, page by page, damage and all; the run that writes it does not wait.

    Raises:
        RecordingError: If it cannot be read, or the copy cannot be written, as on a full disk.
    """
    try:
        with closing(opened(path)) as source, closing(sqlite3.connect(to, isolation_level=None)) as target:
            target.execute("PRAGMA synchronous=OFF")
            source.backup(target)  # in one step: of several, each write in between would begin it again
            target.execute("PRAGMA journal_mode=DELETE")  # as a run that has ended leaves its own: one file, without companions
    except sqlite3.Error as error:
        reason = "the disk is full" if "full" in str(error) else str(error)
        raise RecordingError(f"the recording cannot be copied: {reason}") from None


@form("events.csv")
def events_csv(path: Path, to: Path) -> None:
    """Writes a recording's events as CSV."""
    from workbench.csv_files import write_events_csv

    write_events_csv(path, to)


@form("states.csv")
def states_csv(path: Path, to: Path) -> None:
    """Writes a recording's states as CSV."""
    from workbench.csv_files import write_states_csv

    write_states_csv(path, to)


@form("replay.html")
def replay_html(path: Path, to: Path) -> None:
    """Writes one HTML file that plays a recording's scene beside its trace."""
    from workbench.html_replay.make import write_replay

    write_replay(path, to)


@form("curves")
def curves(path: Path, to: Path, *, names: Sequence[str] | None, first: float, most: int, last: float | None) -> None:
    """Writes how a recorded run went as curves over time, also one that goes on, as JSON; see `protocol.Curves`.

    Args:
        path: The recording.
        to: The file.
        names: Which curves; None for all.
        first: From when on [s].
        most: How many times at most, evenly spread; the last one is among them.
        last: Until when [s]; None for as far as it goes.
    """
    to.write_text(to_json(curves_of(path, names, first, most, last)), encoding="utf-8")


def curves_of(path: Path, names: Sequence[str] | None, first: float, most: int, last: float | None = None) -> dict[str, Any]:
    """Returns how a recorded run went as curves over time; see `curves`.

    Raises:
        RecordingError: If it cannot be read.
    """
    from workbench.compiled import from_text, loaded
    from workbench.curves import NOTHING, Curves, stretch, stride

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
        return Curves(loaded(from_text(facts["compiled"])), facts["world"]).told(moments, names)


@form("comparison")
def comparison(first: Path, second: Path, to: Path, *, kinds: Collection[str]) -> None:
    """Writes where two recordings differ, as JSON; see `compare`."""
    from workbench.comparing import compare

    to.write_text(to_json(compare(first, second, kinds)), encoding="utf-8")


@form("beginning")
def beginning(path: Path, to: Path) -> None:
    """Writes with what a recorded run began and what users did, as JSON; see `Beginning`."""
    from workbench.beginnings import beginning_of, written

    to.write_text(written(beginning_of(path)), encoding="utf-8")
