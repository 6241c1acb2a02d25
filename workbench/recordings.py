"""The recordings of a models folder: what there is, and what can be taken away of each."""

from __future__ import annotations

import csv
import io
import re
import secrets
import time
from array import array
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from actr3d.clock import MICROSECONDS, seconds
from actr3d.errors import Actr3dError, RecordingError
from actr3d.recording import Recorded
from actr3d.values import to_json
from workbench.compiled import from_text, loaded
from workbench.curves import NOTHING, Curves, stride
from workbench.files import OWN
from workbench.keeping import Keeping, erase, stands_alone, superfluous
from workbench.summaries import Summaries, Summary, begun

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.\-]{0,150}")
MOST = 1_000
"""So many recordings are told of at once."""


class NoSuchRecordingError(Actr3dError):
    """There is no recording of that name."""

    status = 404


class Recordings:
    """The recordings of a models folder.

    Args:
        root: The models folder.
    """

    def __init__(self, root: Path) -> None:
        self._folder = root / OWN / "recordings"
        self._summaries = Summaries()

    def new(self, model: str) -> Path:
        """Returns a new file for a run of a model."""
        self._folder.mkdir(parents=True, exist_ok=True)
        stem = re.sub(r"[^A-Za-z0-9_]", "_", model)[:60] or "model"
        # Several may begin in one second.
        return self._folder / f"{stem}-{time.strftime('%Y%m%d-%H%M%S')}-{secrets.token_hex(2)}.sqlite"

    def path(self, name: str) -> Path:
        """Returns where a recording is.

        Raises:
            NoSuchRecordingError: If there is none of that name.
        """
        path = self._folder / f"{name}.sqlite"
        if _NAME.fullmatch(name) is None or not path.is_file() or path.is_symlink():
            raise NoSuchRecordingError("there is no such recording")
        return path

    def list(self, first: int = 0, most: int = MOST) -> tuple[int, list[Summary]]:
        """Returns how many there are, and what is known of some, the newest first; also of what cannot be read.

        Args:
            first: How many of the newest are left out.
            most: How many are told of.
        """
        files = sorted(self._files(), key=lambda path: (begun(path), path.name), reverse=True)
        self._summaries.forget({path.name for path in files})
        return len(files), [self._summaries.of(path) for path in files[first : first + most]]

    def _files(self) -> Sequence[Path]:
        return [path for path in self._folder.glob("*.sqlite") if _NAME.fullmatch(path.stem) and path.is_file() and not path.is_symlink()]

    def tidy(self, keeping: Keeping) -> None:
        """Deletes the oldest recordings that no user has named, where there are too many."""
        for path in superfluous(self._files(), keeping):
            erase(path)

    def rename(self, name: str, to: str) -> None:
        """Gives a recording another name; one that a user has named is kept until a user deletes it.

        Raises:
            NoSuchRecordingError: If there is none of that name.
            RecordingError: If the other name cannot be had, or the recording is still being written.
        """
        path, target = self.path(name), self._folder / f"{to}.sqlite"
        if _NAME.fullmatch(to) is None:
            raise RecordingError("a recording's name has letters, digits, '_', '.' and '-', and no more than 150 of them")
        if not stands_alone(path):
            raise RecordingError("the recording is still being written: stop or restart its run first")
        if target.exists():
            raise RecordingError(f"there is a recording '{to}' already")
        path.rename(target)

    def summary(self, name: str) -> Summary:
        """Returns what is known of one.

        Raises:
            NoSuchRecordingError: If there is none of that name.
        """
        return self._summaries.of(self.path(name))

    def delete(self, name: str) -> None:
        """Deletes a recording.

        Raises:
            NoSuchRecordingError: If there is none of that name.
        """
        erase(self.path(name))


# -- to take away


def events_csv(path: Path) -> Iterator[str]:
    """Yields a recording's events as lines of CSV: time, source, kind, data as JSON.

    Raises:
        RecordingError: If it cannot be read.
    """
    yield _csv_line(("time [s]", "source", "kind", "data"))
    with Recorded(path) as recorded:
        for event in recorded.events():
            yield _csv_line((event.time, event.source, event.kind, to_json(event.data)))


def states_csv(path: Path) -> Iterator[str]:
    """Yields the physics of a recording as lines of CSV: the time, and all numbers of MuJoCo's integration state.

    Of a program, which may make several simulations, the number of the run comes first, and each run begins with a head of its own.

    Raises:
        RecordingError: If it cannot be read.
    """
    with Recorded(path) as recorded:
        period: int | None = recorded.facts.get("period_us")
        for run, tick, state, _ in recorded.states():
            numbers = array("d", state)
            names = [f"state_{n}" for n in range(len(numbers))]
            if period is not None:
                if tick == 0:
                    yield _csv_line(("time [s]", *names))
                yield _csv_line((seconds(tick * period), *numbers))
            else:
                if tick == 0:
                    yield _csv_line(("run", "tick", *names))
                yield _csv_line((run, tick, *numbers))


def curves(path: Path, names: Sequence[str] | None, first: float, most: int) -> dict[str, Any]:
    """Returns how a recorded run went as curves over time, also one that goes on; see `protocol.Curves`.

    Args:
        path: The recording.
        names: Which curves; None for all.
        first: From when on [s].
        most: How many times at most, evenly spread; the last is among them.

    Raises:
        RecordingError: If it cannot be read.
    """
    with Recorded(path) as recorded:
        facts = recorded.facts
        if "compiled" not in facts:
            return NOTHING
        period, begin, ticks = facts["period_us"], first * MICROSECONDS / facts["period_us"], recorded.ticks
        every = stride(ticks + 1 - max(0, int(begin)), most - 1)
        states = ((tick, state) for _, tick, state, _ in recorded.states() if begin <= tick <= ticks)
        moments = ((seconds(tick * period), state) for tick, state in states if tick % every == 0 or tick == ticks)
        return Curves(loaded(from_text(facts["compiled"])), facts["world"]).told(moments, names)


def _csv_line(values: tuple[Any, ...]) -> str:
    text = io.StringIO()
    # A text that begins like a formula would be one in a spreadsheet.
    csv.writer(text).writerow([f"'{value}" if isinstance(value, str) and value[:1] in ("=", "+", "-", "@") else value for value in values])
    return text.getvalue()
