"""Declarative memory, compared live with python_actr: the same chunks, requests and seed on both."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import pytest

from tests.helpers.python_actr_reference import LIBRARIES, recording_buffer, seeded_agent, text_of
from tests.helpers.small_agents import near

Maker = Callable[[Any, Any, Any], Any]


def spreading(library: Any, memory: Any, focus: Any) -> Any:
    module = library.DMSpreading(memory, focus)
    module.strength = 1.7
    module.weight[focus] = 0.6
    return module


def associate(limit: int | None) -> Maker:
    return lambda library, memory, focus: library.DMAssociate(memory, focus, weight=0.3, limit=limit)


MODULES: dict[str, Maker] = {
    "noise": lambda library, memory, focus: library.DMNoise(memory, noise=0.4, baseNoise=0.2),
    "base": lambda library, memory, focus: library.DMBaseLevel(memory),
    "hybrid": lambda library, memory, focus: library.DMBaseLevel(memory, decay=0.4, limit=2),
    "optimized": lambda library, memory, focus: library.DMBaseLevel(memory, limit=0),
    "spreading": spreading,
    "fixed": lambda library, memory, focus: library.DMFixed(memory, default=0.1),
    "inhibition": lambda library, memory, focus: library.DMInhibition(memory, decayScale=0.9, timeScale=3.0),
    "associate": associate(None),
    "salience": lambda library, memory, focus: library.DMSalience(memory),
}
COMBINED = [
    ("noise", "base"),
    ("base", "spreading", "noise"),
    ("hybrid", "fixed", "associate"),
    ("base", "noise", "spreading", "fixed", "inhibition", "associate"),
]


def build(library: Any, seed: int, modules: tuple[str, ...], options: dict[str, Any], events: list[Any]) -> Any:
    kind = options.get("kind", "Memory")
    focus = library.Buffer()
    buffer = recording_buffer(library, events)
    memory = getattr(library, kind)(buffer, **options.get("memory", {}))
    parts: dict[str, Any] = {"focus": focus, "buffer": buffer, "memory": memory}
    for name in modules:
        parts[f"m_{name}"] = MODULES[name](library, memory, focus)
    if options.get("partial"):
        parts["partial"] = library.Partial(memory, strength=0.8, limit=-0.7)
        parts["partial"].similarity("p", "q", -0.2)
        parts["partial"].similarity("q", "r", -0.4)
    return seeded_agent(library, seed, **parts)


def play(library: Any, seed: int, modules: tuple[str, ...], options: dict[str, Any]) -> tuple[list[Any], list[Any], float]:
    """Performs a random scenario; returns what arrived when, all activations, and the next random number."""
    script = random.Random(seed)
    events: list[Any] = []
    agent = build(library, seed, modules, options, events)
    words = ["p", "q", "r"]
    length = script.choice([1, 2, 3])
    activations: list[Any] = []
    if "salience" in modules:  # every value must be among the context's
        for first in words:
            for second in words:
                agent.memory.add(f"a:{first} b:{second} c:{first}")
        agent.m_salience.weights(a=1, b=0.5)
        agent.m_salience.context("a:?x")
        length = 3
    for _ in range(30):
        what = script.choice(["add", "add", "add", "request", "request", "focus", "wait"])
        keys: dict[str, Any] = {}
        if what == "add":
            if script.random() < 0.3:
                keys["time"] = script.choice([0.5, 3.0, 20.0])
            if script.random() < 0.1 and "inhibition" not in modules:
                keys["baselevel"] = 0.7
            if script.random() < 0.2:
                keys["fixed"] = 0.3
            if "inhibition" in modules:
                keys.pop("time", None)
            agent.memory.add(text_of(script, "pqr", length), **keys)
            if options.get("numbers"):
                agent.memory.add(f"{text_of(script, 'pqr', length)} n:{script.choice([1, 2.5, 4])}")
        elif what == "focus":
            agent.focus.set(text_of(script, "pqr", script.choice([1, 2])))
        elif what == "wait":
            agent.run(limit=script.choice([0.3, 1.1, 5.0]))
        else:
            pattern = " ".join(f"{slot}:{script.choice(['p', 'q', '!r', '?', '?x'])}" for slot in "abc"[: script.choice([1, length])])
            for chunk in agent.memory.dm:
                chunk.activation = None
            agent.run(limit=0.25)
            agent.memory.request(pattern, require_new=script.random() < 0.3)
            activations.append([(repr(chunk), chunk.activation) for chunk in agent.memory.dm if chunk.activation is not None])
            agent.run(limit=11)
            events.append((agent.memory.error, agent.memory.busy, repr(agent.buffer.chunk) if not options.get("numbers") else ""))
    return events, activations, agent.random.random()


def check(seed: int, modules: tuple[str, ...], options: dict[str, Any]) -> None:
    (events, activations, after), (peer_events, peer_activations, peer_after) = (play(lib, seed, modules, options) for lib in LIBRARIES)
    assert after == peer_after
    assert len(activations) == len(peer_activations)
    for mine, theirs in zip(activations, peer_activations, strict=True):
        assert [text for text, _ in mine] == [text for text, _ in theirs]
        assert [a for _, a in mine] == near([a for _, a in theirs], rel=1e-12, abs=1e-12)
    assert len(events) == len(peer_events)
    for mine, theirs in zip(events, peer_events, strict=True):
        if len(mine) == 3:
            assert mine == theirs
            continue
        assert mine[0] == near(theirs[0], abs=1e-6)
        if mine[1] is None or theirs[1] is None:
            assert mine[1] is theirs[1]
        else:
            assert list(mine[1]) == list(theirs[1])
            for value, other in zip(mine[1].values(), theirs[1].values(), strict=True):
                assert value == (near(other, rel=1e-12) if isinstance(other, float) else other)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("modules", [(name,) for name in MODULES] + COMBINED, ids="+".join)
def test_modules(modules: tuple[str, ...], seed: int) -> None:
    check(seed, modules, {})


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    "memory",
    [
        {"latency": 0.63, "threshold": -0.5},
        {"latency": 3.0, "threshold": 0.4, "maximum_time": 1.5},
        {"finst_size": 1, "finst_time": 12.0},
        {"finst_size": 0},
    ],
    ids=str,
)
def test_parameters_of_the_memory(memory: dict[str, Any], seed: int) -> None:
    check(seed, ("base", "noise"), {"memory": memory})


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("modules", [(), ("base", "noise")], ids=["plain", "base+noise"])
def test_partial_matching(modules: tuple[str, ...], seed: int) -> None:
    check(seed, modules, {"partial": True, "memory": {"threshold": -1.0}})


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("partial", [False, True], ids=["whole", "partial"])
@pytest.mark.parametrize("modules", [("base",), ("base", "noise", "spreading")], ids="+".join)
def test_blending(modules: tuple[str, ...], partial: bool, seed: int) -> None:
    check(seed, modules, {"kind": "BlendingMemory", "numbers": True, "partial": partial, "memory": {"threshold": -2.0}})
