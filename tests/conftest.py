"""Settings of all tests."""

from __future__ import annotations

import atexit
import gc
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import settings

from tests.helpers.paths import MODELS

# The same examples each time, so that a failure is the change's own. EXPLORE=1 looks for new ones.
settings.register_profile("same", derandomize=True, deadline=None)
settings.register_profile("explore", deadline=None)
settings.load_profile("explore" if os.environ.get("EXPLORE") else "same")

# Hundreds of tests start Python again: without bytecode on disk, each would compile all libraries for seconds.
if os.environ.pop("PYTHONDONTWRITEBYTECODE", None) is not None:
    sys.dont_write_bytecode = False

# With several processes on all processors, threads of linear algebra wait for each other: tests of reports take twice as long.
os.environ.setdefault("OMP_NUM_THREADS", "1")

# Tests leave the user's cache and key alone.
os.environ["XDG_CACHE_HOME"] = os.environ["XDG_DATA_HOME"] = tempfile.mkdtemp(prefix="actr3d-tests-")
atexit.register(shutil.rmtree, os.environ["XDG_DATA_HOME"], ignore_errors=True)

# A shell ignores SIGINT for what it starts in the background, and `nohup` SIGHUP; what the tests start would inherit that.
for number, usual in ((signal.SIGINT, signal.default_int_handler), (signal.SIGHUP, signal.SIG_DFL)):
    if signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, usual)


gc.disable()  # until all tests are collected: garbage collections would take a third of that time


def pytest_collection_finish() -> None:
    """Turns garbage collection on, and leaves the thousands of collected tests out of it. It runs less often than by default."""
    gc.freeze()
    gc.set_threshold(10_000)
    gc.enable()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> Iterator[None]:
    """Leaves out of it, after the tests of each file, what then remains: the libraries that they imported, and what is cached."""
    yield
    if nextitem is not None and nextitem.path != item.path:
        gc.collect()
        gc.freeze()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """Returns the number of processes: one more than there are processors, as tests wait much for processes and browsers."""
    return (os.cpu_count() or 1) + 1


COMPILING = pytest.StashKey[subprocess.Popen[bytes]]()


def pytest_sessionstart(session: pytest.Session) -> None:
    """Begins to compile what models with a body need, while the processes collect the tests."""
    if "PYTEST_XDIST_WORKER" not in os.environ and session.config.getoption("numprocesses", None):
        model = MODELS / "aperture_passage.py"
        run = f"from workbench.worker.fork_server import preload; from actr3d.cli import main; preload(); main(['run', {str(model)!r}])"
        compiling = subprocess.Popen([sys.executable, "-c", run], stdout=subprocess.DEVNULL)
        session.config.stash[COMPILING] = compiling

        def reap() -> None:
            compiling.wait()

        session.config.add_cleanup(reap)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_node_collection_finished(node: Any) -> None:
    """Waits until that is compiled before a process gets its first test: each would compile it."""
    node.config.stash[COMPILING].wait()


@pytest.hookimpl(tryfirst=True)  # before pytest leaves out what is marked as slow
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Marks as `slow` all cases of a test but the `n` that are marked to be run daily: `@pytest.mark.daily(n)`, evenly spaced.

    Tests that are marked as `long` come first, so that no process still runs them when the others have nothing left to do.
    """
    cases: dict[str, list[pytest.Item]] = {}
    for item in items:
        if item.get_closest_marker("daily") is not None:
            cases.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for test in cases.values():
        marker = test[0].get_closest_marker("daily")
        assert marker is not None
        kept = {number * len(test) // marker.args[0] for number in range(marker.args[0])}
        for number, item in enumerate(test):
            if number not in kept:
                item.add_marker(pytest.mark.slow)
    items.sort(key=lambda item: item.get_closest_marker("long") is None)
