"""`actr3d bench soak`: runs a million ticks, and checks for drift and for growth in memory."""

from __future__ import annotations

import gc
import os
import subprocess
from pathlib import Path

from actr3d.bench.lockstep import typical
from actr3d.benchmark import Measurement, benchmark, seconds_of

TICKS = 1_000_000
"""The number of ticks: 10,000 s of simulated time."""
PARTS = 10
"""The number of parts; memory is measured after each."""


def resident() -> float:
    """Returns the memory of this process [MB]."""
    gc.collect()
    status = Path("/proc/self/status")
    if not status.exists():  # as on macOS
        return int(subprocess.check_output(["ps", "-o", "rss=", "-p", str(os.getpid())])) / 1024
    (kilobytes,) = (line.split()[1] for line in status.read_text(encoding="ascii").splitlines() if line.startswith("VmRSS:"))
    return int(kilobytes) / 1024


@benchmark("soak")
def measure(ticks: int = TICKS) -> list[Measurement]:
    """Runs a million ticks of the typical agent, and measures drift and the growth of memory."""
    resident()  # where it cannot be measured, this is known before the run
    simulation = typical()
    memory: list[float] = []
    spent = 0.0
    for _ in range(PARTS):
        spent += seconds_of(lambda: simulation.step(ticks // PARTS))
        memory.append(resident())
    agent = simulation.agents["walker"]
    expected = ticks * 10_000
    drift = abs(agent.sch.now_us - expected) + abs(simulation.world.time - expected)
    # The history kept for going back grows to its limits in the first part.
    begin = memory[1]
    return [
        Measurement(name="drift", value=drift, sense="at most", limit=0, what=f"us between the clocks after {ticks:,} ticks"),
        Measurement(
            name="growth",
            value=memory[-1] - begin,
            sense="at most",
            limit=2,
            what=f"MB of memory ({begin:.0f} MB after two tenths, {memory[-1]:.0f} in the end)",
        ),
        Measurement(name="time", value=spent / ticks * 1e6, sense="at most", limit=1000, what=f"us a tick ({spent:.0f} s in all)"),
    ]
