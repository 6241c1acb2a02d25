"""The Geometric Camera: computes the exact edges of what an eye sees, without pixels and without meanings."""

from actr3d.camera.geometric import GeometricCamera
from actr3d.camera.kernel.dtypes import EXTENT_FIELDS, ExtentField
from actr3d.camera.parameters import CameraParameters
from actr3d.camera.view import View
from actr3d.camera.view_sensor import EyePose, EyeSense, eye_pose_of, view_and_geoms_for_observer, view_for_observer

__all__ = [
    "EXTENT_FIELDS",
    "CameraParameters",
    "ExtentField",
    "EyePose",
    "EyeSense",
    "GeometricCamera",
    "View",
    "eye_pose_of",
    "view_and_geoms_for_observer",
    "view_for_observer",
]
