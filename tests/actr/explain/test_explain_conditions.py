"""Explanations of each condition of a production, also of those after the first that fails."""

from __future__ import annotations

from typing import Any

from tests.helpers.explanations import agent_of

SOURCE = """
def small(thing, bound):
    return int(bound['now']) < 4

class Agent(ACTR):
    goal = Buffer()
    other = Buffer()
    def init():
        goal.set('task:add now:3 last:5')
    def fires(goal='task:add now:?now last:!?now', other=None):
        pass
    def fails(goal='task:subtract now:?now more:?more last:!?more', other='value:?more'):
        pass
    def asks(goal=['task:add now:?now', small]):
        pass
    def asks_nothing(goal=['task:subtract now:?now', small]):
        pass
"""


def conditions_of(agent: Any, name: str, at: float | None = None) -> list[tuple[str, bool | None, str]]:
    return [(one.condition, one.holds, one.found) for one in agent.explain(at).production(name).conditions]


def test_conditions_are_explained_one_by_one() -> None:
    agent = agent_of(SOURCE)
    agent.traced()
    agent.run(0.02)
    for at in (None, 0.01):
        assert conditions_of(agent, "fires", at) == [
            ("goal: task:add", True, "'add'"),
            ("goal: now:?now", True, "'3'"),
            ("other: None", True, "empty"),
            ("goal: last:!?now", True, "'5'"),
        ]
        assert conditions_of(agent, "asks", at)[-1] == ("goal: small()", True, "a value other than False")


def test_conditions_after_the_failing_one_are_explained_as_far_as_possible() -> None:
    agent = agent_of(SOURCE)
    agent.traced()
    agent.run(0.02)
    for at in (None, 0.01):
        assert conditions_of(agent, "fails", at) == [
            ("goal: task:subtract", False, "'add'"),
            ("goal: now:?now", True, "'3'"),
            ("goal: more:?more", False, "no slot 'more'"),
            ("goal: last:!?more", None, "?more is not bound"),
            ("other: value:?more", False, "other is empty"),
        ]
        reason = agent.explain(at).production("fails")
        assert reason.condition == "goal: task:subtract"
        assert reason.bindings == {}, "a production is left at the first condition that fails"
        assert conditions_of(agent, "asks_nothing", at)[-1] == (
            "goal: small()",
            None,
            "unknown (the function is called only if all conditions before it hold)",
        )
