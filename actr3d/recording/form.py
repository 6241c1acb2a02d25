"""The form of a recording's file, and what is written down of the programs that made it."""

from __future__ import annotations

import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version

FORM = "actr3d recording 1"
"""The first of the facts; a file without it is no recording."""

SCHEMA = """
CREATE TABLE facts (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE events (number INTEGER PRIMARY KEY, tick INTEGER NOT NULL, time_us INTEGER NOT NULL,
                     source TEXT NOT NULL, kind TEXT NOT NULL, line TEXT NOT NULL);
CREATE TABLE states (first INTEGER PRIMARY KEY, ticks INTEGER NOT NULL, data BLOB NOT NULL);
CREATE TABLE commands (number INTEGER PRIMARY KEY, tick INTEGER NOT NULL, data TEXT NOT NULL);
CREATE TABLE answers (number INTEGER PRIMARY KEY, tick INTEGER NOT NULL, body TEXT NOT NULL, word TEXT NOT NULL, value TEXT NOT NULL);
"""
"""`facts`: name and JSON. `events`: each a line of JSON, and after how many whole ticks. `states`: the state at the end of
ticks `first` and following, one after the other, each as many bytes. `commands`: after which tick. `answers`: at the end
of which tick."""


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
