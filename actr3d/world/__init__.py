"""The physical side: scenes, bodies, sensors, actuators. The only place that compiles a MuJoCo model."""

from actr3d.world import actuators, changes, sensors
from actr3d.world.anatomy import BODY_KINDS, NamedMovement
from actr3d.world.bodies import Car, ImportedBody, Load, Mannequin
from actr3d.world.body import Body, BodyState, actuator, sensor
from actr3d.world.bounding_box import BoundingBox
from actr3d.world.gait import Gait
from actr3d.world.imported import Imported
from actr3d.world.mesh import Mesh
from actr3d.world.scene import Scene
from actr3d.world.scene_objects import Aperture, Floor, SimpleObject, Track, Wall
from actr3d.world.world import World, WorldState

__all__ = [
    "Aperture",
    "Body",
    "BodyState",
    "BoundingBox",
    "Car",
    "Floor",
    "Gait",
    "Imported",
    "ImportedBody",
    "Load",
    "Mannequin",
    "Mesh",
    "NamedMovement",
    "Scene",
    "SimpleObject",
    "Track",
    "Wall",
    "World",
    "WorldState",
    "actuator",
    "actuators",
    "changes",
    "sensor",
    "sensors",
]

globals().update(BODY_KINDS)  # those above are imported by name for type checkers and readers
__all__ += [name for name in BODY_KINDS if name not in __all__]  # pyright: ignore[reportUnsupportedDunderAll]
