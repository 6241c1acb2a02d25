"""Numbers the recordings of a tree that are called the same: the second branch at 0.10 s is `at 0.10 s (2)`.

A number is given once, when its recording is first listed, and kept in one file beside the recordings: it stays when others are deleted,
and a recording that is restored from the trash has its number again.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from threading import Lock

import msgspec

from actr3d.replacing import locked, replace_file
from workbench.labels import Label
from workbench.recording_index import Summary
from workbench.time_text import time_text

FILE = "numbers.json"
_Numbers = dict[str, dict[str, list[str]]]
"""By the first recording of a tree and a name, the recordings that have had this name, each at the place of its number."""


class BranchNumbers:
    """Reads and gives the numbers of recordings in a folder.

    Args:
        folder: The folder of the recordings.
        there: Returns the names of all recordings, including those in the trash.
    """

    def __init__(self, folder: Path, there: Callable[[], Collection[str]]) -> None:
        self._file = folder / FILE
        self._there = there
        self._lock = Lock()

    def of(self, summaries: Iterable[Summary], labels: Mapping[str, Label]) -> dict[str, int]:
        """Returns the numbers of recordings by name; those that have none yet are given one, the oldest first."""
        oldest_first = sorted(summaries, key=lambda one: one.made if one.kept is None else one.kept)
        called = {one.id: (_first_of_tree(one), name) for one in oldest_first if (name := _name(one, labels.get(one.id)))}
        numbers = self._read()
        if any(one not in numbers.get(tree, {}).get(name, ()) for one, (tree, name) in called.items()):
            with suppress(OSError), self._lock, locked(self._file):  # without the file, they are given again for each list
                numbers = _given(self._read(), called)
                self._write(numbers)
            numbers = _given(numbers, called)
        return {one: numbers[tree][name].index(one) + 1 for one, (tree, name) in called.items()}

    def _read(self) -> _Numbers:
        try:
            return msgspec.json.decode(self._file.read_bytes(), type=_Numbers)
        except (OSError, ValueError, RecursionError):
            return {}

    def _write(self, numbers: _Numbers) -> None:
        """Writes the numbers of trees of which a recording is left."""
        there = self._there()
        left = {tree: names for tree, names in numbers.items() if any(one in there for given in names.values() for one in given)}
        replace_file(self._file, json.dumps(left, indent=1).encode())


def _given(numbers: _Numbers, called: Mapping[str, tuple[str, str]]) -> _Numbers:
    """Returns numbers in which each recording has one.

    Args:
        numbers: The numbers by now; they are changed.
        called: The tree and the name of each recording.
    """
    for one, (tree, name) in called.items():
        given = numbers.setdefault(tree, {}).setdefault(name, [])
        if one not in given:
            given.append(one)
    return numbers


def _first_of_tree(one: Summary) -> str:
    """Returns the first recording of the tree of a recording, by its first name."""
    return one.ancestors[-1][0] if one.ancestors else one.origin or one.named


def _name(one: Summary, label: Label | None) -> str:
    """Returns the name of a recording among its branches, as the page does: what the user has called it, else where it is a branch."""
    if label is not None and label.name:
        return label.name
    return "" if one.branched is None else f"at {time_text(one.branched, 2)}"
