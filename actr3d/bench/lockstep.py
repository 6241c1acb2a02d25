"""`actr3d bench lockstep`: measures the cost of lockstep, vision and recording relative to the bare physics of the same scene on the
same states; and the cost of a view, as in `actr3d bench camera`.

All times of lockstep are processor time of all threads: a recording has a thread of its own, and its cost must be included.
"""

from __future__ import annotations

import gc
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import mujoco

from actr3d.actr.loading import load_text
from actr3d.bench import camera
from actr3d.benchmark import Measurement, benchmark, processor_time_of
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Mannequin, Scene, SimpleObject, WorldState

WARM = 200
"""The number of ticks before a measurement."""
TICKS = 2_000
"""The number of ticks per measurement."""
ROUNDS = 9

AGENT = """
from actr3d.actr import *
from actr3d.simulation import BodyPort

class Agent(ACTR):
    goal = Buffer()
    felt = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    body = BodyPort(felt)
    def init():
        for number in range(20):
            memory.add(f"count {number} {(number + 1) % 20}")
        goal.set("count 0")
        body.request("pose")
    def remember(goal="count ?now", retrieval=None):
        memory.request("count ?now ?next")
    def go_on(goal="count ?now", retrieval="count ?now ?next", felt="pose x:?x"):
        goal.set("count ?next")
        retrieval.clear()
        body.set("walk", 1.0 if float(x) < 2 else -1.0)
        body.request("pose")
"""
"""Fires a production every 50 ms, every second one with a command to the body and a query; with a retrieval in between."""

SEEING = """
from actr3d.actr import *
from actr3d.simulation import BodyPort

class Agent(ACTR):
    goal = Buffer()
    seen = Buffer()
    body = BodyPort(seen)
    def init():
        goal.set("look")
        body.set("walk", 1.3)
    def look(goal="look"):
        body.request("view")
        goal.set("judge")
    def judge(goal="judge", seen="view"):
        view = self.seen.chunk["seen"]
        near = view.extents["d1"].min() if len(view.extents) else 9
        if near < 1.5:
            body.set("posture", {"torso_yaw": 0.6}, speed=2.0)
        goal.set("look")
"""
"""Walks 7 m to a doorway and through it, looking every 100 ms, and turns the trunk when something is near."""
WATCHING = """
from actr3d.actr import *
from actr3d.simulation import BodyPort

class Agent(Model):
    body = BodyPort()
    def start(self):
        self.body.set("walk", 1.3)
        while True:
            reading = self.body.get("view")
            yield reading
            if len(reading.value.extents) and reading.value.extents["d1"].min() < 1.5:
                self.body.set("posture", {"torso_yaw": 0.6}, speed=2.0)
            yield 0.01
"""
"""The same agent, looking at every tick."""
LOOKING = """
from actr3d.actr import *
from actr3d.simulation import BodyPort
from actr3d.vision import Vision

class Watching(ProductionSystem):
    production_time = 0.01
    def watch(vision="watching:False"):
        vision.request("feature:obstacle", radius=1.5, bearing=20, bottom_up=True)

class Agent(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual)
    below = Watching()
    body = BodyPort()
    def init():
        goal.set("look")
        body.set("walk", 1.3)
    def look(goal="look", vision="busy:False"):
        vision.request("feature:opening", width=">0.5", height=">1.5")
        goal.set("see")
    def see(goal="see", vision="busy:False"):
        goal.set("look")
"""
"""The same walk; looks for openings every 100 ms, and for obstacles all the time in between."""
TRIAL = 600
"""The number of ticks in a trial: 6 s for 7.8 m."""


def trial(agent: str = SEEING) -> Simulation:
    """Returns a walker with vision, 7 m in front of a doorway in a furnished room."""
    things = [SimpleObject(name=f"thing{n}", position=(2.0 + n, 2.0 - 4.0 * (n % 2), 0.4), size=(0.4, 0.4, 0.8)) for n in range(4)]
    scene = Scene(parts=(Floor(), Aperture(width=0.9), *things, Mannequin(name="walker")))
    return Simulation(scene, {"walker": load_text(agent, "seeing.py").Agent}, seed=1)


