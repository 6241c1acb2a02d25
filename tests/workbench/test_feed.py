"""What browsers are shown: in order, without gaps or with the gap told, whatever their speed."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from typing import Any

import pytest

from workbench import event_log
from workbench.client_feed import Broadcast, Feed
from workbench.event_log import LatestEvents


class Shown(Broadcast):
    """A session as a feed sees it."""

    def __init__(self) -> None:
        super().__init__("s1")
        self.run = self.epoch = self.state_version = self.facts_version = 1

    def state_json(self) -> bytes:
        return json.dumps({"version": self.state_version}).encode()

    def facts_json(self) -> bytes:
        return b'{"id": "s1"}'

    def add(self, *events: int) -> None:
        self.log.add(self.log.next, numbered(*events))


def numbered(*events: int) -> list[bytes]:
    return [str(event).encode() for event in events]


def told(feed: Feed, *work: Callable[[], object]) -> Any:
    """Returns the next message, after some work; None where there is none."""

    async def ask() -> Any:
        for one in work:
            one()
        try:
            return json.loads(await asyncio.wait_for(feed.next(), 0.05))
        except TimeoutError:
            return None

    return asyncio.run(ask())


def test_the_log_keeps_events_by_number() -> None:
    log = LatestEvents()
    log.add(0, numbered(0, 1, 2))
    log.add(1, numbered(1, 2, 3))
    assert log.since(0) == (0, numbered(0, 1, 2, 3))
    assert log.since(2, 1) == (2, numbered(2))
    assert log.since(9) == (9, [])
    log.cut(2)
    assert (log.next, log.since(0)) == (2, (0, numbered(0, 1)))
    log.add(7, numbered(7, 8))
    assert log.since(0) == (7, numbered(7, 8))
    log.cut(3)
    assert log.next == 3
    log.cut(9)
    assert log.next == 3
    log.add(3, numbered(3, 4, 5))
    log.drop(5)
    assert (len(log), log.since(0)) == (1, (5, numbered(5)))


def test_the_log_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(event_log, "MAX_EVENTS", 10)
    log = LatestEvents()
    for number in range(25):
        log.add(number, numbered(number))
    assert log.since(0) == (15, numbered(*range(15, 25)))


def test_a_feed_begins_with_everything_and_goes_on_with_what_is_new() -> None:
    shown = Shown()
    shown.add(0, 1)
    shown.notices.append((0, b'"hello"'))
    feed = Feed(shown, "page 1")
    first = told(feed)
    assert first["session"] == {"id": "s1"}
    assert first["state"] == {"version": 1}
    assert first["events"] == {"first": 0, "list": [0, 1], "cut": 0}
    assert first["notices"] == ["hello"]
    assert told(feed) is None
    shown.add(2)
    assert told(feed, feed.wake) == {"type": "update", "of": "s1", "run": 1, "epoch": 1, "events": {"first": 2, "list": [2]}}
    shown.state_version = 9
    assert told(feed, feed.wake) == {"type": "update", "of": "s1", "run": 1, "epoch": 1, "state": {"version": 9}}


def test_a_client_that_reconnects_gets_only_new_events() -> None:
    shown = Shown()
    shown.add(*range(5))
    feed = Feed(shown, "page 1")
    feed.resume(1, 1, 3)
    assert told(feed)["events"] == {"first": 3, "list": [3, 4]}


@pytest.mark.parametrize("known", [(1, 0, 3), (2, 1, 3), (1, 1, 9)])
def test_a_client_that_reconnects_with_another_state_gets_everything(known: tuple[int, int, int]) -> None:
    shown = Shown()
    shown.add(*range(5))
    feed = Feed(shown, "page 1")
    feed.resume(*known)
    assert told(feed)["events"] == {"first": 0, "list": [0, 1, 2, 3, 4], "cut": 0}


def test_a_run_that_goes_another_way_takes_events_back() -> None:
    shown = Shown()
    shown.add(*range(5))
    feed = Feed(shown, "page 1")
    told(feed)
    shown.epoch = 2
    shown.log.cut(2)
    feed.cut(2)
    shown.add(20, 30)
    message = told(feed, feed.wake)
    assert message["epoch"] == 2
    assert message["events"] == {"first": 2, "list": [20, 30], "cut": 2}


def test_a_slow_browser_learns_of_its_gap(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(event_log, "MAX_EVENTS", 4)
    shown = Shown()
    shown.add(0)
    feed = Feed(shown, "page 1")
    told(feed)
    for number in range(1, 10):
        shown.add(number)
    assert told(feed, feed.wake)["events"] == {"first": 6, "list": [6, 7, 8, 9], "missing": 5}


def test_a_browser_that_comes_when_no_event_is_kept_learns_where_they_go_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(event_log, "MAX_EVENTS", 4)
    shown = Shown()
    for number in range(10):
        shown.add(number)
    shown.log.cut(3)  # before the first that is kept
    feed = Feed(shown, "page 1")
    assert told(feed)["events"] == {"first": 3, "list": [], "cut": 0, "missing": 3}
    assert told(feed) is None
    shown.add(30)
    assert told(feed, feed.wake)["events"] == {"first": 3, "list": [30]}


def test_much_that_is_new_comes_in_parts_of_bounded_size() -> None:
    shown = Shown()
    shown.add(*range(5000))
    feed = Feed(shown, "page 1")
    got = [number for _ in range(3) for number in told(feed)["events"]["list"]]
    assert got == list(range(5000))
    assert told(feed) is None


def test_a_new_run_begins_with_its_own_events() -> None:
    shown = Shown()
    shown.add(*range(5))
    feed = Feed(shown, "page 1")
    told(feed)
    shown.run, shown.epoch, shown.log = 2, 2, LatestEvents()
    shown.add(100)
    message = told(feed, feed.wake)
    assert (message["run"], message["events"]) == (2, {"first": 0, "list": [100], "cut": 0})


def test_replies_go_to_the_client_that_asked() -> None:
    shown = Shown()
    one, other = Feed(shown, "page 1"), Feed(shown, "page 2")
    told(one)
    told(other)
    assert told(one, lambda: one.reply(b'{"id": 7}'))["replies"] == [{"id": 7}]
    assert told(other) is None
