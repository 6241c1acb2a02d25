"""What a generator may wait for: puts its event where what it yielded says."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Sequence
from numbers import Real
from typing import TYPE_CHECKING, Any, cast

from actr3d.actr.events import Event, Trigger
from actr3d.errors import SchedulerError, did_you_mean
from actr3d.saying import warn_at_frame

if TYPE_CHECKING:
    from actr3d.actr.scheduler import Scheduler


def wait(sch: Scheduler, event: Event, result: Any) -> None:
    """Puts an event where what it yielded says: later, on a trigger, behind another event, or on the first of several.

    Args:
        sch: The scheduler whose event it is.
        event: What waits.
        result: What it yielded.

    Raises:
        SchedulerError: If it cannot be waited for: it is of no such kind, nothing is in it, or its delay is no time.
    """
    if isinstance(result, (int, float)):
        sch.put(event, result, event.priority)
    elif isinstance(result, dict):
        _wait_as(sch, event, cast("dict[str, Any]", result))
    elif isinstance(result, (Trigger, str)):
        trigger = sch.named(result) if isinstance(result, str) else result
        if event.group:
            trigger.add_one_of_several(event)
        else:
            trigger.waiting.append(event)
    elif isinstance(result, (list, tuple)):
        _wait_for_first(sch, event, cast("Sequence[Any]", result))
    elif result is None:
        sch.finish(event)
    elif isinstance(result, Event):
        if result.done:
            sch.put_now(event)
        else:
            result.parents.append(event)
    elif hasattr(result, "default_trigger"):
        wait(sch, event, result.default_trigger)
    elif isinstance(result, Real):  # a number of another kind, such as numpy's
        sch.put(event, float(result), event.priority)
    else:
        raise SchedulerError(
            f"{event.describe()}: cannot wait for {result!r}; yield a number of seconds, a trigger or its name, a method, "
            "the event of a called generator method, or a tuple of these"
        )


def _wait_for_first(sch: Scheduler, event: Event, several: Sequence[Any]) -> None:
    """Puts an event where each of several things says; the first that comes about counts."""
    choices = list(_each(several))
    if any(choice is None for choice in choices):
        warn_of_none(event, "a tuple with None in it, which waits for nothing and ends it for all that wait for its end")
    if not choices:
        raise SchedulerError(f"{event.describe()}: cannot wait for {several!r}; nothing is in it")
    events = [copy.copy(event) for _ in choices]
    for alternative in events:
        alternative.group = events
    for choice, alternative in zip(choices, events, strict=True):
        wait(sch, alternative, choice)


def _wait_as(sch: Scheduler, event: Event, how: dict[str, Any]) -> None:
    """Puts an event where a dict says: after its `delay`, with its `priority` from now on."""
    for word in how:
        if word not in ("delay", "priority"):
            near = did_you_mean(str(word), ("delay", "priority"))
            raise SchedulerError(f"{event.describe()}: cannot wait for {how!r}: no '{word}'{near or '; use delay and priority'}")
    priority = how.get("priority", event.priority)
    if not isinstance(priority, (int, float)):
        raise SchedulerError(f"{event.describe()}: a priority must be a number (got {priority!r})")
    event.priority = priority
    sch.put(event, how.get("delay", 0), priority)


def warn_of_none(event: Event, what: str = "None, which ends it here") -> None:
    """Warns, at the line that did so, of a generator that yielded None.

    Args:
        event: The generator's.
        what: What it yielded, and what follows from it.
    """
    generator = event.innermost
    frame = generator.gi_frame if generator is not None else None
    if frame is not None:
        warn_at_frame(
            f"{frame.f_code.co_qualname} yields {what}: what it calls may not be a generator, or a number of seconds is missing",
            frame,
        )


def _each(choices: Sequence[Any]) -> Iterator[Any]:
    """Yields what is to be waited for, also from sequences inside."""
    for choice in choices:
        if isinstance(choice, (list, tuple)):
            yield from _each(cast("Sequence[Any]", choice))
        else:
            yield choice
