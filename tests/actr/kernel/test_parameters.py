"""Modules created with unknown or invalid parameters."""

# The calls are wrong on purpose.
# pyright: reportCallIssue=false, reportArgumentType=false

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan
from typing import Any

import numpy as np
import pytest

from actr3d.actr import (
    ACTR,
    BlendingMemory,
    Buffer,
    DMBaseLevel,
    DMNoise,
    DMSpreading,
    ImaginalModule,
    Memory,
    Motor,
    Partial,
    PMCompile,
    PMNew,
    SOSVision,
    Timer,
)
from actr3d.errors import ParameterError
from actr3d.motor import Motor as BodyMotor

made: Any = None


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Memory(Buffer(), latancy=0.1), "Memory has no parameter 'latancy'; did you mean 'latency'? It has: buffer, latency"),
        (lambda: Memory(), r"Memory\(buffer, latency, .*missing a required argument: 'buffer'"),
        (lambda: Memory(Buffer(), latency="quick"), r"Memory.latency: must be a number \(got 'quick'\)"),
        (lambda: Memory(Buffer(), latency=-1), r"Memory.latency: must be >= 0 \(got -1"),
        (lambda: Memory(Buffer(), latency=nan), r"Memory.latency: must be a finite number \(got nan\)"),
        (lambda: Memory(Buffer(), latency=inf), r"Memory.latency: must be a finite number \(got inf\)"),
        (lambda: Memory(Buffer(), threshold=nan), r"Memory.threshold: must be a finite number \(got nan\)"),
        (lambda: Memory(Buffer(), maximum_time=-inf), r"Memory.maximum_time: must be >= 0 \(got -inf\)"),
        (lambda: Memory(Buffer(), finst_size=-1), r"Memory.finst_size: must be >= 0 \(got -1\)"),
        (lambda: Memory(Buffer(), finst_size=1.5), r"Memory.finst_size: must be a whole number \(got 1.5\)"),
        (lambda: Memory("ret"), r"Memory.buffer: must be a Buffer \(got 'ret'\)"),
        (lambda: Memory(None), r"Memory.buffer: must be a Buffer \(got None\)"),
        (lambda: DMNoise(Memory(Buffer()), noise=-1), r"DMNoise.noise: must be >= 0 \(got -1"),
        (lambda: DMNoise("memory"), r"DMNoise.memory: must be a Memory \(got 'memory'\)"),
        (lambda: Partial("memory"), r"Partial.memory: must be a Memory \(got 'memory'\)"),
        (lambda: DMBaseLevel(Memory(Buffer()), decay=-1), r"DMBaseLevel.decay: must be >= 0 \(got -1"),
        (lambda: DMBaseLevel(Memory(Buffer()), limit=-1), r"DMBaseLevel.limit: must be >= 0 \(got -1\)"),
        (lambda: DMBaseLevel(Memory(Buffer()), limit=2.5), r"DMBaseLevel.limit: must be a whole number \(got 2.5\)"),
        (lambda: DMSpreading(Memory(Buffer()), Buffer(), "goal"), r"DMSpreading.buffers: must be a Buffer \(got 'goal'\)"),
        (lambda: PMNew(alpha=inf), r"PMNew.alpha: must be a finite number \(got inf\)"),
        (lambda: PMCompile(keep=3, request="mem.request", retrieve="ret"), r"PMCompile.keep: must be text \(got 3\)"),
        (lambda: ImaginalModule(Buffer(), delay=-3), r"ImaginalModule.delay: must be >= 0 \(got -3"),
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
def test_wrong_parameters_are_named(make: Callable[[], Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message.replace("? ", r"\? ")):
        make()


def test_valid_parameters_are_accepted() -> None:
    memory = Memory(Buffer(), 0.1, None, finst_size=2)
    assert (memory.latency, memory.threshold) == (0.1, None)
    memory = Memory(Buffer(), np.float32(0.5), -inf, maximum_time=inf, finst_size=np.int64(0), finst_time=0)
    assert (memory.latency, memory.threshold, memory.maximum_time) == (0.5, -inf, inf)
    for one in (DMBaseLevel(memory, None, np.int64(3)), DMBaseLevel(memory, 0), Partial(memory, None, limit=-inf), DMSpreading(memory)):
        assert one
    assert ImaginalModule(Buffer(), delay=lambda: 0.1).delay_time() == 0.1


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("production_time", "x", r"must be a number \(got 'x'\)"),
        ("production_time", -1, r"must be >= 0 \(got -1"),
        ("production_time_sd", -1, r"must be >= 0 \(got -1"),
        ("production_match_delay", None, r"must be a number \(got None\)"),
        ("production_threshold", nan, r"must be a finite number \(got nan\)"),
    ],
)
def test_a_class_sets_what_its_agents_can_have(name: str, value: object, message: str) -> None:
    agent = type("Agent", (ACTR,), {name: value})
    with pytest.raises(ParameterError, match=f"Agent.{name}: {message}"):
        agent().run(0.1)


def test_agents_take_functions_and_infinite_thresholds() -> None:
    members = {"production_time": lambda: 0.1, "production_threshold": -inf, "production_time_sd": None, "style": "x"}
    type("Agent", (ACTR,), members)().run(0.1)


def test_agents_take_any_attribute() -> None:
    agent: Any = ACTR(anything=3)
    assert agent.anything == 3


@pytest.mark.parametrize(
    ("module", "name", "value", "message"),
    [
        (lambda: Memory(Buffer()), "latency", "0.05", r"Memory.latency: must be a number \(got '0.05'\)"),
        (lambda: BlendingMemory(Buffer()), "latency", None, r"BlendingMemory.latency: must be a number \(got None\)"),
        (lambda: BlendingMemory(Buffer()), "temperature", 0, r"BlendingMemory.temperature: must be > 0 \(got 0\.0\)"),
        (lambda: BodyMotor(), "patience", -1, r"Motor.patience: must be > 0 \(got -1"),
        (lambda: Timer(), "a", 0, r"Timer.a: must be > 0 \(got 0"),
        (lambda: DMBaseLevel(Memory(Buffer())), "limit", 2.5, r"DMBaseLevel.limit: must be a whole number \(got 2.5\)"),
        (lambda: Partial(Memory(Buffer())), "strength", "1", r"Partial.strength: must be a number \(got '1'\)"),
        (lambda: ACTR(), "production_time", -1, r"ACTR.production_time: must be >= 0 \(got -1"),
        (lambda: type("Agent", (ACTR,), {})(), "production_time", "x", r"Agent.production_time: must be a number \(got 'x'\)"),
    ],
)
def test_a_parameter_cannot_be_set_to_a_wrong_value(module: Callable[[], Any], name: str, value: object, message: str) -> None:
    part = module()
    before = getattr(part, name, "none")
    with pytest.raises(ParameterError, match=f"^{message}"):
        setattr(part, name, value)
    assert getattr(part, name, "none") == before


def test_a_class_of_a_modeller_may_use_the_names_of_parameters_for_something_else() -> None:
    class Clock(Timer):
        def __init__(self, a: Any) -> None:
            super().__init__()
            self.a = a
            self.startpulse = "none"

    assert Clock("x").a == "x"


def test_a_timer_whose_pulses_get_shorter_and_shorter_lets_time_pass() -> None:
    agent: Any = ACTR()
    agent.timer = Timer(startpulse=1e-9, a=1e-9)
    agent.run(0.01)
    assert agent.now() == 0.01
    assert agent.timer.t == 1e-6
