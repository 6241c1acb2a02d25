"""The logs of Python ACT-R: lines of text, an HTML table, data files, and a summary.

A log is written by setting attributes: `log.score = 3`, `agent.log.mood = 'good'`; `log_everything` writes such a line for
every change of every model's attributes. If a program runs several models one after another, a line's time is that of the
latest step of any run, as in python_actr 1.9.5.
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
    """The destination of all log lines of a program."""

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
        """Whether the model's own settings are ignored, as in a parameter sweep."""
        self.announce = False
        """Whether to print a last line, as python_actr 1.9.5 does; true for models that import it by name."""
        self.reset()

    def reset(self) -> None:
        """Clears the log."""
        self.data: dict[str, Any] = {}
        self.rows: list[tuple[float, str, Any]] = []
        self.time_us = 0
        self._stem: str | None = None

    def __bool__(self) -> bool:
        """Returns whether there is anything to show at the end: a line, or time that passed while lines were kept."""
        keeps = self.do_data or self.do_summary or self.do_html
        return bool(self.data or self.rows or (keeps and self.time > 0))

    @property
    def time(self) -> float:
        """The time of the latest step of any run [s]."""
        return self.time_us / MICROSECONDS

    def set(self, key: str, value: Any) -> None:
        """Writes one line."""
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
        """Returns the path of a new file in the log's directory, which is created."""
        name = self.directory or (self.source or sys.argv[0]).removesuffix(".py") or "log"
        folder = Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        if self._stem is None:  # one name for all files of a log
            # The name is not part of the run and must not use its random numbers.
            mark = f"{random.SystemRandom().randrange(0x7FFFFFFF):08x}"
            self._stem = f"{time.strftime('%Y%m%d-%H%M%S')}-{mark}"
        return folder / f"{self._stem}{ending}"


class DummyLog:
    """A log that ignores everything; it is false, so that callers need not compute anything for it."""

    def set(self, key: str, value: Any) -> None:
        """Ignores a line."""

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
    """A prefix in a log: `proxy.a.b = 3` and `proxy['x'] = 4` write lines below the prefix, `proxy._ = 5` one with the prefix itself."""

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
    """Changes the settings of the program's log, and returns it; None keeps a setting.

    Args:
        screen: Whether to print each line.
        html: Whether to write an HTML table at the end.
        data: Whether to write the last value of everything to a file at the end.
        summary: Whether to print the last value of everything at the end.
        directory: The directory of the files; by default named after the model file.
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
    log._ = text  # the attribute that python_actr's logs have for lines of text


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
    """Starts an empty log for one program, with default settings unless a parameter sweep has set them.

    Returns:
        A function that restores the previous log with its contents.
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
