"""Starts that are not in line with the doorway."""

from actr3d.experiment.design import Design, Group, design
from actr3d.experiment.designs.warren_whang_1987 import KNOWS_ITS_BODY
from actr3d.experiment.distributions import Normal


@design
def misaligned_start() -> Design:
    """Walking through doorways from 0 to 50 cm beside their middle, and 0 to 10 degrees off the straight direction.

    A walker that does not steer passes few of these; one that does keeps the same room on both sides.
    """
    return Design(
        model="aperture_passage.py",
        factors={"start_aside": (0.0, 0.1, 0.25, 0.5), "start_heading": (0.0, 5.0, 10.0), "aperture": (0.5, 0.7)},
        groups={"adults": Group(participants=5, parameters={"shoulder_width": Normal(mean=0.404, sd=0.02, low=0.3, high=0.6)})},
        settings=KNOWS_ITS_BODY,
        trials=5,
    )
