"""Utilities, their learning and compilation, compared live with python_actr."""

from __future__ import annotations

import collections
import collections.abc
from collections.abc import Callable
from typing import Any

import pytest

from tests.helpers.python_actr_reference import LIBRARIES, model_file, recording_buffer
from tests.helpers.small_agents import near

Modules = Callable[[Any], dict[str, Any]]

UTILITIES: dict[str, Modules] = {
    "nothing": lambda library: {},
    "PMNoise": lambda library: {"pm": library.PMNoise(noise=0.4, baseNoise=0.1)},
    "PMNew": lambda library: {"pm": library.PMNew(alpha=0.3)},
    "PMTD": lambda library: {"pm": library.PMTD(alpha=0.2, discount=0.7, cost=0.1)},
    "PMPGC": lambda library: {"pm": library.PMPGC(goal=12)},
    "PMPGCSuccessWeighted": lambda library: {"pm": library.PMPGCSuccessWeighted()},
    "PMPGCMixedWeighted": lambda library: {"pm": library.PMPGCMixedWeighted(goal=5)},
}
ATTRIBUTES = ("base_utility", "util", "td_u", "successes", "failures", "time", "baseNoise")


@pytest.fixture(autouse=True)
def old_names(monkeypatch: pytest.MonkeyPatch) -> None:
    """python_actr's PMPGC uses a name that Python 3.10 removed."""
    monkeypatch.setattr(collections, "Callable", collections.abc.Callable, raising=False)


def states(agent: Any) -> list[dict[str, float]]:
    return [{name: getattr(p, name) for name in ATTRIBUTES if hasattr(p, name)} for p in agent._productions]


def choose(library: Any, modules: dict[str, Any], seed: int, threshold: float | None) -> tuple[list[Any], list[dict[str, float]], float]:
    agent = model_file("choosing").make(library, threshold, **modules)()
    agent._ensure_converted()
    agent.random.seed(seed)
    for adaptor in agent._adaptors:  # base noise comes from the seed too
        for production in agent._productions:
            adaptor.create(production)
    agent.run(limit=30)
    return agent.record, states(agent), agent.random.random()


def compare(mine: Any, theirs: Any) -> None:
    record, productions, after = mine
    peer_record, peer_productions, peer_after = theirs
    assert [name for name, _ in record] == [name for name, _ in peer_record]
    assert [time for _, time in record] == near([time for _, time in peer_record], abs=1e-6)
    assert len(productions) == len(peer_productions)
    for production, peer_production in zip(productions, peer_productions, strict=True):
        assert production == near(peer_production, rel=1e-9, abs=1e-9)
    assert after == peer_after


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("noisy", [False, True], ids=["exact", "noisy"])
@pytest.mark.parametrize("name", UTILITIES)
def test_learning(name: str, noisy: bool, seed: int) -> None:
    results: list[Any] = []
    for library in LIBRARIES:
        modules = UTILITIES[name](library)
        if noisy:
            modules["noise"] = library.PMNoise(noise=1.0)
        results.append(choose(library, modules, seed, None))
    assert len(results[0][0]) >= 40
    compare(*results)


@pytest.mark.parametrize("threshold", [-0.5, 0.25, 0.6])
def test_a_threshold(threshold: float) -> None:
    results = [choose(library, {"pm": library.PMNew(), "noise": library.PMNoise(noise=0.3)}, 11, threshold) for library in LIBRARIES]
    compare(*results)


@pytest.mark.parametrize("seed", range(8))
def test_compilation(seed: int) -> None:
    results: list[Any] = []
    compiled: list[int] = []
    for library in LIBRARIES:
        events: list[tuple[float, dict[Any, Any] | None]] = []
        goal = recording_buffer(library, events)
        agent = model_file("recalling").make(library, goal, noise=library.PMNoise(noise=1.5))()
        agent._ensure_converted()
        agent.random.seed(seed)
        agent.run(limit=30)
        record = [(repr(sorted((chunk or {}).items())), time) for time, chunk in events]
        compiled.append(len(agent.compiling.compiled))
        learned = [{k: v for k, v in state.items() if k != "baseNoise"} for state in states(agent)]
        results.append((record, learned, agent.random.random()))
    assert compiled[0] == compiled[1] >= 2
    compare(*results)
