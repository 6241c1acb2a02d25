"""Time in whole microseconds, and the order of simultaneous events."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from actr3d.clock import Ends, EventQueue, microseconds, seconds
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
    with pytest.raises(SchedulerError, match=r"Timer\.delay: must be a finite number of seconds \(got "):
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
    order = [queue.pop() for _ in events]
    assert order == sorted(range(len(events)), key=lambda i: (events[i][0], -events[i][1], i))
    assert not queue.heap


@given(st.lists(st.tuples(st.sampled_from([0.05, 0.1, 0.15, 0.3, 1.0]), st.integers(-2, 2)), min_size=1, max_size=30))
def test_in_the_old_order_sums_of_delays_come_before_priorities(delays: list[tuple[float, int]]) -> None:
    queue: EventQueue[tuple[float, int]] = EventQueue(first_come=False)
    expected: list[tuple[float, int]] = []
    now, time = 0.0, 0
    for delay, priority in delays:
        for part in (delay / 2, delay):
            queue.push(time + microseconds(part), (now + part, -priority), priority, part)
            expected.append((now + part, -priority))
        now, time = now + delay, time + microseconds(delay)
        queue.sum = now
    assert [queue.pop() for _ in expected] == sorted(expected)
    assert queue.sum == max(expected)[0]


def test_a_sum_that_is_far_from_its_time_counts_no_more() -> None:
    queue: EventQueue[int] = EventQueue(first_come=False)
    queue.push(1_000, 1, 0, 0.0012)  # its time has been made a whole millisecond
    queue.push(1_000, 2, 1, 0.0011)
    assert queue.take() == (1_000, 1, 2)
    queue.pop()
    assert queue.sum == 0.001


@given(
    st.lists(st.one_of(st.fractions(0, 2), st.floats(0, 2), st.sampled_from([1 / 30, 1 / 3, 0.01, 0.07])), max_size=60), st.integers(1, 40)
)
def test_runs_that_follow_one_another_do_not_drift(durations: list[Any], times: int) -> None:
    ends, now, exact = Ends(), 0, Fraction(0)
    for duration in durations * times:
        now = ends.after(now, duration)
        exact += Fraction(duration) * 1_000_000
        assert abs(now - exact) <= 0.51


def test_whole_microseconds_stay_whole_for_ever() -> None:
    ends, now = Ends(), 0
    for count in range(1, 100_001):
        now = ends.after(now, 0.07)
        assert now == 70_000 * count


def test_what_is_left_over_counts_only_where_that_run_has_ended() -> None:
    ends = Ends()
    assert ends.after(0, 1 / 3) == 333_333
    assert ends.after(333_333, 1 / 3) == 666_667
    assert ends.after(700_000, 1 / 3) == 1_033_333  # something else has moved the clock: this run is as long as it says
    assert ends.after(1_033_333, 1 / 6) == 1_200_000


def test_a_negative_duration_is_refused() -> None:
    with pytest.raises(SchedulerError, match=r"the limit of a run: must be >= 0 \(got -1 s\)"):
        Ends().after(5_000_000, -1)
