"""What a worker tells for overlays of the 3D view: only what is switched on where somebody looks is computed."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData

from actr3d.camera import CameraParameters, Sight, glance, stand_of
from actr3d.clock import microseconds
from actr3d.simulation import Simulation
from actr3d.vision import visions
from actr3d.world.body import Body
from workbench.curves import INTEGRATION
from workbench.worker.contours import contours_of, into_world
from workbench.worker.past import Past
from workbench.worker.sightings import told_sightings

PATH_STEP = 50_000
"""A path has a point for each so long a time [us]; or fewer, of a long run."""
NEARER = 0.995
"""Edges are drawn by so much nearer to the eye, so that the surfaces on which they lie do not hide them."""
MOST_POINTS = 1_000
"""A path has no more points than about these."""


class Drawings:
    """Tells by kind and body what is drawn of the present.

    `frustum`: the fields of view [rad], across and up; `edges`: lines in the world, as 4-byte numbers `(n, 2, 3)` [m]; `features`: see
    `told_sightings`; `path`: where the body's root was on the floor [m]; `posture`: targets of joints by where they are in `qpos`.

    Args:
        simulation: The run.
        past: What is kept of it.
    """

    def __init__(self, simulation: Simulation, past: Past) -> None:
        self._simulation = simulation
        self._past = past
        self._data = MjData(simulation.world.mj_model)
        self._paths: dict[str, list[tuple[int, float, float]]] = {}

    def told(self, kinds: Collection[str]) -> dict[str, Any]:
        """Returns what is to be drawn of these kinds; of others nothing is computed."""
        bodies = self._simulation.world.bodies
        told: dict[str, Any] = {}
        if "frustum" in kinds:
            told["frustum"] = {name: self._fields(name, body) for name, body in bodies.items() if body.eye is not None}
        if "edges" in kinds:
            told["edges"] = {name: self._edges(name, body) for name, body in bodies.items() if body.eye is not None}
        if "features" in kinds:
            told["features"] = self._features()
        if "path" in kinds:
            told["path"] = self._walked()
        if "posture" in kinds:
            told["posture"] = {name: _targets(body) for name, body in bodies.items()}
        return told

    # -- the eye

    def _parameters(self, name: str, body: Body) -> CameraParameters:
        """Returns how a mind looks: as it has first looked, or as its vision is going to."""
        looked = next((sense.parameters for sense in body.senses if isinstance(sense, Sight)), None)
        mind = self._simulation.minds.get(name)
        own = () if mind is None else visions(mind)
        return looked or next((vision.eyesight for vision in own), CameraParameters())

    def _fields(self, name: str, body: Body) -> list[float]:
        parameters = self._parameters(name, body)
        return [parameters.horizontal_fov, parameters.vertical_fov]

    def _edges(self, name: str, body: Body) -> bytes:
        view = glance(body, self._parameters(name, body))
        return into_world(NEARER * contours_of(view), stand_of(body, body.world.mj_data)).astype(np.float32).tobytes()

    def _features(self) -> dict[str, Any]:
        minds = self._simulation.minds
        bodies = self._simulation.world.bodies
        return {name: told_sightings(minds[name], body) if name in minds else [] for name, body in bodies.items()}

    # -- the way

    def _pose(self, state: bytes) -> None:
        model = self._simulation.world.mj_model
        mujoco.mj_setState(model, self._data, np.frombuffer(state), INTEGRATION)
        mujoco.mj_kinematics(model, self._data)

    def _walked(self) -> dict[str, list[list[float]]]:
        """Returns the ways up to the present; what is known of them is kept, and goes on from there."""
        period, now = microseconds(self._simulation.period), self._simulation.ticks
        bodies = self._simulation.world.bodies
        known = next((len(path) for path in self._paths.values()), 0)
        spacing = max(1, PATH_STEP // period, -(-now // MOST_POINTS))
        paths = {name: [point for point in self._paths.get(name, ()) if point[0] < now] for name in bodies}
        if known > 2 * MOST_POINTS:
            paths = {name: path[::2] for name, path in paths.items()}
        first = 1 + max((path[-1][0] for path in paths.values() if path), default=-1)
        for tick, state in self._past.up_to(first, now, spacing):
            self._pose(state)
            for name, body in bodies.items():
                x, y, _ = self._data.xpos[body.root].tolist()
                paths[name].append((tick, x, y))
        self._paths = {name: path if path and path[-1][0] % spacing == 0 else path[:-1] for name, path in paths.items()}
        return {name: [[x, y] for _, x, y in path] for name, path in paths.items()}

    def cut(self, tick: int) -> None:
        """Forgets the ways after a tick."""
        self._paths = {name: [point for point in path if point[0] <= tick] for name, path in self._paths.items()}


def _targets(body: Body) -> list[list[float]]:
    """Returns where joints are commanded to go, and are on their way: places in `qpos`, and positions [rad] or [m]."""
    targets = body.running.targets
    return [[int(joint.q), targets[name][0]] for name, joint in body.joints.items() if name in targets]
