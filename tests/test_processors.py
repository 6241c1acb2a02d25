"""The number of processors is the one that Dask uses; without Dask, that of the processors on which the process may run."""

from __future__ import annotations

import os
import sys

import pytest
from dask.system import CPU_COUNT

from actr3d.processors import processors


def test_the_number_of_processors_is_the_one_that_dask_uses(monkeypatch: pytest.MonkeyPatch) -> None:
    assert processors() == CPU_COUNT
    monkeypatch.setitem(sys.modules, "dask.system", None)
    monkeypatch.setattr(os, "sched_getaffinity", {0: {0, 2, 3}}.get, raising=False)  # macOS has none
    assert processors() == 3
    monkeypatch.delattr(os, "sched_getaffinity")
    assert processors() == os.cpu_count()
