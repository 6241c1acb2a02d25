"""The experiment of Warren & Whang (1987) on walking through apertures."""

from actr3d.experiment.design import Design, Group, design
from actr3d.experiment.distributions import Normal

APERTURES = (0.35, 0.40, 0.45, 0.50, 0.55, 0.60, 0.65, 0.70)
"""The widths of the doorways [m]. Source: Warren & Whang (1987)."""
WIDTHS = {"small": (0.404, 0.020), "large": (0.484, 0.007)}
"""The mean and standard deviation of shoulder widths [m]. Source: Warren & Whang (1987)."""
KNOWS_ITS_BODY = {"body": "known"}
"""Walkers know how wide they are in each posture, as people do, and need not learn it in each trial."""
GROUPS = {
    name: Group(participants=5, parameters={"group": name, "shoulder_width": Normal(mean=mean, sd=sd, low=0.3, high=0.7)})
    for name, (mean, sd) in WIDTHS.items()
}
"""The two groups of the experiment."""


@design
def warren_whang_1987() -> Design:
    """Walking through doorways: small and large people, normal and fast, eight widths (Warren & Whang 1987, experiment 1).

    The speeds are the means of the groups. There are 60 trials of each participant in each cell, twice those of the original
    ACT-R 3D's simulation.
    """
    factors = {"aperture": APERTURES, "condition": ("normal", "fast")}
    return Design(
        model="aperture_passage.py", factors=factors, groups=GROUPS, settings=KNOWS_ITS_BODY, trials=60, human="warren_whang_1987"
    )
