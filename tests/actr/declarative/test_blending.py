"""Blending, against the published numbers and means computed with high precision."""

from __future__ import annotations

import math
from decimal import Decimal, getcontext
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from actr3d.actr import BlendingMemory, Buffer, Chunk, DMFixed, DMNoise, Memory, Partial
from actr3d.errors import ParameterError
from tests.helpers.small_agents import near, started_agent

getcontext().prec = 60


def blending(profile: str = "python-actr", noise: float | None = None, **options: Any) -> Any:
    buffer = Buffer()
    memory = BlendingMemory(buffer, **options)
    parts: dict[str, Any] = {"buffer": buffer, "memory": memory, "fixed": DMFixed(memory)}
    if noise is not None:
        parts["noise"] = DMNoise(memory, noise=noise)
    return started_agent(profile, **parts)


def mean(rows: list[tuple[float, float]], t: float) -> float:
    weights = [(Decimal(repr(a)) / Decimal(repr(t))).exp() for a, _ in rows]
    total = sum((w * Decimal(repr(v)) for w, (_, v) in zip(weights, rows, strict=True)), Decimal(0))
    return float(total / sum(weights, Decimal(0)))


PUBLISHED = [(2.53252, 1.0), (3.76348, 2.0), (4.34334, 3.0)]


@pytest.mark.parametrize(("temperature", "expected"), [(0.35355, 2.82841), (1.0, 2.48534), (None, 2.48534)])
@pytest.mark.parametrize("profile", ["python-actr", "act-r-7"])
def test_published_blends(profile: str, temperature: float | None, expected: float) -> None:
    agent = blending(profile)
    agent.memory.temperature = temperature
    for activation, value in PUBLISHED:
        agent.memory.add(f"size:big n:{value}", fixed=activation)
    agent.memory.request("size:big")
    agent.run(1)
    assert agent.buffer.chunk["n"] == near(expected, abs=5e-6)
    assert agent.buffer.chunk["size"] == "big"


def test_act_r_7_takes_its_temperature_from_the_noise() -> None:
    for noise in (0.25, 0.1):
        agent = blending("act-r-7", noise=noise)
        agent.memory.add("n:0 k:a", fixed=1)
        agent.memory.add("n:1 k:a", fixed=1)
        agent.memory.request("k:a")
        drawn = [(activation, float(chunk["n"])) for chunk, _, _, activation in agent.memory._last.rows]
        agent.run(10)
        assert agent.buffer.chunk["n"] == near(mean(drawn, math.sqrt(2) * noise), rel=1e-12)


def test_the_time_is_the_best_chunks_or_that_of_all() -> None:
    activations = [0.3, 0.1, -0.4]
    together = math.log(sum(map(math.exp, activations)))
    for profile, expected in [("python-actr", 0.05 * math.exp(-0.3)), ("act-r-7", round(math.exp(-together), 3))]:
        agent = blending(profile)
        for n, activation in enumerate(activations):
            agent.memory.add(f"n:{n}", fixed=activation)
        agent.memory.request("n:?")
        assert agent.memory._last.latency == near(expected, abs=1e-9)
        agent.run(expected - 1e-5)
        assert agent.buffer.chunk is None
        agent.run(2e-5)
        assert agent.buffer.chunk is not None


def test_the_threshold_is_compared_with_the_best_or_with_all_together() -> None:
    for profile, arrives in [("python-actr", False), ("act-r-7", True)]:
        agent = blending(profile, threshold=0.5)
        agent.memory.add("n:1", fixed=0.4)
        agent.memory.add("n:2", fixed=0.4)  # ln(2 exp 0.4) is 1.09
        agent.memory.request("n:?")
        agent.run(2)
        assert (agent.buffer.chunk is not None) is arrives
        assert agent.memory.error is not arrives


def test_a_chunk_without_numbers_also_takes_act_r_7s_time() -> None:
    agent = blending("act-r-7")
    agent.memory.add("a:x", fixed=0.2)
    agent.memory.add("a:y", fixed=0.1)
    agent.memory.request("a:?")
    agent.run(round(1 / (math.exp(0.2) + math.exp(0.1)), 3))
    assert agent.buffer.chunk == Chunk("a:x")


