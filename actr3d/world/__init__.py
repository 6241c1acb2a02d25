"""The physical side: scenes, bodies, sensors, actuators. The only place that compiles a MuJoCo model."""

from actr3d.world.imported import Imported
from actr3d.world.mesh import Mesh
from actr3d.world.parts import Aperture, Floor, Loose, Track, Wall
from actr3d.world.scene import Scene
from actr3d.world.world import World, WorldState

__all__ = ["Aperture", "Floor", "Imported", "Loose", "Mesh", "Scene", "Track", "Wall", "World", "WorldState"]
