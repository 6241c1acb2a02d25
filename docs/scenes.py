"""Runs the walks that docs/results.md describes under «Other scenes»: `uv run python docs/scenes.py [words of a line]`.

Each line is one scene. It takes about half an hour on two processors; words choose the lines that contain them.
"""

from __future__ import annotations

import io
import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text

FILE = Path(__file__).parents[1] / "models" / "predictive_walker.py"
LONGEST = 60.0
"""The longest duration of a walk [s]."""
USUAL = range(201, 221)
"""The usual seeds."""
NEW = range(500, 520)
"""Seeds of two people. Nothing in the model was changed because of one of them."""


@dataclass(frozen=True, kw_only=True)
class Walk:
    """How a walk ended."""

    seed: int
    beyond: tuple[str, ...]
    """The names of those whose base is behind the doorway at the end."""
    side: str
    """The side on which the walker ended."""
    touched: tuple[str, ...]
    """What somebody touched."""
    waits: int
    """How often somebody began to wait."""
    turn: float | None
    """The turn for which the walker decided [degrees]; None if it did not set out to pass."""
    seen: float | None
    """The width of the doorway that it saw when it decided to pass or to decline [m]."""


@dataclass(frozen=True)
class Group:
    """Walks with the same parameters."""

    parameters: dict[str, Any]
    seeds: Sequence[int] = field(default=USUAL, kw_only=True)

    def __str__(self) -> str:
        return ", ".join(f"{name} {value}" for name, value in self.parameters.items())


GROUPS = (
    Group({"scene": "pillar", "aperture": 0.8}),
    Group({"scene": "pillar", "aperture": 1.2}),
    Group({"scene": "two doorways", "aperture": 1.0}, seeds=USUAL[:16]),
    Group({"aperture": 0.9, "closing": 0.15}, seeds=[*USUAL, *range(1, 21)]),
    Group({"aperture": 0.9, "closing": 0.065}),
    Group({"aperture": 0.52}, seeds=USUAL[:12]),
    Group({"aperture": 0.47}, seeds=USUAL[:12]),
    *(
        Group({"scene": "two people", "aperture": width}, seeds=range(500, 540) if width == 1.0 else NEW)
        for width in (0.6, 0.8, 1.0, 1.1, 1.2, 1.6)
    ),
)


@cache
def model() -> Any:
    return load_text(FILE.read_text(encoding="utf-8"), str(FILE))


def walk(parameters: dict[str, Any], seed: int, *, longest: float = LONGEST) -> Walk:
    """Returns how the walk with a seed ended, after a duration [s] at the latest."""
    told, touched = io.StringIO(), set[str]()
    with RunLimits(seed=seed, until=longest), redirect_stdout(told):
        simulation = model().build(model().Parameters(**parameters))
        bodies = simulation.world.bodies
        simulation.world.watchers.append(
            lambda: touched.update(touch.other for body in bodies.values() for touch in body.contacts.touches())
        )
        simulation.run()
    walker = simulation.agents["walker"]
    ways = {name: (-1 if name == "other" else 1) * (body.base.pose[0] - model().DISTANCE) for name, body in bodies.items()}
    return Walk(
        seed=seed,
        beyond=tuple(name for name, way in ways.items() if way > 0),
        side="left" if bodies["walker"].base.pose[1] > 0 else "right",
        touched=tuple(sorted(touched)),
        waits=told.getvalue().count("waits"),
        turn=walker.chosen,
        seen=walker.committed and walker.committed["seen"],
    )


def report(group: Group, walks: Sequence[Walk]) -> str:
    """Returns the line of a group."""
    passed = Counter(len(one.beyond) for one in walks)
    parts = [f"{group}: {len(walks)} walks", f"{passed[1]} with one beyond the doorway"]
    if "two people" in str(group):
        parts.append(f"{passed[2]} with both, {passed[0]} with nobody")
    if "two doorways" in str(group):
        sides = Counter(one.side for one in walks)
        parts.append(f"{sides['left']} left, {sides['right']} right")
    parts.append(f"{sum(one.waits > 0 for one in walks)} with waiting")
    touching = {one.seed: ", ".join(one.touched) for one in walks if one.touched}
    parts.append(f"{len(touching)} with contact" + (f" {touching}" if 0 < len(touching) < len(walks) / 2 else ""))
    if turns := [one.turn for one in walks if one.turn is not None]:
        turn = f"{sum(turns) / len(turns):.1f} degrees ({min(turns):.0f} to {max(turns):.0f})"
        parts.append(f"{len(turns)} decided to pass, turning by {turn}")
    if seen := [one.seen for one in walks if one.seen is not None]:
        parts.append(f"seen width {100 * sum(seen) / len(seen):.0f} cm")
    return "; ".join(parts)


def main() -> None:
    wanted = [group for group in GROUPS if all(word in str(group) for word in sys.argv[1:])]
    with ProcessPoolExecutor() as pool:
        walks = [[pool.submit(walk, group.parameters, seed) for seed in group.seeds] for group in wanted]
        for group, futures in zip(wanted, walks, strict=True):
            print(report(group, [future.result() for future in futures]), flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
