"""Passing apertures from 0.9 to 2.1 shoulder widths, as in Wilmut & Barnett (2010)."""

from actr3d.experiment.design import Design, Group, design
from actr3d.experiment.designs.passability_judgement import aperture_of
from actr3d.experiment.designs.warren_whang_1987 import KNOWS_ITS_BODY
from actr3d.experiment.distributions import Normal

RATIOS = (0.9, 1.1, 1.3, 1.5, 1.7, 1.9, 2.1)
"""The apertures in shoulder widths. Source: the range of Wilmut & Barnett (2010), in steps of 0.2."""


@design
def wilmut_ratios() -> Design:
    """Walking through doorways whose width is set by the walker's own shoulders: 0.9 to 2.1 shoulder widths.

    Participants have the shoulder widths of both groups of Warren & Whang (1987) taken together; those of the study are not at hand.
    """
    width = Normal(mean=0.444, sd=0.04, low=0.35, high=0.55)
    return Design(
        model="aperture_passage.py",
        factors={"ratio": RATIOS},
        groups={"adults": Group(participants=12, parameters={"shoulder_width": width})},
        settings=KNOWS_ITS_BODY,
        derive=aperture_of,
        trials=5,
    )
