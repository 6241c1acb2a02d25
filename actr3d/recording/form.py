"""The form of a recording's file, and what is written down of the programs that made it."""

from __future__ import annotations

import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version

FORM = "actr3d recording 3"
"""The first of the facts; a file without it is no recording."""

OWN_FACTS = frozenset({"form", "versions", "kind", "whole", "ended"})
"""Facts that every recording tells by itself."""

LEFT = "left"
"""What the fact `ended` says of a run that its user left before it was over. All other words are of runs that came to their end:
`end` and `exit` (`SystemExit`) of programs; `stop`, `done` and `limits` of a simulation that a file builds, see `RunReport`. A
run that raised anything else has the fact `failed` instead; one that was broken off has neither."""

SCHEMA = (
    "CREATE TABLE facts (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE events (first INTEGER PRIMARY KEY, count INTEGER NOT NULL, data TEXT NOT NULL, checksum BLOB NOT NULL)",
    "CREATE TABLE answers (first INTEGER PRIMARY KEY, count INTEGER NOT NULL, data TEXT NOT NULL, checksum BLOB NOT NULL)",
    "CREATE TABLE states (first INTEGER PRIMARY KEY, count INTEGER NOT NULL, data BLOB NOT NULL, marks BLOB NOT NULL, "
    "checksum BLOB NOT NULL)",
    "CREATE TABLE commands (first INTEGER PRIMARY KEY, run INTEGER NOT NULL, tick INTEGER NOT NULL, data TEXT NOT NULL, "
    "checksum BLOB NOT NULL)",
    "CREATE TABLE seal (first INTEGER PRIMARY KEY, checksum BLOB NOT NULL, seal BLOB NOT NULL)",
)
"""`facts`: a name and JSON. The next three hold many things a row, because few large rows cost a running simulation least;
`first` is the number of the first of them, from 0. `events`: a JSON list of [time in us, source, kind, data]. `answers`: a
JSON list of [run, tick, body, word, answer]. `states`: the states one after the other, each at the start (tick 0) or the end
of a tick, and as many 8-byte numbers; and for each of them its `marks`, four 8-byte numbers: of which run, of which tick, how
many events there were until then, and how many bytes it is. `commands`: after which tick, one a row.

`run` says of which simulation: 1 in the recording that a simulation makes of itself; in that of a program, which may make
several, by which number the trace knows it. A program that goes back with one of them is recorded as it went: the ticks that
are gone through again follow the others.

`checksum` covers a row and the one before it; the only row of `seal` (0) has the checksum of everything, and the seal of the
installation that wrote it, which is empty where that has no key. See `actr3d.recording.checksums`."""

COLUMNS: dict[str, tuple[type, ...]] = {
    "events": (int, int, str),
    "answers": (int, int, str),
    "states": (int, int, bytes, bytes),
    "commands": (int, int, int, str),
}
"""The tables that are written row by row, and what their columns hold, without the last one, the checksum."""


@cache
def versions() -> dict[str, str]:
    """Returns the versions of all that the bytes of a run may depend on."""
    found = {"python": platform.python_version(), "machine": platform.machine(), "system": platform.system()}
    for package in ("actr3d", "mujoco", "numpy"):
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "unknown"
    return found
