"""The judgements of Warren & Whang (1987) of whether one could pass an aperture without turning."""

from collections.abc import Mapping
from typing import Any

from actr3d.experiment.design import Design, Group, Measured, Normal, design

RATIOS = tuple(round(0.9 + 0.04 * n, 2) for n in range(14))
"""The apertures in shoulder widths. Source: chosen, around the boundary that people judge, about 1.16 (docs/human-data.md)."""
WIDTHS = {"small": (0.404, 0.020), "large": (0.484, 0.007)}
"""The mean and standard deviation of shoulder widths [m]. Source: Warren & Whang (1987)."""


def aperture_of(values: Mapping[str, Any]) -> dict[str, float]:
    """Returns the aperture [m] of a ratio."""
    return {"aperture": round(values["ratio"] * values["shoulder_width"], 4)}


def judgement(simulation: Any) -> dict[str, Any]:
    """Returns what the walker judged, and when [s]."""
    judged = simulation.agents["walker"].judged
    return {"judged": judged, "passable": judged == "as it is", "time_s": simulation.time}


@design
def passability_judgement() -> Design:
    """Judging from a distance whether one could pass without turning (Warren & Whang 1987, the static «can you pass?»).

    What was put in: the judged ratio of the `descriptive` variant, 1.16, is its parameter; only its spread comes from the noise of vision.
    """
    groups = {
        name: Group(participants=5, parameters={"group": name, "shoulder_width": Normal(mean=mean, sd=sd, low=0.3, high=0.7)})
        for name, (mean, sd) in WIDTHS.items()
    }
    return Design(
        model="aperture_passage.py",
        factors={"ratio": RATIOS},
        groups=groups,
        settings={"task": "judge"},
        derive=aperture_of,
        results=judgement,
        measures=[
            Measured(name="judged", meaning="How the walker judged that it can pass: «as it is» (not turned), «turned», or «not at all»."),
            Measured(name="passable", meaning="Whether it judged that it can pass without turning."),
            Measured(name="time_s", unit="s", meaning="The simulated time of the judgement."),
        ],
        trials=10,
    )
