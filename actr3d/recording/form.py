"""The form of a recording's file, and what is written down of the programs that made it."""

from __future__ import annotations

import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version

FORM = "actr3d recording 1"
"""The first of the facts; a file without it is no recording."""

SCHEMA = """
CREATE TABLE facts (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE events (first INTEGER PRIMARY KEY, count INTEGER NOT NULL, data TEXT NOT NULL);
CREATE TABLE answers (first INTEGER PRIMARY KEY, count INTEGER NOT NULL, data TEXT NOT NULL);
CREATE TABLE states (first INTEGER PRIMARY KEY, count INTEGER NOT NULL, data BLOB NOT NULL, events BLOB NOT NULL);
CREATE TABLE commands (number INTEGER PRIMARY KEY, tick INTEGER NOT NULL, data TEXT NOT NULL);
"""
"""`facts`: a name and JSON. The next three hold many things a row, because few large rows cost a running simulation least;
`first` is the number of the first of them. `events` (from 0): a JSON list of [time in us, source, kind, data]. `answers`
(from 0): a JSON list of [tick, body, word, answer]. `states`: by tick, from 0, the start: the states one after the
other, each as many 8-byte numbers; and for each, in 8 bytes, how many events there were until then. `commands`: after
which tick."""


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
