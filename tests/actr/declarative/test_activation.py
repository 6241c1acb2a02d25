"""Base level, noise, fixed amounts, salience and spreading, against numbers computed here by other means."""

from __future__ import annotations

import math
import statistics
from decimal import Decimal, getcontext
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from actr3d.actr import Buffer, Chunk, DMBaseLevel, DMFixed, DMNoise, Memory, MemorySubModule
from actr3d.errors import ChunkError, ParameterError
from tests.helpers.small_agents import near, started_agent

getcontext().prec = 40
PROFILES = ["python-actr", "act-r-7"]
PUBLISHED = {None: -0.18235, 0: 0.0, 1: -0.07902}


def base_level(times: list[float], read: float, profile: str = "python-actr", **options: Any) -> float:
    memory = Memory(Buffer())
    agent = started_agent(profile, memory=memory, base=DMBaseLevel(memory, **options))
    for time in times:
        agent.run(time - agent.now())
        agent.memory.add("a")
    agent.run(read - agent.now())
    return agent.memory.get_activation("a")


def exact(ages: list[float], d: float, youngest: float) -> float:
    total = Decimal(0)
    for age in ages:
        total += max(Decimal(repr(age)), Decimal(repr(youngest))) ** -Decimal(repr(d))
    return float(total.ln(None))


def spread_evenly(count: int, oldest: float, latest: float, d: float) -> float:
    """The integral of t^-d from one age to the other over their distance, by Simpson's rule in u = t^(1 - d)."""
    n = 2000
    low, high = Decimal(repr(latest)), Decimal(repr(oldest))
    power = Decimal(1) - Decimal(repr(d))
    start, end = (low**power if low else Decimal(0)), high**power
    step = (end - start) / n
    area = sum((1 if i in (0, n) else 4 if i % 2 else 2) * (1 / power) for i in range(n + 1)) * step / 3
    return float(count * area / (high - low))


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("limit", PUBLISHED)
def test_published_base_levels(profile: str, limit: int | None) -> None:
    assert base_level([0, 10, 40, 70, 90], 100, profile, limit=limit) == near(PUBLISHED[limit], abs=5e-6)


@pytest.mark.parametrize(("profile", "expected"), [("python-actr", None), ("act-r-7", 0)])
def test_each_profile_has_its_own_form(profile: str, expected: int | None) -> None:
    times = [0, 10, 40, 70, 90.0]
    assert base_level(times, 100, profile) == base_level(times, 100, profile, limit=expected)


