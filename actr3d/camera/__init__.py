"""The Geometric Camera: computes the exact edges of what an eye sees, without pixels and without meanings."""

from actr3d.camera.geometric import GeometricCamera
from actr3d.camera.kernel.dtypes import EXTENT_FIELDS, ExtentField
from actr3d.camera.parameters import CameraParameters
from actr3d.camera.view import View
from actr3d.camera.view_sensor import Sight, Stand, glance, glance_with_geoms, stand_of

__all__ = [
    "EXTENT_FIELDS",
    "CameraParameters",
    "ExtentField",
    "GeometricCamera",
    "Sight",
    "Stand",
    "View",
    "glance",
    "glance_with_geoms",
    "stand_of",
]
