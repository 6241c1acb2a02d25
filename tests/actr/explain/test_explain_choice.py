"""Why a production was chosen or lost: utilities of the choice, ties, thresholds, the modeller's own utility."""

from __future__ import annotations

import pytest

from tests.helpers.explanations import agent_of, assert_past_matches, recorded_calls

TWO = """
class Agent(ACTR):
    goal = Buffer()
    {more}
    def init(): goal.set('a')
    def low(goal='a', utility=1): goal.set('b')
    def high(goal='a', utility={high}): goal.set('b')
    def never(goal='c', utility=9): pass
"""


def verdicts(source: str) -> dict[str, str | None]:
    agent = agent_of(source)
    agent.traced()
    agent.run(0.01)
    live = agent.explain()
    agent.run(1)
    assert agent.explain(0.01) == live
    assert all(reason.verdict is None for reason in agent.explain().productions)
    return {reason.name: reason.verdict for reason in live.productions}


def test_the_utilities_of_the_loser_and_the_winner_are_explained() -> None:
    explained = verdicts(TWO.format(more="", high=2.5))
    assert explained["high"] == "selected: the highest utility, 2.5"
    assert explained["low"] == "lost to high: utility 1 against 2.5"
    assert explained["never"] == "did not match when high was selected"


def test_a_tie_is_explained() -> None:
    explained = sorted(str(verdict) for verdict in verdicts(TWO.format(more="", high=1)).values())
    assert any(verdict.startswith("selected at random among 2 of utility 1") for verdict in explained)
    assert any("which was chosen at random: both have utility 1" in verdict for verdict in explained)


def test_noise_is_that_of_the_choice() -> None:
    agent = agent_of(TWO.format(more="noise = PMNoise(noise=0.4)", high=1.1))
    agent.traced()
    agent.run(0.01)
    low, high = (agent.explain().production(name) for name in ("low", "high"))
    conflict = agent.sch.trace.select("conflict")[0].data["utilities"]
    assert (low.utility, high.utility) == (conflict["low"], conflict["high"])
    winner, loser = (low, high) if low.selected else (high, low)
    assert loser.verdict == f"lost to {winner.name}: utility {loser.utility:.6g} against {winner.utility:.6g}"
    agent.run(1)
    assert agent.explain(0.01).production("low") == low


def test_the_threshold_that_excludes_the_best_is_explained() -> None:
    agent = agent_of(TWO.format(more="noise = PMNoise(noise=0.1)\n    production_threshold = 50", high=2))
    agent.traced()
    agent.run(0.2)
    why = agent.explain().production("high")
    assert why.matches
    assert not why.selected
    assert why.utility is not None
    assert why.verdict == f"not selected: its utility {why.utility:.4g} is below the production threshold 50"
    assert agent.explain(0.1).production("high") == why
    assert "below the production threshold" in str(agent.explain())


def test_a_plain_production_system_chooses_at_random() -> None:
    agent = agent_of("""
class Agent(ProductionSystem):
    goal = Buffer()
    def init(): goal.set('a')
    def one(goal='a'): pass
    def two(goal='a'): pass
""")
    agent.run(0.01)
    explained = sorted(str(reason.verdict) for reason in agent.explain().productions)
    assert explained[1] == "selected at random among 2"
    assert explained[0].startswith("not selected: ")


OWN = """
asked = []
class Agent(ACTR):
    goal = Buffer()
    more = PMNew()
    def get_activation(self, production):
        asked.append(production.name)
        return 7.0 + len(asked)
    def init(): goal.set('a')
    def one(goal='a'): goal.set('b')
    def two(goal='a'): goal.set('b')
    def three(goal='c'): pass
"""


def test_a_modellers_own_utility_counts_and_is_not_called_again() -> None:
    agent = agent_of(OWN)
    agent.traced()
    agent.run(0.01)
    asked = recorded_calls(agent, "asked")
    before = list(asked)
    live = agent.explain()
    assert live.production("one").parts == {"get_activation": 8.0}
    assert live.production("two").utility == 9.0
    assert live.production("two").selected
    assert live.production("one").verdict == "lost to two: utility 8 against 9"
    assert live.production("three").utility is None
    agent.run(0.1)
    assert agent.explain(0.01) == live
    assert asked == before


def test_a_modellers_own_module_is_called_at_choices_only() -> None:
    agent = agent_of("""
asked = []
class Mine(ProceduralSubModule):
    def utility(self, prod):
        asked.append(prod.name)
        return 3 + len(asked)
class Agent(ACTR):
    goal = Buffer()
    mine = Mine()
    def init(): goal.set('a')
    def one(goal='a', utility=1): goal.set('b')
    def two(goal='b'): pass
""")
    asked = recorded_calls(agent, "asked")
    agent.traced()
    assert asked == []
    agent.run(0.01)
    live = agent.explain()
    assert live.production("one").parts == {"base": 1, "mine": 4}
    assert live.production("two").parts == {"base": 0, "mine": None}
    agent.run(0.02)
    assert agent.explain(0.01) == live
    assert asked == ["one"]


def test_noise_that_is_off_uses_up_no_random_number_when_a_trace_begins() -> None:
    source = TWO.format(more="noise = PMNoise(noise=0, baseNoise=0.3)", high=1)
    states: list[object] = []
    for traced in (False, True):
        agent = agent_of(source)
        if traced:
            agent.traced()
            agent.explain()
        states.append(agent.random.getstate())
    assert states[0] == states[1]


@pytest.mark.parametrize(
    "module",
    [
        "PMNew(alpha=0.3)",
        "PMPGC(goal=8)",
        "PMPGCSuccessWeighted(goal=8)",
        "PMPGCMixedWeighted()",
        "PMTD()",
        "PMNoise(0.2)",
        "PMNoise(0, 0.3)",
    ],
)
def test_every_utility_module_is_explained_later_as_it_was(module: str) -> None:
    agent = agent_of(f"""
class Agent(ACTR):
    goal = Buffer()
    one = {module}
    two = PMPGC()
    def init(): goal.set('a')
    def p(goal='a'): goal.set('b')
    def q(goal='a', utility=0.1): goal.set('b')
    def r(goal='b'):
        goal.set('a')
        self.reward(2)
        if self.now() > 0.3:
            self.two.goal = 30
            self.two.set('q', successes=5, failures=1)
""")
    agent.traced()
    agent.run(0.0)
    assert_past_matches(agent)
    parts = agent.explain(0.02).production("p").parts
    assert list(parts) == ["base", "one", "two"]
    if "PMNoise(0.2" not in module:
        assert None not in parts.values()


def test_a_compiled_production_says_where_it_comes_from() -> None:
    agent = agent_of("""
class Agent(ACTR):
    goal, retrieval = Buffer(), Buffer()
    memory = Memory(retrieval)
    learn = PMNew()
    compiling = PMCompile(keep='goal', request='memory.request', retrieve='retrieval')
    def init():
        memory.add('capital Canada Ottawa')
        goal.set('ask Canada')
    def ask(goal='ask ?country'):
        memory.request('capital ?country ?')
        goal.set('wait ?country')
    def answer(goal='wait ?country', retrieval='capital ?country ?city'):
        goal.set('ask ?country')
        self.reward(5)
""")
    agent.traced()
    agent.run(0.0)
    assert_past_matches(agent, 60)
    made = agent.explain().production("ask-answer-1")
    assert made.parents == ("ask", "answer")
    assert "compiled from ask and answer" in str(made)
    assert made.parts["learn"] is not None
