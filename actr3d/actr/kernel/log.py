"""The logs of Python ACT-R: lines of text, an HTML table, data files, and a summary.

A log is written by setting attributes: `log.score = 3`, `agent.log.mood = 'good'`; `log_everything` makes every change
of every model's attributes such a line. Where times of several runs follow one another in one program, a line's time is
that of the latest step of any run, as in python_actr 1.9.5.
"""

from __future__ import annotations

import random
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from actr3d.clock import MICROSECONDS

BASIC = (int, float, bool, str, tuple, list, dict)


class Log:
    """Where all log lines of a program go."""

    def __init__(self) -> None:
        self.time_us = 0
        self.do_screen = True
        self.do_html = False
        self.do_summary = False
        self.do_data = False
        self.directory: str | None = None
        self.source: str | None = None
        """The model file that is being run; the default directory is named after it."""
        self.locked = False
        """Whether the model's own settings are left unheard, as in a parameter sweep."""
        self.announce = False
        """Whether to print a last line, as python_actr 1.9.5 does; so for models that import it by name."""
        self.reset()

    def reset(self) -> None:
        """Forgets what was logged."""
        self.data: dict[str, Any] = {}
        self.rows: list[tuple[float, str, Any]] = []
        self.time_us = 0
        self._stem: str | None = None

    def __bool__(self) -> bool:
        """Tells whether there is anything to show at the end: a line, or time that passed while something was kept."""
        keeps = self.do_data or self.do_summary or self.do_html
        return bool(self.data or self.rows or (keeps and self.time > 0))

    @property
    def time(self) -> float:
        """When the latest step of any run was [s]."""
        return self.time_us / MICROSECONDS

    def set(self, key: str, value: Any) -> None:
        """Takes one line."""
        if key == "time":
            self.time_us = round(value * MICROSECONDS)
        elif self.do_screen:
            print(f"{self.time:8.3f} {key} {value}")  # noqa: T201 - the log's own output
        if self.do_data or self.do_summary:
            self.data[key] = value
        if self.do_html and key != "time":
            self.rows.append((self.time, key, value if isinstance(value, (bool, int, float, str)) else repr(value)))

    def display_all(self) -> None:
        """Prints the last value of everything."""
        if self.time > 0:
            print(f"Total time: {self.time:8.3f}")  # noqa: T201 - the log's own output
        for key in sorted(self.data):
            if key != "time":
                print(f" {key} {self.data[key]}")  # noqa: T201 - the log's own output

    def file(self, ending: str) -> Path:
        """Returns a new file's path in the log's directory, and makes the directory."""
        name = self.directory or (self.source or sys.argv[0]).removesuffix(".py") or "log"
        folder = Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        if self._stem is None:  # one name for all files of a log
            # It is no part of the run: it does not draw from the run's random numbers.
            mark = f"{random.SystemRandom().randrange(0x7FFFFFFF):08x}"
            self._stem = f"{time.strftime('%Y%m%d-%H%M%S')}-{mark}"
        return folder / f"{self._stem}{ending}"


class DummyLog:
    """Takes everything and keeps nothing; false, so that nobody computes for it."""

    def set(self, key: str, value: Any) -> None:
        """Takes a line."""

    def __bool__(self) -> bool:
        return False

    def __setattr__(self, key: str, value: Any) -> None:
        pass

    def __getattr__(self, key: str) -> DummyLog:
        if key[:1] == "_" and key != "_":
            raise AttributeError(key)
        return self

    def __setitem__(self, key: Any, value: Any) -> None:
        pass

    def __getitem__(self, key: Any) -> DummyLog:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> DummyLog:
        return self


class LogProxy:
    """A place in a log: `proxy.a.b = 3` and `proxy['x'] = 4` write lines named after the place; `proxy._ = 5` names the place itself."""

    if TYPE_CHECKING:
        _log: Log
        _prefix: str
        _items: dict[Any, LogProxy]

    def __init__(self, target: Log, prefix: str = "") -> None:
        own = self.__dict__
        own["_log"] = target
        own["_prefix"] = prefix.removeprefix(".")
        own["_items"] = {}

    def __setattr__(self, key: str, value: Any) -> None:
        if key == "_":
            self._write(self._prefix, value)
        elif key[0] == "_":
            self.__dict__[key] = value
        else:
            self._write(f"{self._prefix}.{key}".removeprefix("."), value)

    def __getattr__(self, key: str) -> LogProxy:
        if key == "_":
            return self
        if key[0] == "_":
            raise AttributeError(key)
        place = self.__dict__[key] = LogProxy(self._log, f"{self._prefix}.{key}")
        return place

    def __setitem__(self, key: Any, value: Any) -> None:
        self._write(f"{self._prefix}[{key}]", value)

    def __getitem__(self, key: Any) -> LogProxy:
        items = self._items
        if key not in items:
            items[key] = LogProxy(self._log, f"{self._prefix}[{key}]")
        return items[key]

    def __deepcopy__(self, memo: dict[int, Any]) -> LogProxy:
        return self

    def _write(self, place: str, value: Any) -> None:
        self._log.set(place, value if isinstance(value, BASIC) else repr(value))


LOG = Log()
log_proxy = LogProxy(LOG)
dummy = DummyLog()


def log(
    screen: bool | None = None,
    html: bool | None = None,
    data: bool | None = None,
    summary: bool | None = None,
    directory: str | None = None,
) -> LogProxy:
    """Returns the program's log, after changing what it does; None leaves a setting as it is.

    Args:
        screen: Whether to print each line.
        html: Whether to write an HTML table at the end.
        data: Whether to write the last value of everything to a file at the end.
        summary: Whether to print the last value of everything at the end.
        directory: Where files go; named after the model file unless given.
    """
    if LOG.locked:
        return log_proxy
    if screen is not None:
        LOG.do_screen = screen
    if html is not None:
        LOG.do_html = html
    if data is not None:
        LOG.do_data = data
    if summary is not None:
        LOG.do_summary = summary
    if directory is not None:
        LOG.directory = directory
    return log_proxy


def log_line(log: Any, text: object) -> None:
    """Writes a line of text to a model's log, under the model's own name."""
    log._ = text


def log_everything(model: Any, log: Any = None) -> None:
    """Logs every change of every public attribute of a model and of all models below it."""
    if log is None:
        log = log_proxy
    if not hasattr(model, "log"):
        model.run(limit=0)
    model.log = log
    attributes: dict[str, Any] = dict(model.__dict__)
    for key, part in attributes.items():
        if key[0] != "_" and key != "parent" and hasattr(part, "get_children") and getattr(part, "parent", None) is model:
            log_everything(part, getattr(log, key))


def begin() -> Callable[[], None]:
    """Begins a log for one program: empty, and set as at first unless a parameter sweep has set it.

    Returns:
        A function that puts back the log as it was before, with what was in it.
    """
    before = dict(vars(LOG))
    if LOG.locked:
        LOG.reset()
    else:
        LOG.__init__()

    def restore() -> None:
        vars(LOG).clear()
        vars(LOG).update(before)

    return restore
