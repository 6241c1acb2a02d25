"""Walkers with agents, for the tests of lockstep."""

from __future__ import annotations

import hashlib
from typing import Any
from weakref import WeakKeyDictionary

from actr3d.actr.loading import load_text
from actr3d.simulation import Simulation
from actr3d.trace import Trace
from actr3d.world import Aperture, Floor, Mannequin, Scene

DRIVER = """
from actr3d.actr import *
from actr3d.simulation import BodyPort

class Driver(ACTR):
    goal = Buffer()
    seen = Buffer()
    body = BodyPort(seen)
    looks = 0

    def init():
        goal.set("go")

    def go(goal="go"):
        body.set("walk", 0.5)
        body.request("pose", noise=0.05)
        goal.set("look")

    def look(goal="look", seen="pose x:?x", body="busy:False"):
        self.looks += 1
        body.set("walk", self.random.choice([-0.5, 0.25, 1.0]) - 0.01 * float(x), turn=0.1)
        body.set("position", "head_yaw", 0.3 * self.random.random())
        body.request("pose", noise=0.05)
"""
"""Walks, reads its pose repeatedly, and changes its direction at random."""

Driver: Any = load_text(DRIVER, "driver.py").Driver


STRUCK = """from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Floor, Mannequin, Scene, Wall

class Walker(ACTR):
    goal = Buffer()
    felt = Buffer()
    skin = BodyPort(felt)

    def init():
        goal.set("aside")
        skin.set("waypoint", 3, 1.5, 1.2)

    def ask(goal="aside", felt=None, skin="busy:False"):
        skin.request("pose")

    def look(goal="aside", felt="pose x:?x"):
        felt.clear()
        if float(x) > 2.8:
            goal.set("on")
            skin.set("waypoint", 6, 0, 1.2)

    def go_on(goal="on"):
        goal.set("on")

def build() -> Simulation:
    wall = Wall(name="block", start=(3.0, -1.2), end=(3.0, 1.2), height=1.2)
    return Simulation(Scene(parts=(Floor(), wall, Mannequin(name="walker"))), {"walker": Walker}, seed=1)
"""
"""It grazes the end of a wall: each touch is over before its tick ends."""


def scene_of(*names: str, timestep: float = 0.002) -> Scene:
    """Returns a scene with a doorway and mannequins side by side, the first in front of the gap."""
    walkers = [Mannequin(name=name, position=(0.0, float(number))) for number, name in enumerate(names)]
    return Scene(parts=(Floor(), Aperture(position=(3.0, 0.0)), *walkers), timestep=timestep)


def driving(trace: str = "none", seed: int = 1) -> Simulation:
    """Returns a simulation of two mannequins with agents."""
    return Simulation(scene_of("walker", "other"), {"walker": Driver, "other": Driver}, seed=seed, trace=trace)


_hashed: WeakKeyDictionary[Simulation, tuple[Trace, int, bytes]] = WeakKeyDictionary()
"""The trace of each simulation, how many of its events are known, and a hash of these: tests ask after each tick."""


def digest(simulation: Simulation) -> str:
    """Returns a hash of the present state, with what bodies are about to do, and of the whole trace."""
    events, trace = b"", simulation.trace
    if trace is not None:
        of, count, known = _hashed.get(simulation, (trace, 0, b""))
        count, events = (count, known) if of is trace else (0, b"")
        for event in trace.since(count):
            events = hashlib.sha256(events + event.to_json().encode()).digest()
        _hashed[simulation] = trace, len(trace), events
    state = simulation.world.state()
    return hashlib.sha256(state.mj_state.tobytes() + repr(state.bodies).encode() + events).hexdigest()
