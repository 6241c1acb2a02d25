"""The skin: what touches which part of a body, and with which force.

From the first reading of its contacts on, a body's skin watches every physics step and keeps the peak force of each touch within a tick, so
that it also reports a blow that ends within the tick. The first reading is of the present state alone.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager

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


@contextmanager
def feel_steps(bodies: Iterable[Body]) -> Generator[Callable[[], None]]:
    """Stores for some bodies the peak force of each of their touches in the steps that the block makes.

    Args:
        bodies: Those that feel, all of one world.

    Yields:
        What the block calls after each step.
    """
    felt: list[tuple[Body, dict[tuple[str, str], Touch]]] = [(body, {}) for body in bodies]

    def feel() -> None:
        for body, hardest in felt:
            for touch in body.contacts.touches():
                known = hardest.get((touch.part, touch.other))
                if known is None or touch.force > known.force:
                    hardest[touch.part, touch.other] = touch

    yield feel
    for body, hardest in felt:
        body.touched = tuple(touch for _, touch in sorted(hardest.items()))
