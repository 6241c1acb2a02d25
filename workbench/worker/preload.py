"""Imports and compiles what models need, in the process from which all workers are forked, so that runs start at once."""

from __future__ import annotations

import actr3d.runner.model_factory  # pyright: ignore[reportUnusedImport] # noqa: F401
from actr3d.camera import glance
from actr3d.world import Floor, Mannequin, Scene, World

world = World(Scene(parts=(Floor(), Mannequin(name="walker"))))
walker = world.bodies["walker"]
# The first view compiles the camera or loads it from its cache; so do the first steps what is computed in every tick.
glance(walker)
walker.get("proprioception")
walker.set("joint", "torso_yaw", 8.0)
world.step(10)
