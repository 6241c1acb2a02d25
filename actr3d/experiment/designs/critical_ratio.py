"""The point at which people begin to turn their shoulders (Warren & Whang 1987)."""

from dataclasses import replace
from typing import Any

from actr3d.experiment.design import Design, Measured, design
from actr3d.experiment.designs.passability_judgement import aperture_of
from actr3d.experiment.designs.warren_whang_1987 import GROUPS, KNOWS_ITS_BODY

CRITICAL = 1.30
"""The ratio of aperture to shoulder width below which people turn. Source: Warren & Whang (1987)."""


@design
def critical_ratio() -> Design:
    """Walking through doorways of 1.30 shoulder widths, at normal speed: half of the passages should be turned.

    That is how we read «the ratio below which people turn»: the ratio is that of people over all groups and speeds, the half is our
    assumption. The free parameter of the `predictive` walker is fitted to this one number.
    """
    return Design(
        model="aperture_passage.py",
        factors={"ratio": (CRITICAL,)},
        groups={"small": replace(GROUPS["small"], participants=20)},
        settings={"variant": "predictive", **KNOWS_ITS_BODY},
        derive=aperture_of,
        results=decision,
        measures=[Measured(name="turned", meaning="Whether the walker chose to turn its shoulders.")],
        trials=5,
        human="critical_ratio",
    )


def decision(simulation: Any) -> dict[str, Any]:
    """Returns the measure `turned`: 1 if the walker chose to turn, 0 if not, None if it did not come to the doorway."""
    chosen = simulation.agents["walker"].chosen
    return {"turned": None if chosen is None else float(chosen > 0)}
