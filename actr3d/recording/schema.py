"""The schema of a recording's file, and the versions of the programs that made it."""

from __future__ import annotations

import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version

FORMAT = "actr3d recording 4"
"""The version of the file format: the value of the fact `form`, without which a file is not a recording."""

SCHEMA = (
    "CREATE TABLE facts (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE events (first INTEGER PRIMARY KEY, count INTEGER NOT NULL, data TEXT NOT NULL, checksum BLOB NOT NULL)",
    "CREATE TABLE answers (first INTEGER PRIMARY KEY, count INTEGER NOT NULL, data TEXT NOT NULL, checksum BLOB NOT NULL)",
    "CREATE TABLE states (first INTEGER PRIMARY KEY, count INTEGER NOT NULL, data BLOB NOT NULL, marks BLOB NOT NULL, "
    "contacts TEXT NOT NULL, checksum BLOB NOT NULL)",
    "CREATE TABLE commands (first INTEGER PRIMARY KEY, run INTEGER NOT NULL, tick INTEGER NOT NULL, data TEXT NOT NULL, "
    "checksum BLOB NOT NULL)",
    "CREATE TABLE seal (first INTEGER PRIMARY KEY, checksum BLOB NOT NULL, seal BLOB NOT NULL)",
)
"""The tables of a recording.

`facts`: a name and JSON. The next three tables hold many items per row, because few large rows slow down a running simulation
least; `first` is the number of a row's first item, from 0. `events`: a JSON list of [time in us, source, kind, data]. `answers`:
a JSON list of [run, tick, body, word, answer]. `states`: concatenated states, each at the start (tick 0) or the end of a tick,
stored as 8-byte numbers; for each state its `marks`, four 8-byte numbers: its run, its tick, the number of events until then,
and its size in bytes; and `contacts`, a JSON list of [number of the state in this row, from 0, body, its part, other object, force in
N], with the greatest force of each contact in any physics step of that state's tick, except contacts with floors. `commands`: one per
row, with the tick after which it was given.

`run` is the number of the simulation: 1 in a simulation's own recording; in the recording of a program, which may make several
simulations, the number that the trace gives it. If a program goes back in a simulation, the recording keeps the order of
execution: repeated ticks follow the others.

`checksum` covers a row and the one before it; the only row of `seal` (0) has the checksum of everything, and the seal of the
installation that wrote it, which is empty if that installation has no key. See `actr3d.recording.checksums`."""

COLUMNS: dict[str, tuple[type, ...]] = {
    "events": (int, int, str),
    "answers": (int, int, str),
    "states": (int, int, bytes, bytes, str),
    "commands": (int, int, int, str),
}
"""The tables that are written row by row, and the types of their columns without the last one, the checksum."""


@cache
def versions() -> dict[str, str]:
    """Returns the versions of everything that the bytes of a run may depend on."""
    found = {"python": platform.python_version(), "machine": platform.machine(), "system": platform.system()}
    for package in ("actr3d", "mujoco", "numpy"):
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "unknown"
    return found
