"""The judgements of Warren & Whang (1987) of whether one could pass an aperture without turning."""

from collections.abc import Mapping
from typing import Any

from actr3d.experiment.design import Design, Measured, design
from actr3d.experiment.designs.warren_whang_1987 import GROUPS, KNOWS_ITS_BODY

RATIOS = tuple(round(0.9 + 0.04 * n, 2) for n in range(14))
"""The apertures in shoulder widths. Source: chosen, around the boundary that people judge, about 1.16 (docs/human-data.md)."""


def aperture_of(values: Mapping[str, Any]) -> dict[str, float]:
    """Returns the aperture [m] of a ratio."""
    return {"aperture": round(values["ratio"] * values["shoulder_width"], 4)}


def judgement(simulation: Any) -> dict[str, Any]:
    """Returns what the walker judged, and when [s]; None for what it has not judged by the end."""
    judged = simulation.agents["walker"].judged
    return {"judged": judged, "passable": None if judged is None else judged == "as it is", "time_s": simulation.time}


@design
def passability_judgement() -> Design:
    """Judging from a distance whether one could pass without turning (Warren & Whang 1987, the static «can you pass?»).

    What was put in: the judged ratio of the `descriptive` variant, 1.16, is its parameter; only its spread comes from the noise of vision.
    """
    return Design(
        model="aperture_passage.py",
        factors={"ratio": RATIOS},
        groups=GROUPS,
        settings={"task": "judge", **KNOWS_ITS_BODY},
        derive=aperture_of,
        results=judgement,
        measures=[
            Measured(name="judged", meaning="How the walker judged that it can pass: «as it is» (not turned), «turned», or «not at all»."),
            Measured(name="passable", meaning="Whether it judged that it can pass without turning; empty if it did not judge."),
            Measured(name="time_s", unit="s", meaning="The simulated time of the judgement."),
        ],
        trials=10,
    )