def typical() -> Simulation:
    """Returns an agent without vision, in front of a doorway."""
    scene = Scene(parts=(Floor(), Aperture(), Mannequin(name="walker")))
    return Simulation(scene, {"walker": load_text(AGENT, "agent.py").Agent}, seed=1)


def _cost(make: Callable[[], Simulation], warm: int = WARM, ticks: int = TICKS) -> float:
    """Returns the cost of a tick and its tock [s]."""
    simulation = make()
    simulation.step(warm)
    return processor_time_of(lambda: simulation.step(ticks)) / ticks


def _recorded_cost(make: Callable[[], Simulation]) -> float:
    """Returns the cost of a tick and its tock during recording, including what is still to be written at the end [s]."""
    with tempfile.TemporaryDirectory() as folder:
        simulation = make()
        recording = simulation.record(Path(folder) / "run")
        simulation.step(WARM)

        def work() -> None:
            simulation.step(TICKS)
            recording.close()

        return processor_time_of(work) / TICKS


def _bare_cost(make: Callable[[], Simulation], warm: int = WARM, ticks: int = TICKS) -> float:
    """Returns the cost of MuJoCo alone for a tick, from each state that the same run passes through [s]."""
    simulation = make()
    states: list[WorldState] = []
    simulation.step(warm)
    simulation.observe(lambda seen: states.append(seen.state()))
    simulation.step(ticks)
    world = simulation.world
    steps = round(simulation.period / world.scene.timestep)
    mj_model, mj_data, clock, spent = world.mj_model, world.mj_data, time.process_time, 0.0
    gc.collect()
    gc.disable()
    try:
        for state in states:
            world.restore(state)
            start = clock()
            mujoco.mj_step(mj_model, mj_data, nstep=steps)
            spent += clock() - start
    finally:
        gc.enable()
    return spent / len(states)


@benchmark("lockstep")
def measure() -> list[Measurement]:
    """Measures the cost of lockstep, vision and recording, relative to the bare physics of the same scene on the same states."""
    times = "times the bare physics"
    plain, bare, recorded = _best(typical)
    _cost(trial, 0, 10)  # compiles the camera if necessary
    watching, looking = partial(trial, WATCHING), partial(trial, LOOKING)
    _cost(looking, 0, 20)  # compiles the detectors likewise
    return [
        Measurement(name="tick and tock, no vision", value=plain / bare, sense="at most", limit=3, what=times),
        Measurement(
            name="cognition and lockstep", value=(plain - bare) * 1e6, sense="at most", limit=40, what="us a tick beyond the bare physics"
        ),
        Measurement(name="an aperture trial with vision", value=_seeing(trial), sense="at most", limit=10, what=times),
        Measurement(name="a trial that looks at every tick", value=_seeing(watching), sense="at most", limit=10, what=times),
        Measurement(name="a trial that looks for openings and obstacles", value=_seeing(looking), sense="at most", limit=10, what=times),
        Measurement(name="recording everything", value=recorded / plain, sense="at most", limit=1.5, what="times the unrecorded run"),
        *camera.measure(),
    ]


def _seeing(make: Callable[[], Simulation]) -> float:
    """Returns the cost of a whole trial, in multiples of its bare physics: the best of alternating rounds."""
    rounds = [(_cost(make, 0, TRIAL), _bare_cost(make, 0, TRIAL)) for _ in range(ROUNDS)]
    seeing, walking = (min(costs) for costs in zip(*rounds, strict=True))
    return seeing / walking


def _best(make: Callable[[], Simulation]) -> tuple[float, float, float]:
    """Returns the cost of a tick plain, as bare physics, and recorded [s]: the best of alternating rounds, which is least disturbed."""
    rounds = [(_cost(make), _bare_cost(make), _recorded_cost(make)) for _ in range(ROUNDS)]
    plain, bare, recorded = (min(costs) for costs in zip(*rounds, strict=True))
    return plain, bare, recorded
