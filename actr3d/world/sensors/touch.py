"""The skin: what touches which part of a body, and with which force.

From the first reading of its contacts on, a body's skin watches every physics step and keeps the peak force of each touch within a tick, so
that it also reports a blow that ends within the tick. The first reading is of the present state alone.
"""

from __future__ import annotations

from collections.abc import Iterable

from actr3d.world.body import Body, sensor
from actr3d.world.contacts import Touch


@sensor
def contacts(body: Body) -> tuple[Touch, ...]:
    """Senses what touches the skin, with the peak force in the last tick [N], sorted by name."""
    if body.touched is None:
        body.touched = present(body)
    return body.touched


def present(body: Body) -> tuple[Touch, ...]:
    """Returns what touches the skin in the present state, sorted by name. For observers: later readings of the agent stay the same."""
    body.physics.solve()
    return body.contacts.touches()


def step_and_feel(steps: Iterable[None], bodies: Iterable[Body]) -> None:
    """Makes single steps of the physics, and gives some bodies the peak force of each of their touches.

    Args:
        steps: Makes the next step with each item.
        bodies: Those that feel, all of one world.
    """
    felt: list[tuple[Body, dict[tuple[str, str], Touch]]] = [(body, {}) for body in bodies]
    for _ in steps:
        for body, hardest in felt:
            for touch in body.contacts.touches():
                known = hardest.get((touch.part, touch.other))
                if known is None or touch.force > known.force:
                    hardest[touch.part, touch.other] = touch
    for body, hardest in felt:
        body.touched = tuple(touch for _, touch in sorted(hardest.items()))
