"""Passages by which a walker gathers experience."""

from typing import Any

from actr3d.experiment.aperture.experience import passage_remembered
from actr3d.experiment.design import Design, Group, Measured, Uniform, design


@design
def doorway_practice() -> Design:
    """Walking through doorways with turns that are not chosen: what the `predictive` walker remembers of passages.

    Bodies, speeds and doorways are random. `python -m actr3d.experiment.aperture FOLDER ...` makes the file of
    experiences that is shipped, from this design and from the same with `--set gait=False`.
    """
    drawn = {
        "shoulder_width": Uniform(low=0.36, high=0.52),
        "speed": Uniform(low=0.8, high=2.0),
        "aperture": Uniform(low=0.25, high=0.75),
    }
    return Design(
        model="predictive_walker.py",
        factors={"turn": tuple(float(turn) for turn in range(0, 81, 10))},
        settings={"gait": True},
        groups={"all": Group(participants=160, parameters=drawn)},
        results=remembered,
        measures=[
            Measured(name="room", unit="m", meaning="Seen width of the doorway minus felt width of the turned body."),
            Measured(name="energy", unit="J", meaning="Energy of all impacts together."),
            Measured(name="free", meaning="Whether it passed and touched nothing."),
            Measured(name="passed", meaning="Whether it passed."),
        ],
    )


def remembered(simulation: Any) -> dict[str, Any]:
    """Returns what the walker remembers of its passage."""
    return passage_remembered(simulation.agents["walker"].committed, simulation.result())
