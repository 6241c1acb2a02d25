"""Passages by which a walker gathers experience, with empty hands and with a bar."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from actr3d.experiment.design import Design, Group, Measured, design
from actr3d.experiment.distributions import Uniform

BODIES = {"shoulder_width": Uniform(low=0.36, high=0.52), "speed": Uniform(low=0.8, high=2.0)}


@design
def doorway_practice() -> Design:
    """Walking through doorways with given turns: what the `predictive` walker remembers of passages with empty hands.

    Bodies, speeds and doorways are random. `python -m actr3d.experiment.aperture FOLDER ...` makes the file of
    experiences that is shipped, from this design, from `bar_practice`, and from both with `--set gait=False`.
    """
    return Design(
        model="predictive_walker.py",
        factors={"turn": tuple(float(turn) for turn in range(0, 81, 10))},
        settings={"gait": True},
        groups={"all": Group(participants=160, parameters={**BODIES, "aperture": Uniform(low=0.25, high=0.75)})},
        results=remembered,
        measures=[
            Measured(name="seen", unit="m", meaning="Seen width of the doorway."),
            Measured(name="felt", unit="m", meaning="Felt width of the turned body, with what it holds."),
            Measured(name="energy", unit="J", meaning="Energy of all contacts, at most that of the walk."),
            Measured(name="free", meaning="Whether it passed and touched nothing."),
            Measured(name="passed", meaning="Whether it passed."),
        ],
    )


@design
def bar_practice() -> Design:
    """Walking through doorways with a bar in the hands and given turns: what the `predictive` walker remembers of these.

    The length of the bar is random, too (0.3 to 1.2 m); doorways are from 0.6 to 1.5 times as wide as the wider of body and bar.
    """
    drawn = {**BODIES, "bar": Uniform(low=0.3, high=1.2), "ratio": Uniform(low=0.6, high=1.5)}
    return replace(doorway_practice(), groups={"all": Group(participants=160, parameters=drawn)}, derive=aperture)


def aperture(values: Mapping[str, Any]) -> dict[str, float]:
    """Returns the aperture [m]: a ratio of the widest of body and bar."""
    return {"aperture": values["ratio"] * max(values["shoulder_width"], values["bar"])}


def remembered(simulation: Any) -> dict[str, Any]:
    """Returns what the walker remembers of its passage."""
    from actr3d.experiment.aperture.experience import passage_remembered  # loads the world, which to list the designs does without

    return passage_remembered(simulation.agents["walker"].committed, simulation.result())
