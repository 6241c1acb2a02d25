"""Modules made with parameters that they do not have, or that cannot be."""

# The calls are wrong on purpose.
# pyright: reportCallIssue=false, reportArgumentType=false

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from actr3d.actr import ACTR, Buffer, DMNoise, ImaginalModule, Memory, Motor, Partial, PMNew, SOSVision, Timer
from actr3d.errors import ParameterError

made: Any = None


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Memory(Buffer(), latancy=0.1), "Memory has no parameter 'latancy'; did you mean 'latency'? It has: buffer, latency"),
        (lambda: Memory(), r"Memory\(buffer, latency, .*missing a required argument: 'buffer'"),
        (lambda: Memory(Buffer(), latency="quick"), r"Memory.latency: must be a number or None \(got 'quick'\)"),
        (lambda: Memory(Buffer(), maximum_time=None), r"Memory.maximum_time: must be a number \(got None\)"),
        (lambda: DMNoise(Memory(Buffer()), noize=1), "DMNoise has no parameter 'noize'; did you mean 'noise'"),
        (lambda: PMNew(alfa=1), "PMNew has no parameter 'alfa'; did you mean 'alpha'"),
        (lambda: PMNew("much"), r"PMNew.alpha: must be a number \(got 'much'\)"),
        (lambda: Partial(Memory(Buffer()), strenght=1), "did you mean 'strength'"),
        (lambda: SOSVision(Buffer(), dealy=1), "did you mean 'delay'"),
        (lambda: ImaginalModule(Buffer(), delay_std=1), "did you mean 'delay_sd'"),
        (lambda: Motor(3), r"Motor\(\): too many positional arguments"),
        (lambda: Timer(startpulse=[]), r"Timer.startpulse: must be a number \(got \[\]\)"),
        (lambda: Buffer("goal"), r"Buffer\(\): too many positional arguments"),
    ],
)
def test_what_is_wrong_is_named(make: Callable[[], Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message.replace("? ", r"\? ")):
        make()


def test_what_is_right_is_taken() -> None:
    memory = Memory(Buffer(), 0.1, None, finst_size=2)
    assert (memory.latency, memory.threshold) == (0.1, None)


def test_agents_take_any_attribute() -> None:
    agent: Any = ACTR(anything=3)
    assert agent.anything == 3
