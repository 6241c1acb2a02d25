"""Planning units in agents with bodies: with seek, recordings and replay, and the numbers of ACT-R 7."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from actr3d.actr.loading import load_text
from actr3d.simulation import Simulation
from tests.helpers.commands import run_command
from tests.helpers.sgoms_agents import HEAD, cooking
from tests.helpers.walkers import digest, scene_of

WALKER = """
from actr3d.actr import *
from actr3d.sgoms import SGOMS, Ordered, Situated
from actr3d.simulation import BodyPort

class Feet(ProductionSystem):
    production_time = 0.01
    def feel(b_felt=None, feet="busy:False"):
        feet.request("pose")
    def far(b_felt="pose x:?x"):
        if float(x) > 0.2 and not self.warned:
            self.warned = True
            b_interrupt.set("planning_unit:halt when:now")
        b_felt.clear()
    warned = False

class Walker(SGOMS):
    DM = Memory(SGOMS.b_DM, threshold=-5)
    noise = DMNoise(DM, noise=0.5)
    b_felt = Buffer()
    feet = BodyPort(b_felt)
    watch = Feet()
    route = Ordered("ahead", "turn", "on")
    halt = Situated(stand="way:long", until="way:short")

    def init():
        b_context.set("way:long")
        b_plan_unit.set("planning_unit:route")
    def start(b_unit_task="unit_task:?task state:start"):
        feet.set("walk", 0.0 if task == "stand" else 0.8, turn=0.5 if task == "turn" else 0.0)
        b_method.set(f"method:{task} steps:{self.random.randrange(4, 12)}")
        b_unit_task.modify(state="running")
    def step(b_method="steps:?n!0"):
        b_method.modify(steps=int(n) - 1)
    def stop(b_unit_task="unit_task:?task state:running", b_method="steps:0"):
        if task == "stand":
            b_context.set("way:short")
        b_unit_task.modify(state="finished")
"""
FILE = """
from dataclasses import dataclass
from actr3d.configuration import Configuration
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene

@dataclass(frozen=True, kw_only=True)
class Parameters(Configuration):
    "What may be set."

def build(parameters: Parameters) -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker})
"""


def walking() -> Simulation:
    module: Any = load_text(WALKER, "walking.py")
    return Simulation(scene_of("walker"), {"walker": module.Walker}, seed=3, trace="all")


@pytest.mark.slow
def test_a_seek_into_an_interruption_is_exact_and_so_is_the_run_from_there() -> None:
    simulation = walking()
    simulation.run(5)
    assert simulation.trace is not None
    events = [(event.data["what"], event.data["path"]) for event in simulation.trace if event.kind == "planning_unit"]
    assert events == [
        ("begun", "route"),
        ("interrupted", "route"),
        ("begun", "halt"),
        ("ended", "halt"),
        ("resumed", "route"),
        ("ended", "route"),
    ]
    left = next(event.time for event in simulation.trace if event.data.get("what") == "interrupted")
    back = next(event.time for event in simulation.trace if event.data.get("what") == "resumed")
    first = [round(moment * 100) for moment in (back - 0.01, left + 0.1, 0.0, back, left)]
    wanted = {tick + later for tick in first for later in range(20)}
    digests: dict[int, str] = {}
    again = walking()
    while again.ticks <= max(wanted):
        if again.ticks in wanted:
            digests[again.ticks] = digest(again)
        again.step()
    for tick in first:
        simulation.seek(tick / 100)
        assert digest(simulation) == digests[tick]
        for later in range(tick + 1, tick + 20):
            simulation.step()
            assert digest(simulation) == digests[later]


@pytest.mark.daily(1)
@pytest.mark.parametrize("kind", ["without a body", "with a body"])
def test_a_recording_is_replayed_byte_for_byte(kind: str, tmp_path: Path) -> None:
    text = f"{HEAD}class Agent(Base):\n    DM = Memory(SGOMS.b_DM)\nworld = World()\nworld.agent = Agent()\n"
    text += "world.bell = later(0.22, 'planning_unit:phone when:now')\nworld.run(5)\nprint(said)\n"
    if kind == "with a body":
        text = WALKER + FILE
    file, recording = tmp_path / "model.py", tmp_path / "run.actr3d"
    file.write_text(text, encoding="utf-8")
    for words in (["run", str(file), "--seed", "5", "--until", "3", "--record", str(recording)], ["replay", str(recording)]):
        done = run_command(*words)
        assert done.returncode == 0, done.stderr


def test_under_act_r_7_harvested_chunks_do_not_change_the_order() -> None:
    body = 'class Agent(Base):\n    profile = "act-r-7"\n    DM = Memory(SGOMS.b_DM, latency=0.05)'
    module = cooking(body, 0.3, "planning_unit:phone when:now", 1.0, "planning_unit:alarm when:end")
    assert [task for _, task in module.said] == ["boil", "pick_up", "talk", "run", "boil", "steep", "pour"]
    assert len(module.agent.DM.dm) > 4 + 3 + 2 + 2
