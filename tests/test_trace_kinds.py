"""Every kind of event: what tells of it, with what data, and that the table of kinds is true."""

from __future__ import annotations

import json
import threading
from typing import Any

import pytest

from actr3d.actr import ACTR, Buffer, Memory, Model
from actr3d.actr.changes import Parts
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text, run_text
from actr3d.change import CHANGES
from actr3d.cli import event_line
from actr3d.errors import ParameterError
from actr3d.experiment.aperture import Passage
from actr3d.trace import Trace, TraceEvent
from actr3d.trace_kinds import KINDS, LEVELS
from tests.helpers.commands import run_command
from tests.helpers.motor_bodies import moving
from tests.helpers.vision_scenes import seeing_for
from tests.helpers.walkers import driving

EVERYTHING = """
from actr3d.actr import *

class Lamp:
    colour = 'red'

class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    compiling = PMCompile(keep='goal', request='memory.request', retrieve='retrieval')
    learning = PMNew()
    lamp = Lamp()
    def facts():
        memory.add('capital Canada Ottawa')
        memory.add('capital Canada Ottawa', time=5)
    def init():
        goal.set('ask Canada')
    def ask(goal='ask ?country', lamp='colour:red'):
        memory.request('capital ?country ?')
        goal.set('wait ?country')
    def answer(goal='wait ?country', retrieval='capital ?country ?city'):
        goal.set('think')
        self.reward(1)
    def think(goal='think'):
        goal.clear()

from actr3d.sgoms import SGOMS, Ordered

class Planner(SGOMS):
    plan = Ordered('task')
    def init():
        b_plan_unit.set('planning_unit:plan')
    def begin(b_unit_task='unit_task:task state:start'):
        b_method.set('method:press')
        b_operator.set('operator:push')
        b_unit_task.modify(state='finished')

class World(Model):
    def start(self):
        yield 0.12
        self.agent.goal.set('other')   # a production was chosen that no longer matches
        self.ball = Model(x=1)
        self.ball.parent = None
        self.agent.memory.clear()
"""


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> list[TraceEvent]:
    """Returns the events of a run in which everything happens that can be traced."""
    module: Any = load_text(EVERYTHING, "everything.py")
    world = module.World()
    world.agent = module.Agent()
    world.planner = module.Planner()
    trace = world.traced()
    world.run(2)
    trace.command("pause", {"why": "lunch"})
    changed = module.Agent()
    by_hand = changed.traced()
    changed.run(0.02)
    CHANGES["forbid_once"]("top", "ask").carry_out(Parts([changed]))  # pyright: ignore[reportCallIssue] # a dataclass
    changed.run(0.1)
    file = tmp_path_factory.mktemp("model") / "everything.py"
    file.write_text(EVERYTHING + "\nAgent().run(1)\nprint('seen')\n", encoding="utf-8")
    done = run_command("run", str(file), "--json", "--seed", "1")
    printed = [TraceEvent(0, line["source"], line["kind"], line["data"]) for line in map(json.loads, done.stdout.splitlines())]
    simulation = driving("all")
    simulation.measure(Passage("walker"))
    simulation.run(0.1)
    simulation.conclude()
    mover, motor = moving(trace="all")
    motor.rotate_torso(2)
    motor.rotate_torso(1)
    mover.step(5)
    return [*trace, *by_hand, *printed, *(simulation.trace or ()), *(mover.trace or ()), *seeing_for(0.2)]


def test_every_kind_is_emitted_and_no_other(recorded: list[TraceEvent]) -> None:
    assert {event.kind for event in recorded} == set(KINDS)


def test_the_data_of_every_kind_are_those_of_the_table(recorded: list[TraceEvent]) -> None:
    for event in recorded:
        named, _, rest = KINDS[event.kind].data.partition("[")
        if named != "...":
            needed, allowed = set(named.split()), set(rest.rstrip("]").split())
            assert needed <= event.data.keys() <= needed | allowed, event