@settings(max_examples=60, deadline=None)
@given(
    rows=st.lists(
        st.tuples(st.floats(-6, 6), st.floats(-1e3, 1e3).map(lambda value: value + 0.0)),
        min_size=1,
        max_size=6,
        unique_by=lambda row: f"{row[1]:g}",
    ),
    t=st.floats(0.05, 3),
)
def test_blends_are_weighted_means(rows: list[tuple[float, float]], t: float) -> None:
    agent = blending(threshold=None, maximum_time=60)
    agent.memory.temperature = t
    for activation, value in rows:
        agent.memory.add({"n": value}, fixed=activation)
    agent.memory.request("n:?")
    agent.run(60)
    assert agent.buffer.chunk["n"] == near(mean(rows, t), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("profile", ["python-actr", "act-r-7"])
@pytest.mark.parametrize("level", [-5000.0, -760.0, 0.0, 760.0, 5000.0])
def test_activations_of_any_size(profile: str, level: float) -> None:
    agent = blending(profile, threshold=None)
    agent.memory.add("n:1", fixed=level)
    agent.memory.add("n:2", fixed=level + math.log(3))
    agent.memory.request("n:?")
    agent.run()
    assert agent.buffer.chunk["n"] == near(1.75, rel=1e-9)


def test_non_numbers_and_chunks_with_other_slots_are_left_out_in_python_actr() -> None:
    agent = blending()
    for text, fixed in [("n:2 a:x", 1.0), ("n:4 a:y", 1.0), ("n:many a:x", 0.5), ("n:100", 0.9), ("n:100 a:x b:y", 0.9)]:
        agent.memory.add(text, fixed=fixed)
    agent.memory.add({"n": None, "a": "x"}, fixed=0.2)
    agent.memory.request("n:?")
    agent.run(2)
    assert agent.buffer.chunk["n"] == near(3.0)
    assert [chunk["n"] for chunk in agent.memory.dm][:2] == ["2", "4"]


@pytest.mark.parametrize("profile", ["python-actr", "act-r-7"])
@pytest.mark.parametrize("word", ["nan", "Infinity", "1_000", 10**400], ids=["nan", "Infinity", "1_000", "large"])
def test_blends_are_of_finite_numbers_in_plain_notation(word: object, profile: str) -> None:
    agent = blending(profile, threshold=None)
    for value, fixed in [(2, 1.0), (word, 2.0)]:
        agent.memory.add({"n": value}, fixed=fixed)
    agent.memory.request("n:?")
    agent.run(2)
    assert agent.buffer.chunk["n"] == word


def test_a_blend_of_partial_matches() -> None:
    buffer = Buffer()
    memory: Any = BlendingMemory(buffer, threshold=-9)
    partial = Partial(memory, strength=2)
    partial.similarity("red", "pink", -0.3)
    agent = started_agent(buffer=buffer, memory=memory, partial=partial, fixed=DMFixed(memory))
    agent.memory.add("c:red n:1")
    agent.memory.add("c:pink n:5", fixed=0.1)
    agent.memory.request("c:red")
    agent.run(2)
    assert agent.buffer.chunk["n"] == near(mean([(0.0, 1.0), (0.1 - 0.6, 5.0)], 1.0))
    assert isinstance(agent.memory, Memory)


# -- symbolic values, as in ACT-R 7


def blend_of(rows: list[tuple[str, float]], request: str, *similarities: tuple[str, str, float], temperature: float = 1.0) -> Any:
    """Returns the blend in ACT-R 7 of chunks with these activations."""
    buffer = Buffer()
    memory: Any = BlendingMemory(buffer, threshold=None)
    partial = Partial(memory, strength=None)
    for a, b, value in similarities:
        partial.similarity(a, b, value)
    agent = started_agent("act-r-7", buffer=buffer, memory=memory, partial=partial, fixed=DMFixed(memory))
    agent.memory.temperature = temperature
    for text, activation in rows:
        agent.memory.add(text, fixed=activation)
    agent.memory.request(request)
    agent.run(100)
    return agent.buffer.chunk


LN2 = math.log(2)
SIZES = [("small", "medium", -0.1), ("medium", "large", -0.1), ("small", "large", -0.6)]


def test_without_similarities_the_value_of_most_weight_wins() -> None:
    rows = [("is:thing size:small n:1", 0.0), ("is:thing size:large n:2", 0.1), ("is:thing size:small n:3", -0.1)]
    assert blend_of(rows, "is:thing")["size"] == "small"  # exp 0 + exp -0.1 > exp 0.1, though the most active one is large


def test_the_least_weighted_squared_dissimilarity_wins_though_no_chunk_has_that_value() -> None:
    # p: small 2/3, large 1/3. small: 1/3 * 0.36 = 0.12. large: 2/3 * 0.36 = 0.24. medium: 2/3 * 0.01 + 1/3 * 0.01 = 0.01.
    rows = [("is:thing size:small", LN2), ("is:thing size:large", 0.0)]
    assert blend_of(rows, "is:thing", *SIZES)["size"] == "medium"
    # Not squared, small would win: 1/3 * 0.6 = 0.2, and medium: 0.25. Squared, 0.12 and 0.0625.
    wide = [("small", "medium", -0.25), ("medium", "large", -0.25), ("small", "large", -0.6)]
    assert blend_of(rows, "is:thing", *wide)["size"] == "medium"


def test_a_value_that_was_experienced_wins_where_the_one_between_is_too_far_off() -> None:
    # medium: 2/3 * 0.16 + 1/3 * 0.16 = 0.16, small: 0.12.
    far = [("small", "medium", -0.4), ("medium", "large", -0.4), ("small", "large", -0.6)]
    assert blend_of([("is:thing size:small", LN2), ("is:thing size:large", 0.0)], "is:thing", *far)["size"] == "small"


def test_the_temperature_weighs_experiences() -> None:
    rows = [("is:thing size:small", LN2), ("is:thing size:large", 0.0), ("is:thing size:large n:1", 0.0), ("is:thing size:large n:2", 0.0)]
    assert blend_of(rows, "is:thing")["size"] == "large"  # weights 2 and 3
    assert blend_of(rows, "is:thing", temperature=0.5)["size"] == "small"  # 4 and 3


def test_the_first_of_equally_good_values_wins() -> None:
    rows = [("is:thing size:large", 0.3), ("is:thing size:small", 0.3)]
    assert blend_of(rows, "is:thing")["size"] == "large"
    assert blend_of(rows[::-1], "is:thing")["size"] == "small"
    # All three are equally good, 1/2 * 0.25, and no chunk has medium.
    tied = [("medium", "small", -0.5), ("medium", "large", 0.0), ("small", "large", -0.5)]
    assert blend_of(rows, "is:thing", *tied)["size"] == "large"
    # The first two are equally good, 0, and no chunk has either.
    unknown = [(name, size, 0.0) for name in ("middling", "fair") for size in ("small", "large")]
    assert blend_of(rows, "is:thing", *unknown)["size"] == "middling"


def test_missing_slots_and_nones_count_for_nothing() -> None:
    rows = [("is:thing size:small", 0.0), ("is:thing size:None", 3.0), ("is:thing colour:red", 4.0), ("is:thing size:None colour:red", 0.0)]
    chunk = blend_of(rows, "is:thing")
    assert chunk["size"] == "small"
    assert chunk["colour"] == "red"
    assert "size" not in blend_of(rows[1:3], "is:thing")


def test_the_sum_of_numbers_does_not_make_up_for_missing_ones() -> None:
    # The probabilities of all matching chunks are 1/4, 1/4 and 1/2; the last one has no n.
    rows = [("is:thing n:4", 0.0), ("is:thing n:8", 0.0), ("is:thing", LN2)]
    assert blend_of(rows, "is:thing")["n"] == near(3.0)


def test_requested_slots_keep_the_requested_values() -> None:
    rows = [("size:small n:1", 0.0), ("size:small n:2", 0.0)]
    chunk = blend_of(rows, "size:small n:1", ("small", "tiny", 0.0), ("1", "2", 0.0))
    assert chunk == {"size": "small", "n": "1"}
    buffer = Buffer()
    memory: Any = BlendingMemory(buffer, threshold=None)
    partial = Partial(memory, strength=0.1)
    partial.similarity("large", "small", -0.5)
    agent = started_agent("act-r-7", buffer=buffer, memory=memory, partial=partial, fixed=DMFixed(memory))
    agent.memory.add("size:small n:1", fixed=5)
    agent.memory.request("size:large")
    agent.run(10)
    assert agent.buffer.chunk == {"size": "large", "n": 1.0}


def test_words_among_numbers_are_compared_with_what_chunks_have_only() -> None:
    # Not all values are numbers, and not all are words: the candidates are 2, 4 and many. B(2) = B(4) = 3/4, B(many) = 1/2.
    rows = [("n:2", 0.0), ("n:4", 0.0), ("n:many", LN2)]
    assert blend_of(rows, "n:?")["n"] == "many"
    assert blend_of(rows, "n:?", ("several", "2", 0.0), ("several", "4", 0.0), ("several", "many", 0.0))["n"] == "many"
    assert blend_of(rows, "n:?", ("2", "4", 0.0), ("2", "many", -0.5))["n"] == "2"  # B(2) = 1/2 * 0.25, B(many) = 1/4 * 0.25 + 1/4


def test_similarities_without_a_strength_leave_matching_exact() -> None:
    assert blend_of([("size:small n:1", 0.0)], "size:large", ("small", "large", -0.1)) is None


def test_values_of_any_kind_can_be_blended() -> None:
    rows: list[Any] = [{"v": [1, 2]}, {"v": True}, {"v": [1, 2], "k": 1}, {"v": math.inf}]
    buffer = Buffer()
    memory: Any = BlendingMemory(buffer, threshold=None)
    agent = started_agent("act-r-7", buffer=buffer, memory=memory, fixed=DMFixed(memory))
    for row in rows:
        agent.memory.add(row)
    agent.memory.request("v:?")
    agent.run(10)
    assert agent.buffer.chunk["v"] == [1, 2]


def test_a_temperature_must_be_positive() -> None:
    agent = blending()
    with pytest.raises(ParameterError, match=r"BlendingMemory\.temperature: must be > 0 \(got -0\.5\)"):
        agent.memory.temperature = -0.5
