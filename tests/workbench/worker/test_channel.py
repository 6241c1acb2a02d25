"""The worker's end of its wire: what is sent in which order."""

from __future__ import annotations

import socket

import pytest

from workbench.worker.channel import Channel
from workbench.worker.messages import NewEvents, Notice, Position, Reply, Start, State, framed


def state(tick: int) -> State:
    return State(
        status="paused",
        reason="",
        tick=tick,
        time=0.01 * tick,
        furthest=0.01 * tick,
        wanted=None,
        measured=None,
        events=tick,
        parts=b"{}",
        apertures={},
        result=b"null",
        physics=None,
    )


def rests(_: Channel) -> None:
    """Is what a thread of the link does here."""


@pytest.fixture
def link(monkeypatch: pytest.MonkeyPatch) -> Channel:
    """A link that sends nothing yet, so that all waits in its order."""
    monkeypatch.setattr(Channel, "_read", rests)
    monkeypatch.setattr(Channel, "_write", rests)
    server, worker = socket.socketpair()
    server.sendall(framed(Start(path="model.py", source="", folder=".")))
    with server, worker:
        return Channel(worker)


def test_a_reply_comes_after_the_state_that_shows_what_was_done(link: Channel) -> None:
    link.show(state(1), 0, [b"1"])
    link.show(state(2), 1, [b"2"])
    assert not link.idle
    link.post(Reply(id=7))
    assert list(link._messages) == [NewEvents(first=0, events=[b"1", b"2"]), state(2), Reply(id=7)]
    assert not link.idle
    link.post(Reply(id=8))
    link.show(state(3), 2, [])
    link.post(Notice(level="info", text="said"))  # which a newer state need not wait for
    assert list(link._messages)[2:] == [Reply(id=7), Reply(id=8), Notice(level="info", text="said")]


def test_where_a_run_is_busy_comes_after_what_has_happened_up_to_there(link: Channel) -> None:
    link.show(state(1), 0, [b"1"])
    link.post(Position(file="model.py", line=3))
    assert list(link._messages) == [NewEvents(first=0, events=[b"1"]), state(1), Position(file="model.py", line=3)]
