"""The number of processors is that of the machine, or the limit of a container."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from dask.system import cpu_count

from actr3d.processors import processors


def test_the_number_of_processors_is_the_one_that_dask_uses(tmp_path: Path) -> None:
    assert processors() == cpu_count()
    assert processors(tmp_path) == len(os.sched_getaffinity(0)), "without any limit"


@pytest.mark.parametrize(
    ("files", "limit"),
    [
        ({"proc/self/cgroup": "0::/job/step\n", "sys/fs/cgroup/job/step/cpu.max": "50000 100000\n"}, 1),
        ({"proc/self/cgroup": "0::/\n", "sys/fs/cgroup/cpu.max": "6100000 100000\n"}, 61),
        ({"proc/self/cgroup": "0::/\n", "sys/fs/cgroup/cpu.max": "max 100000\n"}, None),
        ({"proc/self/cgroup": "0::/\n"}, None),
        ({"sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us": "20000\n", "sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us": "10000\n"}, 2),
        ({"sys/fs/cgroup/cpuacct,cpu/cpu.cfs_quota_us": "-1\n", "sys/fs/cgroup/cpuacct,cpu/cpu.cfs_period_us": "10000\n"}, None),
    ],
)
def test_limits_of_a_container_are_kept(tmp_path: Path, files: dict[str, str], limit: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
    def all_of_100(_: int) -> range:
        return range(100)

    monkeypatch.setattr(os, "sched_getaffinity", all_of_100)
    monkeypatch.setattr(os, "process_cpu_count", lambda: 100, raising=False)
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    assert processors(tmp_path) == (limit or 100)
