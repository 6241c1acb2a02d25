"""`actr3d soak`: a million ticks, without drift or growth in memory."""

from __future__ import annotations

import gc
from pathlib import Path

from actr3d.bench.figures import Figure, report, seconds_of
from actr3d.bench.lockstep import typical

TICKS = 1_000_000
"""How far it goes: 10,000 s of simulated time."""
PARTS = 10
"""In how many parts memory is looked at."""


def resident() -> float:
    """Returns how much memory the process has now [MB]."""
    gc.collect()
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024
    raise OSError("this system does not tell how much memory a process has")


def measure(ticks: int = TICKS) -> list[Figure]:
    """Runs the typical agent, and measures."""
    simulation = typical()
    memory: list[float] = []
    spent = 0.0
    for _ in range(PARTS):
        spent += seconds_of(lambda: simulation.step(ticks // PARTS))
        memory.append(resident())
    mind = simulation.minds["walker"]
    expected = ticks * 10_000
    drift = abs(mind.sch.now_us - expected) + abs(simulation.world.time - expected)
    # What is kept to go back to grows to its bounds in the first part.
    growth = memory[-1] - memory[1]
    return [
        Figure(name="drift", value=drift, sense="at most", bar=0, what=f"us between the clocks after {ticks:,} ticks"),
        Figure(
            name="growth",
            value=growth,
            sense="at most",
            bar=2,
            what=f"MB of memory ({memory[0]:.0f} MB after a tenth, {memory[-1]:.0f} in the end)",
        ),
        Figure(name="time", value=spent / ticks * 1e6, sense="at most", bar=1000, what=f"us a tick ({spent:.0f} s in all)"),
    ]


def main(*, json_output: bool) -> int:
    """Measures and prints; returns the exit code."""
    return report(measure(), json_output=json_output)
