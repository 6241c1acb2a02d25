"""A small body for the tests of lockstep: a box that slides over the floor at the speed it is told."""

from __future__ import annotations

import hashlib
import random
from dataclasses import dataclass
from typing import Any

from actr3d.actr.loading import load_text
from actr3d.errors import WorldError, did_you_mean
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Loose, Scene, World


@dataclass(frozen=True, kw_only=True)
class Place:
    """Where a cart is."""

    x: float
    y: float


class Cart:
    """The body of a loose box: `slide` at a speed, `reach` a place; tells its `place`, and a `guess` of it with noise."""

    def __init__(self, world: World, name: str) -> None:
        self._data, self.name = world.mj_data, name
        self._joint: Any = world.mj_data.joint(name)
        self._speed: float | None = None
        self._target: float | None = None
        self._noise = random.Random(name)
        self.answered = 0

    def set(self, word: str, *values: Any, **named: Any) -> None:
        if word not in ("slide", "reach", "stop"):
            raise WorldError(f"body '{self.name}' cannot '{word}'{did_you_mean(word, ('slide', 'reach', 'stop'))}")
        self._target = values[0] if word == "reach" else None
        self._speed = named.get("speed", 1.0) if word == "reach" else values[0] if word == "slide" else None
        if word == "stop":
            self._joint.qvel[0] = 0.0

    def get(self, word: str, **options: Any) -> Any:
        self.answered += 1
        x, y, *_ = (float(value) for value in self._joint.qpos)
        match word:
            case "place":
                return Place(x=x, y=y)
            case "guess":
                return x + self._noise.gauss(0.0, options.get("sd", 0.1))
            case "both":
                return x, y
            case "nothing":
                return None
            case _:
                raise WorldError(f"body '{self.name}' has no sense '{word}'")

    def before_step(self, period: float) -> None:
        if self._speed is not None:
            left = None if self._target is None else (self._target - float(self._joint.qpos[0])) / period
            self._joint.qvel[0] = self._speed if left is None else max(-self._speed, min(self._speed, left))

    def state(self) -> Any:
        return self._speed, self._target, self._noise.getstate()

    def restore(self, state: Any) -> None:
        self._speed, self._target, noise = state
        self._noise.setstate(noise)


def world_of(*names: str, timestep: float = 0.002) -> World:
    """Returns a world with a doorway and carts side by side."""
    boxes = [Loose(name=name, position=(0.0, float(number), 0.16)) for number, name in enumerate(names)]
    world = World(Scene(parts=(Floor(), Aperture(position=(3.0, 0.0)), *boxes), timestep=timestep))
    world.bodies = {name: Cart(world, name) for name in names}
    return world


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
        body.set("slide", 0.5)
        body.request("guess", sd=0.05)
        goal.set("look")

    def look(goal="look", seen="guess ?x", body="busy:False"):
        self.looks += 1
        body.set("slide", self.random.choice([-0.5, 0.25, 1.0]) - 0.01 * float(x))
        body.request("guess", sd=0.05)
"""
"""Slides, and looks where it is again and again; goes another way at random."""

Driver: Any = load_text(DRIVER, "driver.py").Driver


def driving(trace: str = "none", seed: int = 1) -> Simulation:
    """Returns a simulation of two carts with minds."""
    return Simulation(world_of("cart", "other"), {"cart": Driver, "other": Driver}, seed=seed, trace=trace)


def digest(simulation: Simulation) -> str:
    """Returns a hash of the present state and of the whole trace."""
    lines = [] if simulation.trace is None else [event.to_json() for event in simulation.trace]
    return hashlib.sha256(simulation.world.state().mj_state.tobytes() + "\n".join(lines).encode()).hexdigest()