@settings(max_examples=60, deadline=None)
@given(
    times=st.lists(st.integers(0, 90_000_000), min_size=1, max_size=8),
    d=st.sampled_from([0.1, 0.5, 0.77, 1.0, 1.5]),
    profile=st.sampled_from(PROFILES),
)
def test_the_exact_form(times: list[int], d: float, profile: str) -> None:
    moments = sorted(time / 1_000_000 for time in times)
    read = 90.5
    youngest = 0.005 if profile == "python-actr" else 0.05
    expected = exact([read - t for t in moments], d, youngest)
    assert base_level(moments, read, profile, decay=d, limit=None) == near(expected, rel=1e-9, abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(times=st.lists(st.integers(0, 90_000), min_size=1, max_size=8, unique=True), k=st.integers(1, 8), profile=st.sampled_from(PROFILES))
def test_the_hybrid_form(times: list[int], k: int, profile: str) -> None:
    moments = sorted(time / 1000 for time in times)
    ages = [100 - t for t in moments]
    kept, lost = ages[-k:], ages[:-k]
    total = math.exp(exact(kept, 0.5, 0.005))
    if lost:
        total += spread_evenly(len(lost), ages[0], kept[0], 0.5)
    assert base_level(moments, 100, profile, limit=k) == near(math.log(total), rel=1e-9, abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(times=st.lists(st.integers(0, 90_000), min_size=2, max_size=6, unique=True), profile=st.sampled_from(PROFILES))
def test_the_hybrid_form_lies_between_exact_and_optimized(times: list[int], profile: str) -> None:
    moments = sorted(time / 1000 for time in times)
    n = len(moments)
    all_kept = base_level(moments, 100, profile, limit=n)
    assert all_kept == base_level(moments, 100, profile, limit=None)
    life = 100 - moments[0]
    assert base_level(moments, 100, profile, limit=0) == near(math.log(n / 0.5) - 0.5 * math.log(life), abs=1e-9)


def test_youngest_age() -> None:
    assert base_level([0.0], 0.0) == near(-0.5 * math.log(0.005))
    assert base_level([0.0], 0.02) == near(-0.5 * math.log(0.02))
    assert base_level([0.0], 0.02, "act-r-7", limit=None) == near(-0.5 * math.log(0.05))
    assert base_level([0.0], 0.02, "act-r-7") == near(math.log(2) - 0.5 * math.log(0.05))


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("decay", [0.0, 0.5, 1, 1.0, 2.0, None])
@pytest.mark.parametrize("limit", [None, 0, 1, 3])
@pytest.mark.parametrize("times", [[0.0, 0.0, 0.0, 0.0, 0.0], [3.0] * 3, [0.0, 3.0, 3.0, 3.0]], ids=str)
def test_the_base_level_is_always_a_finite_number(profile: str, decay: float | None, limit: int | None, times: list[float]) -> None:
    for read in (3.0, 3.001, 4.0):
        value = base_level(times, read, profile, decay=decay, limit=limit)
        assert math.isfinite(value)
        assert value <= math.log(len(times) * 2 * 0.001 ** -(decay or 0)) + 1e-9


def test_simultaneous_references_each_count() -> None:
    assert base_level([2.0] * 5, 6.0, limit=2) == near(math.log(5 * 4**-0.5))


def test_references_of_the_past() -> None:
    for profile, limit, expected in [
        ("python-actr", None, math.log(110**-0.5 + 60**-0.5)),
        ("act-r-7", None, math.log(110**-0.5 + 60**-0.5)),
        ("act-r-7", 0, math.log(2 / 0.5) - 0.5 * math.log(110)),
        ("python-actr", 0, math.log(2 / 0.5) - 0.5 * math.log(10)),  # the chunk exists from when it is added
        ("python-actr", 1, math.log(60**-0.5 + 2 * (10**0.5 - 60**0.5) / (10 - 60))),
    ]:
        memory = Memory(Buffer())
        agent = started_agent(profile, memory=memory, base=DMBaseLevel(memory, limit=limit))
        agent.memory.add("a", time=100)
        agent.memory.add("a", time=50)
        agent.run(10)
        assert agent.memory.get_activation("a") == near(expected, abs=1e-9)


def test_a_given_base_level_stays_until_it_is_to_be_calculated() -> None:
    memory = Memory(Buffer())
    agent = started_agent(memory=memory, base=DMBaseLevel(memory))
    agent.memory.add("a", baselevel=2.5)
    agent.run(4)
    assert agent.memory.get_activation("a") == 2.5
    agent.memory.add("a", baselevel="calculate")
    assert agent.memory.get_activation("a") == near(math.log(4**-0.5 + 0.005**-0.5))
    agent.memory.add("b", baselevel="calculate")
    agent.memory.add("b", baselevel="calculate")
    assert agent.memory.get_activation("b") == near(math.log(2 * 0.005**-0.5))


def test_a_chunk_that_is_unknown_to_the_module() -> None:
    memory = Memory(Buffer())
    agent = started_agent(memory=memory, base=DMBaseLevel(memory))
    agent.memory.dm.append(Chunk("a"))
    with pytest.raises(ChunkError, match="DMBaseLevel has no data about chunk 'a': add it"):
        agent.memory.get_activation("a")


def test_noise_has_the_logistic_distributions_moments() -> None:
    memory = Memory(Buffer())
    agent = started_agent(memory=memory, noise=DMNoise(memory, noise=0.4), seed=5)
    agent.memory.add("a")
    n = 20_000
    drawn = [agent.memory.get_activation("a") for _ in range(n)]
    variance = math.pi**2 * 0.4**2 / 3
    assert abs(statistics.fmean(drawn)) < 4 * math.sqrt(variance / n)
    # The fourth central moment is 21/5 of the variance squared.
    assert abs(statistics.variance(drawn) - variance) < 4 * variance * math.sqrt(3.2 / n)
    for share in (0.1, 0.5, 0.9):
        below = sum(x < 0.4 * math.log(share / (1 - share)) for x in drawn)
        assert abs(below - n * share) < 4 * math.sqrt(n * share * (1 - share))


def test_base_noise_is_drawn_once_for_each_chunk_and_each_agent() -> None:
    def build(seed: int) -> list[float]:
        memory = Memory(Buffer())
        noise = DMNoise(memory, noise=0, baseNoise=1.0)
        memory.add("a")  # as in a class's body: there is no model yet
        agent = started_agent(memory=memory, noise=noise, seed=seed)
        agent.memory.add("b")
        values = [agent.memory.get_activation(text) for text in "abab"]
        assert values[:2] == values[2:]
        assert values[0] != values[1]
        assert agent.memory.sch is agent.sch
        return values

    assert build(1) == build(1)
    assert build(1) != build(2)


def test_fixed_amounts_add_up() -> None:
    memory = Memory(Buffer())
    agent = started_agent(memory=memory, fixed=DMFixed(memory, default=0.25))
    agent.memory.add("a")
    agent.memory.add("b", fixed=2)
    agent.memory.add("b", fixed=0.5)
    agent.memory.add("b")
    agent.memory.add("c", fixed=None)
    assert [agent.memory.get_activation(text) for text in "abc"] == [0.25, 2.5, 0.25]


def test_modules_add_up_in_order_and_may_be_user_defined() -> None:
    class Own(MemorySubModule):
        def __init__(self, memory: Memory) -> None:
            MemorySubModule.__init__(self, memory)
            self.seen: list[Any] = []

        def create(self, chunk: Any, worth: float = 0.0, **keys: Any) -> None:
            chunk.worth = worth

        def merge(self, chunk: Any, worth: float = 0.0, **keys: Any) -> None:
            chunk.worth = max(chunk.worth, worth)

        def matched(self, chunks: list[Any]) -> None:
            self.seen.append(("matched", [str(chunk) for chunk in chunks]))

        def recalled(self, chunk: Any) -> None:
            self.seen.append(("recalled", str(chunk), self.now()))

        def activation(self, chunk: Any) -> float:
            return chunk.worth

    memory = Memory(Buffer())
    agent = started_agent(memory=memory, own=Own(memory), fixed=DMFixed(memory, default=0.1))
    agent.memory.add("a x", worth=1)
    agent.memory.add("a y", worth=2, fixed=0.2)
    agent.memory.add("a x", worth=3)
    agent.memory.request("a ?")
    agent.run(1)
    assert agent.memory._buffer.chunk == Chunk("a x")
    assert agent.memory.get_activation("a x") == 3 + 0.1
    assert agent.own.seen == [("matched", ["a x", "a y"]), ("recalled", "a x", near(0.05 * math.exp(-3.1), abs=1e-6))]


@pytest.mark.parametrize("limit", [0, 1, 2, None])
def test_the_order_in_which_uses_are_declared_does_not_count_in_act_r_7(limit: int | None) -> None:
    found: list[float] = []
    for times in ([50, 10, 30], [10, 30, 50], [30, 50, 10]):
        memory = Memory(Buffer())
        agent = started_agent("act-r-7", memory=memory, base=DMBaseLevel(memory, limit=limit))
        for time in times:
            agent.memory.add("x", time=time)
        agent.run(1)
        found.append(agent.memory.get_activation("x"))
    assert found == near([found[0]] * 3)


def test_discarded_times_cannot_be_used_again() -> None:
    memory = Memory(Buffer())
    agent = started_agent(memory=memory, base=DMBaseLevel(memory, limit=0))
    agent.memory.add("x")
    agent.memory.add("x")
    with pytest.raises(ParameterError, match=r"DMBaseLevel\.limit: must be a number, because times of references have not been kept"):
        agent.base.limit = None


@pytest.mark.parametrize("again", [False, True])
@pytest.mark.parametrize(
    ("module", "given"),
    [
        (DMBaseLevel, {"baselevel": "2"}),
        (DMBaseLevel, {"baselevel": [1]}),
        (DMBaseLevel, {"time": "2"}),
        (DMBaseLevel, {"time": math.inf}),
        (DMFixed, {"fixed": [1]}),
        (DMFixed, {"fixed": "2"}),
    ],
)
def test_an_added_chunk_takes_numbers_only(module: Any, given: dict[str, Any], again: bool) -> None:
    memory = Memory(Buffer())
    agent = started_agent(memory=memory, part=module(memory))
    if again:
        agent.memory.add("a")
    ((name, value),) = given.items()
    with pytest.raises(ParameterError) as caught:
        agent.memory.add("a", **given)
    assert str(caught.value).startswith(f"memory.add: {name}: must be a ")
    assert str(caught.value).endswith(f"number (got {value!r})")
    assert len(agent.memory.dm) == int(again)
