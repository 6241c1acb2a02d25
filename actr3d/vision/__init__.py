"""Vision: the features that an agent notices; detectors, salience, search."""

from actr3d.vision.detectors import DETECTORS, Detector, Obstacle, Opening, detector
from actr3d.vision.encoding import Emma
from actr3d.vision.feature import Feature
from actr3d.vision.feature_snapshot import Sighting, sightings, visions
from actr3d.vision.module import Vision
from actr3d.vision.units import Label, Metres, MetresPerSecond, Radians, Seconds

__all__ = [
    "DETECTORS",
    "Detector",
    "Emma",
    "Feature",
    "Label",
    "Metres",
    "MetresPerSecond",
    "Obstacle",
    "Opening",
    "Radians",
    "Seconds",
    "Sighting",
    "Vision",
    "detector",
    "sightings",
    "visions",
]
