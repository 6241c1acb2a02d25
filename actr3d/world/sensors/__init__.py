"""What a body can sense, one word each. All readings are of the present state."""

from actr3d.world.sensors import anatomy, motion, picture, proprioception, ranging, touch
from actr3d.world.sensors.registry import SENSORS

__all__ = ["SENSORS", "anatomy", "motion", "picture", "proprioception", "ranging", "touch"]
