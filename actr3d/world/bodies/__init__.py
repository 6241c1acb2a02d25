"""The bodies that minds can live in, one a file."""

from actr3d.world.bodies.car import Car
from actr3d.world.bodies.imported import ImportedBody
from actr3d.world.bodies.load import Load
from actr3d.world.bodies.mannequin import Mannequin

__all__ = ["Car", "ImportedBody", "Load", "Mannequin"]
