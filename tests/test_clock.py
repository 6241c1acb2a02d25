"""Time in whole microseconds, and the order of simultaneous events."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from actr3d.clock import EventQueue, microseconds, seconds
from actr3d.errors import SchedulerError


@pytest.mark.parametrize(
    ("given_", "expected"),
    [(0, 0), (1, 1_000_000), (0.05, 50_000), (0.1 + 0.2, 300_000), (1e-7, 0), (6e-7, 1), (-0.01, -10_000), (True, 1_000_000)],
)
def test_seconds_become_microseconds(given_: float, expected: int) -> None:
    assert microseconds(given_) == expected
    assert type(microseconds(given_)) is int


def test_other_kinds_of_number() -> None:
    assert microseconds(Decimal("0.05")) == microseconds(Fraction(1, 20)) == 50_000  # pyright: ignore


@pytest.mark.parametrize("wrong", [float("nan"), float("inf"), -float("inf"), "1", None, 1j, [1], 10**400])
def test_what_is_no_time_is_named(wrong: Any) -> None:
    with pytest.raises(SchedulerError, match=r"Timer\.delay must be a finite number of seconds \(got "):
        microseconds(wrong, "Timer.delay")


@given(st.integers(0, 10**13))
def test_microseconds_survive_the_way_to_seconds_and_back(time: int) -> None:
    assert microseconds(seconds(time)) == time


@given(st.lists(st.tuples(st.integers(0, 3), st.integers(-2, 2)), max_size=30))
def test_events_come_by_time_then_priority_then_order(events: list[tuple[int, int]]) -> None:
    queue: EventQueue[int] = EventQueue()
    for serial, (time, priority) in enumerate(events):
        queue.push(time, serial, priority)
    assert len(queue) == len(events)
    assert queue.next_time() == min((time for time, _ in events), default=None)
    order = [queue.pop() for _ in events]
    assert order == sorted(range(len(events)), key=lambda i: (events[i][0], -events[i][1], i))
    assert queue.next_time() is None
