"""The recordings of a models folder: what there is, what came of each, and how two of them differ."""

from __future__ import annotations

import csv
import hashlib
import io
import itertools
import re
import secrets
import time
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from actr3d.clock import seconds
from actr3d.errors import Actr3dError, RecordingError
from actr3d.recording import Recorded
from actr3d.values import to_json
from workbench.files import OWN
from workbench.keeping import Keeping, superfluous

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.\-]{0,150}")
MOST = 1_000
"""So many recordings are listed, the newest first."""
BESIDE = ("-wal", "-shm", "-journal")
"""Files with these endings lie beside a recording that is being written."""


class NoSuchRecordingError(Actr3dError):
    """There is no recording of that name."""

    status = 404


@dataclass(frozen=True, kw_only=True)
class Summary:
    """What a list tells of a recording."""

    id: str
    model: str
    kind: str
    seed: Any
    parameters: dict[str, Any]
    ended: str | None
    """How it ended; None where it was broken off, or goes on."""
    time: float
    """How long it is [s of simulated time]."""
    events: int
    size: int
    """[bytes]"""
    made: float
    """When it was last written [s since 1970]."""
    problem: str | None = None
    """Why it cannot be opened; then no more is known of it than its size and when it was written."""


class Recordings:
    """The recordings of a models folder.

    Args:
        root: The models folder.
    """

    def __init__(self, root: Path) -> None:
        self._folder = root / OWN / "recordings"

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

    def list(self) -> list[Summary]:
        """Returns what there is, the newest first; of what cannot be read, why."""
        files = sorted(self._files(), key=lambda path: path.stat().st_mtime, reverse=True)
        return [_summary(path) for path in files[:MOST]]

    def _files(self) -> Sequence[Path]:
        return [path for path in self._folder.glob("*.sqlite") if path.is_file() and not path.is_symlink()] if self._folder.is_dir() else []

    def tidy(self, keeping: Keeping) -> None:
        """Deletes the oldest recordings that no user has named, where there are too many."""
        for path in superfluous(self._files(), keeping):
            _delete(path)

    def rename(self, name: str, to: str) -> None:
        """Gives a recording another name; one that a user has named is kept until a user deletes it.

        Raises:
            NoSuchRecordingError: If there is none of that name.
            RecordingError: If the other name cannot be had, or the recording is still being written.
        """
        path, target = self.path(name), self._folder / f"{to}.sqlite"
        if _NAME.fullmatch(to) is None:
            raise RecordingError("a recording's name has letters, digits, '_', '.' and '-', and no more than 150 of them")
        if any(path.with_name(path.name + end).exists() for end in BESIDE):
            raise RecordingError("the recording is still being written: stop or restart its run first")
        if target.exists():
            raise RecordingError(f"there is a recording '{to}' already")
        path.rename(target)

    def summary(self, name: str) -> Summary:
        """Returns what is known of one.

        Raises:
            NoSuchRecordingError: If there is none of that name.
        """
        return _summary(self.path(name))

    def delete(self, name: str) -> None:
        """Deletes a recording.

        Raises:
            NoSuchRecordingError: If there is none of that name.
        """
        _delete(self.path(name))


def _delete(path: Path) -> None:
    for each in (path, *(path.with_name(path.name + end) for end in BESIDE)):
        each.unlink(missing_ok=True)


def _summary(path: Path) -> Summary:
    try:
        with Recorded(path) as recorded:
            facts = recorded.facts
            ended: dict[str, Any] | None = facts.get("ended")
            ticks = recorded.ticks
            last = seconds(ticks * facts["period_us"]) if "period_us" in facts else _last_time(recorded)
            return Summary(
                id=path.stem,
                model=Path(facts.get("file", "")).name,
                kind=facts["kind"],
                seed=facts.get("program_seed", facts.get("seed")),
                parameters=facts.get("parameters", {}),
                ended=None if ended is None else ended["by"],
                time=last,
                events=recorded.event_count,
                size=path.stat().st_size,
                made=path.stat().st_mtime,
            )
    except (RecordingError, OSError, KeyError, ValueError) as error:
        return _unreadable(path, f"it lacks {error}" if isinstance(error, KeyError) else str(error))


