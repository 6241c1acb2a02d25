"""Detectors: each finds one kind of features in a view; one per file.

A new detector is a function with the decorator `@detector`: in a file of this folder, or in any other module, such as a model's file.
"""

from actr3d.registry import import_modules
from actr3d.vision.detectors.obstacle import Obstacle
from actr3d.vision.detectors.opening import Opening
from actr3d.vision.detectors.registry import DETECTORS, Detector, detector

import_modules(__name__, __path__)

__all__ = ["DETECTORS", "Detector", "Obstacle", "Opening", "detector"]
