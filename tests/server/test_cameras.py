"""From where browsers see a scene: all of a passage is in view, and nothing stands before who passes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest
from mujoco import MjData, MjModel

from actr3d.world import Aperture, Floor, Mannequin, Scene, Wall
from actr3d.world.world import World
from workbench.cameras import Cameras
from workbench.overlays.frustum import Frustum

ASPECT = 1.5


class Seen:
    """A browser's camera in a scene, as viser hands it, and the cameras that move it."""

    def __init__(self, *parts: Any) -> None:
        self.world = World(Scene(parts=(Floor(), Mannequin(name="walker"), *parts)))
        self.model: MjModel = self.world.mj_model
        self.data = MjData(self.model)
        mujoco.mj_forward(self.model, self.data)
        self.camera: Any = SimpleNamespace(aspect=ASPECT, fov=1.0, position=np.zeros(3), look_at=np.ones(3), up_direction=np.zeros(3))
        self.client = SimpleNamespace(camera=self.camera)
        server = SimpleNamespace(get_clients=lambda: {0: self.client})
        self.cameras = Cameras(server, self.model, Frustum(server, self.model, {"bodies": {}}))
        self.cameras.place(self.client, self.data)

    def walk(self, x: float) -> None:
        root = self.model.body("walker")
        self.data.qpos[self.model.jnt_qposadr[root.jntadr[0]]] = x
        mujoco.mj_forward(self.model, self.data)
        assert self.data.body("walker").xpos[0] == pytest.approx(x)
        self.cameras.move(self.data)

    def at(self, place: Any) -> tuple[float, float]:
        """Returns where a place is in the picture: from -1 to 1 from the left to the right, and from below to above."""
        camera, upright = self.camera, np.array(self.camera.up_direction)
        forward = (camera.look_at - camera.position) / np.linalg.norm(camera.look_at - camera.position)
        right = np.cross(forward, upright) / np.linalg.norm(np.cross(forward, upright))
        way = np.array(place) - camera.position
        edge = np.tan(camera.fov / 2) * (way @ forward)
        assert edge > 0
        return float(way @ right / edge / ASPECT), float(way @ np.cross(right, forward) / edge)

    def inside(self, place: Any) -> bool:
        return max(abs(part) for part in self.at(place)) < 1

    def plain(self, part: str) -> bool:
        """Tells whether nothing stands before a part of the walker's body."""
        way = self.data.body(part).xipos - self.camera.position
        hit = np.zeros(1, dtype=np.int32)
        mujoco.mj_ray(self.model, self.data, self.camera.position, way, None, 1, -1, hit, None)
        name = self.model.body(self.model.geom_bodyid[hit[0]]).name
        return bool(name.startswith("walker"))


@pytest.mark.parametrize("width", [0.4, 0.8])
def test_walker_and_doorway_are_seen_well_from_the_start_to_behind_it(width: float) -> None:
    seen = Seen(Aperture(width=width))
    corners = [(7.0, side * (2.5 + width / 2), height) for side in (-1, 1) for height in (0.0, 2.5)]
    for x in np.arange(0, 8.5, 0.1):
        seen.walk(float(x))
        assert all(seen.inside(corner) for corner in corners)
        assert seen.inside((x, 0, 0)), x
        assert seen.inside((x, 0, 1.75)), x
        assert seen.plain("walker_torso"), x
        assert seen.plain("walker_head"), x
    seen.walk(0.0)
    assert seen.at((0, 0, 1.75))[1] - seen.at((0, 0, 0))[1] > 0.5  # it is a quarter of the picture high, or more


def test_from_above_there_are_walker_and_doorway() -> None:
    seen = Seen(Aperture(width=0.5, position=(0.0, 7.0), heading=np.pi / 2))  # to the left of who faces along x
    seen.cameras.choose("top", seen.data)
    assert all(seen.inside(place) for place in [(0, 0, 0), (-2.7, 7, 2.5), (2.7, 7, 2.5)])
    assert seen.at((0, 7, 0))[0] > seen.at((0, 0, 0))[0] + 0.5, "what is ahead is to the right"
    before = seen.camera.position.copy()
    seen.walk(1.0)
    assert np.array_equal(seen.camera.position, before)  # still over all of it
    seen.walk(30.0)
    assert seen.inside((30, 0, 1))


def test_what_is_far_away_does_not_make_all_small() -> None:
    alone, far = Seen(), Seen(Wall(name="far", start=(200.0, -100.0), end=(200.0, 100.0)))
    assert np.allclose(alone.camera.position, far.camera.position)
    assert np.linalg.norm(alone.camera.position) < 6
    assert alone.inside((0, 0, 0))
    assert alone.inside((0, 0, 1.75))
