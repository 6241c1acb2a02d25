"""Walking through apertures with a bar in the hands, as in Higuchi, Seya & Imanaka (2012)."""

from collections.abc import Mapping
from typing import Any

from actr3d.experiment.design import Design, Group, design
from actr3d.experiment.designs.warren_whang_1987 import KNOWS_ITS_BODY
from actr3d.experiment.distributions import Normal

SHORT = 0.8
"""The length of the short bar, in shoulder widths: it does not stand out. Source: chosen; the length is not at hand."""


def bar_and_aperture(values: Mapping[str, Any]) -> dict[str, float]:
    """Returns the bar and the aperture [m]: the ratio is that of the aperture to the widest of body and bar."""
    width, times = values["shoulder_width"], values["bar_ratio"]
    return {"bar": round(times * width, 4), "aperture": round(values["ratio"] * max(1.0, times) * width, 4)}


@design
def higuchi_2012() -> Design:
    """Walking through doorways with a short bar, and with bars of 1.5 and 2.5 body widths (Higuchi, Seya & Imanaka 2012).

    People turn less with a longer bar at the same ratio of the aperture to the total width.
    """
    return Design(
        model="aperture_passage.py",
        factors={"bar_ratio": (SHORT, 1.5, 2.5), "ratio": (0.9, 1.0, 1.1)},
        groups={"adults": Group(participants=8, parameters={"shoulder_width": Normal(mean=0.428, sd=0.035, low=0.3, high=0.6)})},
        settings=KNOWS_ITS_BODY,
        derive=bar_and_aperture,
        trials=10,
    )
