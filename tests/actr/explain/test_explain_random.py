"""Random models, explained at every step, and again later from the trace."""

from __future__ import annotations

import random

import pytest

from tests.helpers.explanations import agent_of

HEAD = """
class Lamp:
    colour, _hidden = 'red', 'q'
class Box(Model):
    side, items, pair = 3, [1, 2], (1, 2)
    @property
    def coin(self): return self.random.random() < 0.5
class Side(ProductionSystem):
    production_time, state = 0.03, '0'
    def up(goal='a:?u', self='state:0'): self.state = '1'
    def down(self='state:1', lamp='colour:red'): self.state = '0'
def count(chunk, bound): bound['z'] = str(len(chunk))
def even(chunk, bound): return len(str(bound)) % 2 == 0
class Agent(ACTR):
    goal, retrieval = Buffer(), Buffer()
    memory = Memory(retrieval, threshold=-1)
    lamp, box, side = Lamp(), Box(), Side()
    mood, pair, tags = 'x', (1, 2), ['t']
"""
MODULES = ("PMNew(0.3)", "PMNoise(0.3)", "PMPGC(8)", "PMTD()", "PMNoise(0, 0.4)", "PMPGCMixedWeighted()")
ACTIVATION = ("DMNoise(memory, 0.3)", "DMBaseLevel(memory)", "DMSpreading(memory, goal)", "Partial(memory)", "DMInhibition(memory)")
ELSE = (
    "lamp='colour:?u'", "lamp='_hidden:q'", "lamp=None", "box='side:?v'", "box='coin:True'", "box='pair:?u'", "box='items:?u'",
    "box='name:?u'", "self='mood:?v'", "self='pair:?u'", "self='tags:?v'", "memory='busy:False'", "memory='error:True'",
)  # fmt: skip
ACTS = (
    "goal.set('a:{w} b:{w} c:{w}')", "lamp.colour = '{w}'", "self.mood = '{w}'", "self.pair = ('{w}', 2)", "memory.request('a:{w}')",
    "memory.request('a:?', require_new=True)", "goal.chunk['a'] = '{w}'", "self.tags.append('{w}')", "box.items = '{w}'", "self.reward(3)",
)  # fmt: skip


def source_of(numbers: random.Random) -> str:
    """Returns a random agent."""

    def pattern() -> str:
        slots = [f"{s}:{numbers.choice(['x', 'y', '?u', '?v', '!x', '!?u'])}" for s in numbers.sample("abc", numbers.randint(1, 2))]
        text = repr(" ".join(slots))
        return numbers.choice([text, text, text, f"[{text}, count, even]", f"[even, {text}]", "None"])

    lines = [f"    pm{i} = {m}" for i, m in enumerate(numbers.sample(MODULES, numbers.randint(0, 3)))]
    lines += [f"    dm{i} = {m}" for i, m in enumerate(numbers.sample(ACTIVATION, numbers.randint(0, 3)))]
    lines += [f"    {line}" for line in ("production_threshold = 1", "production_match_delay = 0.02") if numbers.random() < 0.2]
    if numbers.random() < 0.15:
        lines.append("    def get_activation(self, production): return self.random.random()")
    lines.append("    def init():")
    lines += [f"        memory.add('a:{numbers.choice('xyz')} b:{numbers.choice('xyz')} c:{i}')" for i in range(5)]
    lines.append("        goal.set('a:x b:y c:x')")
    for i in range(numbers.randint(2, 6)):
        given = [f"{name}={pattern()}" for name in numbers.sample(["goal", "retrieval"], numbers.randint(0, 2))]
        taken = {text.split("=")[0]: text for text in numbers.sample(ELSE, numbers.randint(0 if given else 1, 2))}
        lines.append(f"    def p{i}({', '.join([*given, *taken.values(), f'utility={numbers.randint(0, 2)}'])}):")
        lines += [f"        {numbers.choice(ACTS).replace('{w}', numbers.choice('xyz'))}" for _ in range(numbers.randint(1, 3))]
    return HEAD + "\n".join(lines) + "\n"


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seed", range(25))
def test_the_past_of_any_model_is_explained_as_its_present_was(seed: int) -> None:
    numbers = random.Random(seed)
    agent = agent_of(source_of(numbers), seed)
    agent.traced()
    agent.run(0.0)
    now = [agent.explain()]
    for _ in range(30):
        agent.run(numbers.choice([0.0125, 0.02, 0.05]))
        now.append(agent.explain())
    certain = 0
    for then in now:
        past = agent.explain(then.time)
        assert past.retrievals == then.retrievals
        for was, later in zip(then.productions, past.productions, strict=True):
            assert (later.parts, later.verdict, later.selected) == (was.parts, was.verdict, was.selected)
            if later.source is None and later.matches is not None and was.matches is not None:
                certain += 1
                assert later == was
    assert certain > 10
