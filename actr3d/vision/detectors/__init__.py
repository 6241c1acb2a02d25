"""Detectors: each finds one kind of features in a view; one a file."""

from actr3d.vision.detectors.obstacle import Obstacle
from actr3d.vision.detectors.opening import Opening
from actr3d.vision.detectors.registry import DETECTORS, Detector, detector

__all__ = ["DETECTORS", "Detector", "Obstacle", "Opening", "detector"]
