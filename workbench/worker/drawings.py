"""Computes the data of 3D view overlays; only visible overlays of a watched view are computed."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

import numpy as np

from actr3d.camera import CameraParameters, glance, stand_of
from actr3d.simulation import Simulation
from actr3d.world.body import Body
from workbench.worker.contours import contours_of, into_world
from workbench.worker.sightings import told_sightings
from workbench.worker.walked import Walked

NEARER = 0.995
"""Edges are drawn at this fraction of their distance to the eye, so that the surfaces on which they lie do not hide them."""


class Drawings:
    """Computes, by kind and body, the data from which overlays are drawn.

    `frustum`: horizontal and vertical field of view [rad]; `edges`: `lines` in the world as 4-byte floats `(n, 2, 3)` [m] and the
    `labels` of their objects as 8-byte integers; `features`: see `told_sightings`; `path`: positions of the body's root on the floor [m];
    `posture`: commanded joint positions with their index in `qpos`.

    Args:
        simulation: The simulation.
        eyesight: Returns the camera parameters of a body's agent.
        walked: The recorded paths of its bodies.
    """

    def __init__(self, simulation: Simulation, eyesight: Callable[[str], CameraParameters], walked: Walked) -> None:
        self._simulation = simulation
        self._eyesight = eyesight
        self._walked = walked

    def told(self, kinds: Collection[str]) -> dict[str, Any]:
        """Returns the overlay data of these kinds; nothing is computed for other kinds."""
        bodies = self._simulation.world.bodies
        told: dict[str, Any] = {}
        if "frustum" in kinds:
            told["frustum"] = {name: self._fields(name) for name, body in bodies.items() if body.eye is not None}
        if "edges" in kinds:
            told["edges"] = {name: self._edges(name, body) for name, body in bodies.items() if body.eye is not None}
        if "features" in kinds:
            told["features"] = self._features()
        if "path" in kinds:
            told["path"] = self._walked.up_to(self._simulation.ticks, self._simulation.world)
        if "posture" in kinds:
            told["posture"] = {name: _targets(body) for name, body in bodies.items()}
        return told

    def _fields(self, name: str) -> list[float]:
        parameters = self._eyesight(name)
        return [parameters.horizontal_fov, parameters.vertical_fov]

    def _edges(self, name: str, body: Body) -> dict[str, bytes]:
        lines, labels = contours_of(glance(body, self._eyesight(name)))
        places = into_world(NEARER * lines, stand_of(body, body.physics.mj_data))
        return {"lines": places.astype(np.float32).tobytes(), "labels": np.array(labels, dtype=np.int64).tobytes()}

    def _features(self) -> dict[str, Any]:
        minds = self._simulation.minds
        bodies = self._simulation.world.bodies
        return {name: told_sightings(minds[name], body) if name in minds else [] for name, body in bodies.items()}


def _targets(body: Body) -> list[list[float]]:
    """Returns the positions to which joints are moving, as index in `qpos` and position [rad] or [m]."""
    targets = body.motion.targets
    return [[int(joint.q), targets[name][0]] for name, joint in body.joints.items() if name in targets]