@pytest.mark.parametrize("level", LEVELS)
def test_a_level_holds_the_kinds_of_the_table(level: str) -> None:
    module: Any = load_text(EVERYTHING, "everything.py")
    found: dict[str, list[tuple[str, str]]] = {}
    for wanted in (level, "all"):
        world = module.World()
        world.agent = module.Agent()
        world.planner = module.Planner()
        with RunLimits(seed=1):
            trace = world.traced(wanted)
        world.run(2)
        found[wanted] = [(event.source, event.kind) for event in trace]
    rank = LEVELS.index(level)
    assert found[level] == [(source, kind) for source, kind in found["all"] if LEVELS.index(KINDS[kind].level) <= rank]


# -- memory


def remembering() -> tuple[Any, Trace]:
    agent: Any = ACTR()
    agent.retrieval = Buffer()
    agent.memory = Memory(agent.retrieval)
    return agent, agent.traced()


def test_chunks_that_enter_a_memory_are_traced() -> None:
    agent, trace = remembering()
    agent.memory.add("a 1")
    agent.run(0.5)
    agent.memory.add({"a": 1.5})
    agent.memory.add("a 1")
    told = [(e.time, e.source, e.data["chunk"], e.data["merged"], e.data["size"]) for e in trace.select("add")]
    assert told == [
        (0.0, "memory", {"0": "a", "1": "1"}, False, 1),
        (0.5, "memory", {"a": 1.5}, False, 2),
        (0.5, "memory", {"0": "a", "1": "1"}, True, 2),
    ]


def test_the_way_a_fact_is_given_is_traced() -> None:
    module: Any = load_text(
        "from actr3d.actr import *\nclass A(ACTR):\n    b = Buffer()\n    m = Memory(b)\n    l = DMBaseLevel(m)\n    def init():\n"
        "        m.add('x', time=3)\n"
    )
    agent = module.A()
    trace = agent.traced()
    agent.run(1)
    assert trace.select("add")[0].data["given"] == {"time": 3}
    assert trace.select("initialize")[0].data == {"method": "init"}


def test_chunks_removed_or_added_by_hand_are_traced() -> None:
    agent, trace = remembering()
    for word in "abcd":
        agent.memory.add(word)
    agent.memory.dm.remove(agent.memory.dm[0])
    del agent.memory.dm[0]
    agent.memory.dm.reverse()
    agent.memory.dm = agent.memory.dm[:1]
    agent.memory.dm.append(agent.memory.dm[0].copy())
    agent.memory.clear()
    told = [tuple(event.data.values()) for event in trace.select("chunks")]
    assert told == [
        ("remove", 3, ["a"], []),
        ("delitem", 2, ["b"], []),
        ("reverse", 2, [], []),
        ("dm", 1, ["c"], []),
        ("append", 2, [], ["d"]),
        ("clear", 0, ["d", "d"], []),
    ]


def test_a_memory_with_its_own_chunk_list_is_traced_too() -> None:
    module: Any = load_text(EVERYTHING, "everything.py")
    agent = module.Agent()
    trace = agent.traced()
    agent.run(0.01)
    agent.memory.dm.pop()
    assert [event.data["gone"] for event in trace.select("chunks", "memory")] == [["capital Canada Ottawa"]]


# -- runs


def test_runs_are_traced_with_their_limit_and_end() -> None:
    model: Any = Model()
    trace = model.traced()
    model.run(0.5)
    model.run()

    def busy() -> Any:
        while True:
            yield 0.1
            if model.now() > 1:
                model.stop()

    model.sch.add(busy)
    model.run()

    def fail() -> None:
        raise KeyError("x")

    model.sch.add(fail)
    with pytest.raises(KeyError):
        model.run(1)
    told = [(event.time, event.kind, *event.data.values()) for event in trace if event.kind in ("run", "stop")]
    assert told == [
        (0.0, "run", 0.5),
        (0.5, "stop", "limit"),
        (0.5, "run", None),
        (0.5, "stop", "done"),
        (0.5, "run", None),
        (1.1, "stop", "stop"),
        (1.1, "run", 1),
        (1.1, "stop", "error", "KeyError"),
    ]