def _unreadable(path: Path, problem: str) -> Summary:
    """Returns what is known of a recording of another version, or of a file that is none."""
    size, made = (path.stat().st_size, path.stat().st_mtime) if path.exists() else (0, 0.0)
    return Summary(
        id=path.stem,
        model="",
        kind="unreadable",
        seed=None,
        parameters={},
        ended=None,
        time=0.0,
        events=0,
        size=size,
        made=made,
        problem=problem,
    )


def _last_time(recorded: Recorded) -> float:
    """Returns when a program's last event was [s]."""
    row = recorded._file.execute("SELECT data FROM events ORDER BY first DESC LIMIT 1").fetchone()
    events: list[Any] = [] if row is None else msgspec.json.decode(row[0])
    return seconds(events[-1][0]) if events else 0.0


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


def curves(path: Path, names: Sequence[str], most: int) -> dict[str, Any]:
    """Returns how joints moved in a recorded run: the times, and the values of each curve that is asked for.

    Args:
        path: The recording.
        names: Which curves: names of joints for their positions [rad] [m], and with ` speed` for their speeds.
        most: How many times at most; of more every second, third and so on is left out.

    Raises:
        RecordingError: If it cannot be read.
    """
    with Recorded(path) as recorded:
        columns: dict[str, int] = recorded.facts.get("columns", {})
        wanted = {name: columns[name] for name in names if name in columns}
        every = max(1, -(-(recorded.ticks + 1) // most))
        times: list[float] = []
        values: dict[str, list[float]] = {name: [] for name in wanted}
        for _, tick, state, _ in recorded.states() if wanted else ():
            if tick % every == 0:
                numbers = array("d", state)
                times.append(seconds(tick * recorded.facts["period_us"]))
                for name, column in wanted.items():
                    values[name].append(numbers[column])
        return {"names": list(columns), "times": times, "curves": values}


def _csv_line(values: tuple[Any, ...]) -> str:
    text = io.StringIO()
    # A text that begins like a formula would be one in a spreadsheet.
    csv.writer(text).writerow([f"'{value}" if isinstance(value, str) and value[:1] in ("=", "+", "-", "@") else value for value in values])
    return text.getvalue()


# -- two of them


def compare(first: Path, second: Path) -> dict[str, Any]:
    """Returns where two recordings differ: their parameters, and the first event that is not the same.

    Raises:
        RecordingError: If one cannot be read.
    """
    with Recorded(first) as one, Recorded(second) as other:
        ours, theirs = _told(one.facts), _told(other.facts)
        different = {name: [ours.get(name), theirs.get(name)] for name in {**ours, **theirs} if ours.get(name) != theirs.get(name)}
        number = 0
        difference: dict[str, Any] | None = None
        for number, (mine, its) in enumerate(itertools.zip_longest(one.events(), other.events())):
            if mine != its:
                told = [None if event is None else [event.time_us, event.source, event.kind, event.data] for event in (mine, its)]
                times = [event.time for event in (mine, its) if event is not None]
                difference = {"number": number, "time": min(times), "events": told}
                break
        same = number if difference is not None else one.event_count
        return {"parameters": different, "difference": difference, "same_events": same}


def _told(facts: dict[str, Any]) -> dict[str, Any]:
    """Returns what of a run's facts was chosen by who began it."""
    seed = facts.get("program_seed", facts.get("seed"))
    texts = sorted(facts.get("sources", {}).values())
    text = hashlib.sha256("\0".join(texts).encode("utf-8", "replace")).hexdigest()[:12]
    return {**facts.get("parameters", {}), "seed": seed, "model": Path(facts.get("file", "")).name, "text": text}
