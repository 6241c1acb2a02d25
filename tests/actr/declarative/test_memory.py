"""Requests: times, thresholds, finsts, probabilities, and what modellers may do with a memory."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest

from actr3d.actr import Buffer, Chunk, DMBaseLevel, DMFixed, DMNoise, Memory, MemorySubModule
from actr3d.actr.chunks.pattern import Pattern
from actr3d.actr.declarative.memory import LONGEST
from actr3d.errors import ChunkError, ModelWarning
from tests.helpers.small_agents import near, started_agent


def remembering(profile: str = "python-actr", kind: Any = Memory, **options: Any) -> Any:
    buffer = Buffer()
    memory = kind(buffer, **options)
    return started_agent(profile, buffer=buffer, memory=memory, fixed=DMFixed(memory))


def arrival(agent: Any, pattern: Any, **keys: Any) -> tuple[float, Any]:
    """Makes a request, and returns when it ends [s from then] and what the buffer holds then, found to a microsecond."""
    begin = agent.now()
    agent.memory.request(pattern, **keys)
    while agent.memory.busy:
        wait = agent.sch.queue.heap[0][0] - agent.sch.now_us
        agent.run(wait / 1_000_000)
    return agent.now() - begin, agent.buffer.chunk


@pytest.mark.parametrize(
    ("latency", "activation", "expected"),
    [(0.63, 1.0, 0.231764), (0.05, 0.0, 0.05), (0.05, -1.0, 0.135914), (1.0, 2.5, 0.082085), (0.05, -6.0, 10.0), (0.05, 40.0, 0.0)],
)
def test_retrieval_time(latency: float, activation: float, expected: float) -> None:
    agent = remembering(latency=latency, threshold=None)
    agent.memory.add("a", fixed=activation)
    assert arrival(agent, "a") == (near(expected, abs=1.1e-6), Chunk("a"))


def test_published_latency() -> None:
    agent = remembering(latency=0.63)
    agent.memory.add("a", fixed=1)
    assert arrival(agent, "a")[0] == near(0.232, abs=5e-4)


@pytest.mark.parametrize(("threshold", "time"), [(0, 0.05), (1.5, 0.011157), (-2, 0.369453), (-9, 2.5), (None, 2.5), (-1e6, 2.5), (1e6, 0)])
def test_failure_time(threshold: float | None, time: float) -> None:
    agent = remembering(threshold=threshold, maximum_time=2.5)
    agent.buffer.set("old")
    agent.memory.request("a")
    assert (agent.buffer.chunk, agent.memory.busy, agent.memory.error) == (Chunk("old"), True, False)
    assert arrival(agent, "a") == (near(time, abs=1.1e-6), None)
    assert agent.memory.error


@pytest.mark.parametrize("profile", ["python-actr", "act-r-7"])
@pytest.mark.parametrize("activation", [math.inf, 1e308, 5000.0, 0.0, -5000.0, -1e308, -math.inf])
@pytest.mark.parametrize("latency", [0.0, 0.05, 1e300])
def test_activations_of_any_size(profile: str, activation: float, latency: float) -> None:
    agent = remembering(profile, latency=latency, threshold=None)
    agent.memory.add("a", fixed=activation)
    time, chunk = arrival(agent, "a")
    assert chunk == Chunk("a")
    if latency == 0 or activation > 1000:
        assert time == 0
    else:
        assert time == (latency if (latency, activation) == (0.05, 0) else 10 if profile == "python-actr" else LONGEST)


def test_act_r_7_has_no_maximum_time_unless_one_is_set() -> None:
    agent = remembering("act-r-7", latency=1, threshold=-10)
    agent.memory.add("a", fixed=-3)
    assert arrival(agent, "a") == (near(math.exp(3), abs=1e-3), Chunk("a"))
    assert arrival(remembering("act-r-7", threshold=None), "a") == (10, None)
    agent.memory.maximum_time = 2.5
    agent.memory.request("a")
    agent.run()
    assert agent.now() == near(math.exp(3) + 2.5, abs=1e-3)


def test_an_activation_that_is_no_number_never_wins_and_is_warned_of() -> None:
    agent = remembering(threshold=-5)
    for text, fixed in [("a 1", math.nan), ("a 2", -1.0), ("a 3", math.nan)]:
        agent.memory.add(text, fixed=fixed)
    with pytest.warns(ModelWarning, match=r"the activation of 'a [13]' is not a number") as caught:
        assert arrival(agent, "a ?")[1] == Chunk("a 2")
    assert {warning.filename for warning in caught} == {__file__}
    with pytest.warns(ModelWarning, match="not a number"):
        assert arrival(agent, "a 1")[1] is None
    assert agent.memory.error


def test_recall_has_the_logistic_chance() -> None:
    buffer = Buffer()
    memory = Memory(buffer, threshold=0.3)
    agent = started_agent(buffer=buffer, memory=memory, fixed=DMFixed(memory), noise=DMNoise(memory, noise=0.5), seed=3)
    n = 4000
    for activation in (-0.4, 0.3, 0.9):
        agent.memory.clear()
        agent.memory.add("a", fixed=activation)
        recalled = 0
        for _ in range(n):
            agent.memory.request("a")
            recalled += agent.memory._last.chosen is not None
            agent.run(11)
        p = 1 / (1 + math.exp((0.3 - activation) / 0.5))
        assert abs(recalled - n * p) < 4 * math.sqrt(n * p * (1 - p))


@pytest.mark.parametrize("seed", range(30))
def test_a_request_retrieves_the_best_of_all_that_match(seed: int) -> None:
    numbers = random.Random(seed)
    agent = remembering(threshold=0.2, maximum_time=60)
    for _ in range(30):
        text = " ".join(f"{slot}:{numbers.choice('pqr')}" for slot in "abc" if numbers.random() < 0.8)
        agent.memory.add(text or "d:x", fixed=numbers.choice([-1, 0.5, 0.75, 2]))
    for _ in range(20):
        pattern = " ".join(f"{slot}:{numbers.choice(['p', '!q', '?', '?x', '!?x'])}" for slot in numbers.sample("abc", 2))
        compiled = Pattern(pattern)
        matching: list[Any] = [chunk for chunk in agent.memory.dm if compiled.match(chunk) is not None]
        best = max((chunk.fixed for chunk in matching), default=-math.inf)
        time, found = arrival(agent, pattern)
        if best < 0.2:
            assert found is None
        else:
            assert found in [chunk for chunk in matching if chunk.fixed == best]
            assert time == near(0.05 * math.exp(-best), abs=1.1e-6)


@pytest.mark.parametrize("pattern", [5, 2.5, ["a:?", True]])
def test_a_request_that_is_no_pattern_matches_anything_and_is_warned_of(pattern: Any) -> None:
    agent = remembering(threshold=None)
    agent.memory.add("a:1")
    with pytest.warns(ModelWarning, match=r"the request .* is not a pattern and matches anything; write text, such as '"):
        assert arrival(agent, pattern)[1] == {"a": "1"}


def test_a_tie_is_decided_at_random() -> None:
    agent = remembering(finst_size=0)
    for n in range(3):
        agent.memory.add(f"a {n}")
    counts: dict[str, int] = dict.fromkeys(("a 0", "a 1", "a 2"), 0)
    for _ in range(900):
        counts[str(arrival(agent, "a ?")[1])] += 1
    assert all(abs(count - 300) < 4 * math.sqrt(900 * 2 / 9) for count in counts.values())


def test_a_later_request_cancels_an_earlier_one() -> None:
    agent = remembering()
    agent.memory.add("a x")
    agent.memory.add("b y")
    agent.memory.request("a ?")
    agent.run(0.04)
    agent.memory.request("b ?")
    agent.run(0.0401)
    assert (agent.buffer.chunk, agent.memory.busy) == (None, True)
    agent.run(0.01)
    assert (agent.buffer.chunk, agent.memory.busy) == (Chunk("b y"), False)


def test_finsts() -> None:
    agent = remembering(finst_size=2, finst_time=1.0)
    for n in range(3):
        agent.memory.add(f"a {n}", fixed=-0.1 * n + 1)
    found = [str(arrival(agent, "a ?", require_new=True)[1]) for _ in range(3)]
    assert found == ["a 0", "a 1", "a 2"]
    assert str(arrival(agent, "a ?", require_new=True)[1]) == "a 0"  # the oldest mark was dropped
    assert [str(chunk) for chunk in agent.memory._last.excluded] == ["a 1", "a 2"]
    agent.run(0.9)
    assert [str(chunk) for chunk in agent.memory.finst.obj] == ["a 2", "a 0"]
    agent.run(0.11)
    assert agent.memory.finst.obj == []


def test_equal_chunks_merge_whatever_form_they_come_in() -> None:
    class Thing:
        def __init__(self) -> None:
            self.colour = "red"
            self.size = 3

    buffer = Buffer()
    memory = Memory(buffer)
    agent = started_agent(buffer=buffer, memory=memory, base=DMBaseLevel(memory))
    agent.buffer.set({"size": 3, "colour": "red"})
    for form in ({"colour": "red", "size": 3}, Thing(), agent.buffer, Chunk({"colour": "red", "size": 3.0})):
        agent.memory.add(form)
    assert [chunk.count for chunk in agent.memory.dm] == [4]
    agent.memory.add("colour:red size:3")  # text is another value than a number
    assert len(agent.memory.dm) == 2


def test_an_empty_buffer_is_no_chunk() -> None:
    agent = remembering()
    with pytest.raises(ChunkError, match="memory 'memory': buffer 'buffer' is empty"):
        agent.memory.add(agent.buffer)


def test_a_misspelt_keyword_warns_in_the_models_file_and_changes_nothing() -> None:
    agent = remembering()
    with pytest.warns(
        ModelWarning, match=r"memory.add: no activation module has a keyword 'baselvel'; did you mean 'baselevel'\?"
    ) as caught:
        agent.memory.add("a", baselvel=3)
    assert [warning.filename for warning in caught] == [__file__]
    assert agent.memory.get_activation("a") == 0
    agent.memory.add("b", baselevel=2, time=4, fixed=1)  # for modules that it does not have


def test_user_defined_modules_may_take_keywords_of_their_own() -> None:
    class Named(MemorySubModule):
        def create(self, chunk: Any, worth: float = 0, **keys: Any) -> None:
            chunk.worth = worth + keys.get("bonus", 0)

        def activation(self, chunk: Any) -> float:
            return chunk.worth

    memory = Memory(Buffer())
    agent = started_agent(memory=memory, named=Named(memory))
    agent.memory.add("a", worth=2, bonus=3)
    assert agent.memory.get_activation("a") == 5


def test_dm_is_a_list() -> None:
    agent = remembering()
    for n in range(6):
        agent.memory.add(f"a {n}")
    del agent.memory.dm[1:3]
    agent.memory.dm.remove(Chunk("a 5"))
    assert [str(c) for c in agent.memory.find_matching_chunks("a ?")] == ["a 0", "a 3", "a 4"]
    agent.memory.dm[0][1] = "9"
    assert agent.memory.find_matching_chunks("a 9") == [agent.memory.dm[0]]
    assert agent.memory.find_matching_chunks("a 0") == []
    assert arrival(agent, "a 0")[1] is None
    agent.memory.dm = agent.memory.dm[1:]
    agent.memory.dm += [Chunk("a 7")]
    agent.memory.add("a 3")
    assert [str(c) for c in agent.memory.dm] == ["a 3", "a 4", "a 7"]
    assert arrival(agent, "a 7")[1] == Chunk("a 7")
    agent.memory.dm = list[Chunk]()
    agent.memory.add("a 1")
    assert agent.memory.dm == [Chunk("a 1")]
    agent.memory.clear()
    assert arrival(agent, "a ?")[1] is None


def test_unhashable_values() -> None:
    agent = remembering()
    agent.memory.add({"a": [1], "b": "x"})
    agent.memory.add({"a": [1], "b": "x"})
    assert len(agent.memory.dm) == 1
    agent.memory.dm[0]["a"].append(2)
    assert arrival(agent, {"a": [1, 2]})[1] == Chunk({"a": [1, 2], "b": "x"})
    assert agent.memory.find_matching_chunks({"a": [1]}) == []


def test_a_user_defined_memory() -> None:
    class Own(Memory):
        latency = 0.2
        threshold = -1

        def get_activation(self, chunk: Any) -> float:
            return float(chunk["worth"])

    agent = remembering(kind=Own)
    agent.memory.add("worth:1")
    agent.memory.add("worth:3")
    assert arrival(agent, "worth:?") == (near(0.2 * math.exp(-3), abs=1e-6), Chunk("worth:3"))


def test_matched_may_leave_candidates_out() -> None:
    class Censor(MemorySubModule):
        def matched(self, chunks: list[Any]) -> None:
            chunks[:] = [chunk for chunk in chunks if chunk[1] != "bad"]

    buffer = Buffer()
    memory = Memory(buffer)
    agent = started_agent(buffer=buffer, memory=memory, censor=Censor(memory))
    agent.memory.add("a bad")
    agent.memory.add("a good")
    assert arrival(agent, "a ?")[1] == Chunk("a good")
    assert arrival(agent, "a bad")[1] is None


def test_get_activation_of_an_unknown_chunk() -> None:
    agent = remembering()
    with pytest.raises(ChunkError, match="memory 'memory' has no chunk 'a b'"):
        agent.memory.get_activation("a b")
    agent.memory.add("a b", fixed=2)
    assert agent.memory.get_activation(Chunk("a b")) == 2
    assert agent.memory.find_matching_chunks("a ?", threshold=2) == [Chunk("a b")]
    assert agent.memory.find_matching_chunks("a ?", threshold=2.1) == []
