"""Agents in grid worlds: what they see and do wakes their productions."""

from typing import Any

import pytest

from actr3d.actr import ACTR, Model
from actr3d.actr.compat.grid import Body, World
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import read_source, run_text
from actr3d.trace import Trace
from tests.helpers.paths import TESTS

VACUUM = TESTS / "worlds" / "vacuum.py"


class Agent(ACTR):
    body = Body()


WATCHER = """
import ccm
from ccm.lib import grid
from ccm.lib.actr import *

class Floor(grid.Cell):
    dirty = False

class Sensor(ccm.ProductionSystem):
    production_time = 0
    dirty = False
    def found(self='dirty:False', body='cell.dirty:True'):
        self.dirty = True

class Robot(ACTR):
    body = grid.Body()
    sensor = Sensor()
    def report(sensor='dirty:True', body='ahead_cell.wall:True'):
        print('dirt at', self.now())
        top.stop()

class Dust(ccm.Model):
    def start(self):
        yield 1.0
        self.parent.grid[0][0].dirty = True
        yield 1.0
        self.parent.agent.body.turn_right(2)

world = grid.World(Floor, map='..')
world.add(Robot(), 0, 0, dir=2)
world.dust = Dust()
world.agent.body.turn_right(4)
world.agent.body.turn_right(4)
world.run()
"""


def test_changed_cells_and_moves_wake_productions(capsys: pytest.CaptureFixture[str]) -> None:
    trace = Trace("all")
    run_text(WATCHER, limits=RunLimits(seed=1, trace=trace))
    assert capsys.readouterr().out == "dirt at 2.05\nend...\n"
    assert [(e.time, e.data) for e in trace.select("state", "cell(0,0)")] == [(1.0, {"dirty": True})]
    assert [e.time for e in trace.select("state", "agent.sensor") if e.data == {"dirty": True}] == [1.0]
    assert len([e for e in trace if e.kind == "start"]) == 1


def test_a_change_wakes_agents_that_are_parts_of_other_models() -> None:
    env, world, agent = Model(), World(width=5, height=5), Agent()
    env.place, env.robot = world, agent  # pyright: ignore[reportAttributeAccessIssue]
    world.add(agent, 1, 1)
    assert agent.parent is env
    woken: list[float] = []

    def watch() -> Any:
        yield agent.changes
        woken.append(env.now())

    env.sch.add(watch)
    env.sch.add(lambda: setattr(world.grid[3][3], "dirty", True), delay=0.5)
    env.run(limit=1)
    assert woken == [0.5]


def vacuum(seed: int, capsys: pytest.CaptureFixture[str]) -> tuple[str, Any]:
    module = run_text(read_source(VACUUM), str(VACUUM), limits=RunLimits(seed=seed, until=2000))
    return capsys.readouterr().out, module


def test_a_vacuum_cleaner_cleans_everything_and_ends(capsys: pytest.CaptureFixture[str]) -> None:
    outputs: list[str] = []
    for seed in (1, 2, 3):
        output, module = vacuum(seed, capsys)
        assert not any(cell.dirty for cell in module.world.cells)
        assert "clean after" in output
        assert module.world.now() < 2000
        assert output == vacuum(seed, capsys)[0]
        outputs.append(output)
    assert len(set(outputs)) == 3