def test_the_end_of_the_program_is_traced() -> None:
    trace = Trace()
    run_text("from actr3d.actr import *\nm = Model()\nwhile True: m.run(0.3)", limits=RunLimits(until=0.5, trace=trace))
    assert [(event.time, event.data["by"]) for event in trace.select("stop")] == [(0.3, "limit"), (0.5, "until"), (0.5, "until")]


# -- the tree


def test_parts_that_are_added_or_removed_are_traced() -> None:
    world: Any = Model()
    trace = world.traced()
    agent: Any = ACTR()
    world.agent = agent
    agent.goal = Buffer()
    agent.goal.set("a")
    world.ball = Model(x=1)
    world.ball = Model(x=2)
    agent.parent = None
    agent.goal.set("b")
    told = [(event.kind, event.source, event.data) for event in trace if event.kind in ("added", "removed", "buffer")]
    assert told == [
        ("added", "top", {"part": "agent", "model": "ACTR"}),
        ("added", "agent", {"part": "goal", "model": "Buffer"}),
        ("buffer", "agent.goal", {"chunk": None}),
        ("buffer", "agent.goal", {"chunk": {"0": "a"}}),
        ("added", "top", {"part": "ball", "model": "Model"}),
        ("removed", "top", {"part": "ball", "model": "Model"}),
        ("added", "top", {"part": "ball", "model": "Model"}),
        ("removed", "top", {"part": "agent", "model": "ACTR"}),
        ("buffer", "agent.goal", {"chunk": {"0": "b"}}),  # what has left is still told apart from the top model
    ]
    assert [event.data for event in trace.select("state", "ball")] == [{"x": 1}, {"x": 2}]


def test_the_productions_of_an_agent_are_named() -> None:
    module: Any = load_text(EVERYTHING, "everything.py")
    trace = module.Agent().traced()
    (told,) = [event.data for event in trace.select("productions")]
    assert told["productions"] == ["answer", "ask", "think"]
    assert told["initializers"] == ["facts", "init"]


# -- commands


def test_a_command_is_recorded_with_its_time_and_shown() -> None:
    model: Any = Model()
    trace = model.traced("production")
    model.run(1.25)
    width = [0.8]
    trace.command("resize", {"aperture": width})
    width.append(0.9)
    event = list(trace)[-1]
    assert (event.time, event.source, event.kind) == (1.25, "top", "command")
    assert event.data == {"command": "resize", "data": {"aperture": [0.8]}}
    assert event_line(event).split() == ["1.250", "top", "command", "command=resize", "data={'aperture':", "[0.8]}"]


def test_a_command_from_another_thread_comes_between_two_events() -> None:
    agent: Any = Model()
    trace = agent.traced()
    seen: list[str] = []

    def obey(event: TraceEvent) -> None:
        if event.kind == "command":
            seen.append(threading.current_thread().name)
            agent.stop()

    trace.listen(obey)

    def work() -> Any:
        while True:
            yield 0.01
            if agent.now() == 0.05:
                user = threading.Thread(target=lambda: agent.sch.add(trace.command, args=("pause",), thread_safe=True))
                user.start()
                user.join()
                assert not trace.select("command")

    agent.sch.add(work)
    agent.run(1000)
    assert seen == [threading.current_thread().name]
    assert trace.select("command")[0].time == agent.now() == 0.05
    assert trace.select("stop")[-1].data == {"by": "stop"}


def test_a_command_to_a_run_that_is_not_there_is_an_error() -> None:
    with pytest.raises(ParameterError, match=r"no run 1 to send 'pause' to; there are: none"):
        Trace().command("pause")
    model = Model()
    with pytest.raises(ParameterError, match=r"no run 2 to send 'pause' to; there are: 1"):
        model.traced().command("pause", run=2)
