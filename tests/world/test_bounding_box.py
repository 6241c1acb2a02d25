"""Bounding boxes are exact for every shape, in any posture, in any frame."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
import pytest
from mujoco import MjSpec, mjtGeom
from numpy.typing import NDArray

from actr3d.errors import Actr3dError
from actr3d.world import Body, BoundingBox, Floor, Load, Mannequin, Scene, SimpleObject, World
from actr3d.world.anatomy import Anatomy
from tests.helpers.small_agents import near

Points = NDArray[np.float64]

SIZES: dict[Any, list[float]] = {
    mjtGeom.mjGEOM_SPHERE: [0.3, 0, 0],
    mjtGeom.mjGEOM_CAPSULE: [0.1, 0.4, 0],
    mjtGeom.mjGEOM_ELLIPSOID: [0.1, 0.2, 0.5],
    mjtGeom.mjGEOM_CYLINDER: [0.2, 0.4, 0],
    mjtGeom.mjGEOM_BOX: [0.1, 0.2, 0.4],
    mjtGeom.mjGEOM_MESH: [0, 0, 0],
    mjtGeom.mjGEOM_HFIELD: [0, 0, 0],
}
CORNERS = np.array([[0, 0, 0], [0.7, 0.1, 0], [0.1, 0.5, 0.2], [0.2, 0.1, 0.9], [0.3, 0.2, 0.3]])
HEIGHTS = np.array([[0, 0.2, 0.1], [0.5, 1.0, 0.3], [0.0, 0.4, 0.9]])


@dataclass(frozen=True)
class Shape:
    """A free body of one geom."""

    kind: Any
    name: str = "shape"

    def add_to(self, mj_spec: MjSpec) -> None:
        body = mj_spec.worldbody.add_body(name=self.name, pos=[0, 0, 2])
        body.add_freejoint()
        more: dict[str, Any] = {}
        if self.kind == mjtGeom.mjGEOM_MESH:
            mj_spec.add_mesh(name="points", uservert=CORNERS.ravel())
            more["meshname"] = "points"
        if self.kind == mjtGeom.mjGEOM_HFIELD:
            mj_spec.add_hfield(name="hills", nrow=3, ncol=3, size=[1, 0.5, 0.4, 0.1], userdata=HEIGHTS.ravel())
            more["hfieldname"] = "hills"
            body.mass, body.inertia = 1, [1, 1, 1]
            body.explicitinertial = True
        body.add_geom(name="geom", type=self.kind, size=SIZES[self.kind], pos=[0.1, -0.2, 0.3], quat=[0.5, 0.1, 0.7, -0.2], **more)

    def anatomy(self) -> Anatomy:
        return Anatomy(root=self.name, prefix=f"{self.name}_")


def surface(model: Any, data: Any, geom: int) -> Points:
    """Returns points on the surface of a geom (n, 3) in the world's frame, by sampling directions or from its vertices [m]."""
    kind, size = model.geom_type[geom], model.geom_size[geom]
    grid = np.linspace(0, math.pi, 181), np.linspace(0, 2 * math.pi, 361)
    polar, about = (angles.ravel() for angles in np.meshgrid(*grid))
    ball = np.stack([np.sin(polar) * np.cos(about), np.sin(polar) * np.sin(about), np.cos(polar)], axis=1)
    ring = np.stack([np.cos(about), np.sin(about), 0 * about], axis=1)
    ends = [np.array([0, 0, s]) for s in (-1, 1)]
    signs = np.array([[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)])
    match kind:
        case mjtGeom.mjGEOM_SPHERE:
            points = size[0] * ball
        case mjtGeom.mjGEOM_CAPSULE:
            points = np.concatenate([size[0] * ball + size[1] * end for end in ends])
        case mjtGeom.mjGEOM_ELLIPSOID:
            points = size * ball
        case mjtGeom.mjGEOM_CYLINDER:
            points = np.concatenate([size[0] * ring + size[1] * end for end in ends])
        case mjtGeom.mjGEOM_BOX:
            points = size * signs
        case mjtGeom.mjGEOM_MESH:
            points = np.array(model.mesh_vert, dtype=float)
        case _:
            x, y, top, base = model.hfield_size[0]
            heights = np.array(model.hfield_data, dtype=float).reshape(3, 3) * top
            points = np.array([[x * (c - 1), y * (r - 1), heights[r, c]] for r in range(3) for c in range(3)])
            points = np.concatenate([points, signs[signs[:, 2] < 0] * [x, y, base]])
    return points @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]


def tightly_holds(box: BoundingBox, points: Points) -> None:
    """Checks that points, no farther apart than a degree, are all in the box and reach its sides."""
    lower, upper = points.min(axis=0), points.max(axis=0)
    assert (np.array(box.lower) <= lower + 1e-9).all()
    assert (np.array(box.upper) >= upper - 1e-9).all()
    assert np.array(box.lower) == near(lower, abs=1.5e-4)
    assert np.array(box.upper) == near(upper, abs=1.5e-4)


@pytest.mark.parametrize("kind", SIZES)
@pytest.mark.parametrize("seed", range(5))
def test_every_shape_is_held_tightly(kind: Any, seed: int) -> None:
    world = World(Scene(parts=(Shape(kind),)))
    turn = np.random.default_rng(seed).normal(size=4)
    world.mj_data.qpos[3:7] = turn / np.linalg.norm(turn)
    world.changed()
    box = world.bodies["shape"].bounding_box()
    tightly_holds(box, surface(world.mj_model, world.mj_data, 0))


def posed(seed: int, load: Load | None) -> tuple[World, Body]:
    """Returns a mannequin in a random posture, place and heading."""
    world = World(Scene(parts=(Floor(), Mannequin(name="walker", load=load))))
    random = np.random.default_rng(seed)
    body = world.bodies["walker"]
    for joint in body.joints.values():
        joint.put(random.uniform(joint.lower, joint.upper))
    world.mj_data.qpos[:3] = random.uniform(-3, 3, 3)
    world.changed()
    return world, body


@pytest.mark.daily(1)
@pytest.mark.parametrize("load", [None, Load(size=(2.2, 0.04)), Load(shape="box", size=(0.3, 0.5, 0.4))])
@pytest.mark.parametrize("seed", range(2))
def test_a_mannequin_and_its_load_are_held_tightly_in_any_posture_and_frame(seed: int, load: Load | None) -> None:
    world, body = posed(seed, load)
    world.refresh()
    points = np.concatenate([surface(world.mj_model, world.mj_data, int(geom)) for geom in body.geoms])
    tightly_holds(body.bounding_box("world"), points)
    data = world.mj_data
    c, s = math.cos(body.get("pose").heading), math.sin(body.get("pose").heading)
    frames = {
        "body": (data.body("walker").xpos, np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])),
        "torso": (data.body("walker_torso").xpos, data.body("walker_torso").xmat.reshape(3, 3)),
        "eye": (data.site("walker_eye").xpos, data.site("walker_eye").xmat.reshape(3, 3)),
    }
    for name, (origin, axes) in frames.items():
        tightly_holds(body.bounding_box(name), (points - origin) @ axes)


def test_a_held_object_is_in_the_box() -> None:
    cup = SimpleObject(name="cup", size=(0.06, 0.06, 0.3), position=(0.0, -0.26, 0.7), mass=0.2)
    world = World(Scene(parts=(Mannequin(name="walker"), cup)))
    body = world.bodies["walker"]
    body.set("grasp", "cup")
    assert body.bounding_box().lower[1] == near(-0.29, abs=1e-6)
    body.set("release")
    assert body.bounding_box().lower[1] == near(-0.222, abs=1e-6)


def test_a_resized_geom_is_seen() -> None:
    world = World(Scene(parts=(Shape(mjtGeom.mjGEOM_SPHERE),)))
    body = world.bodies["shape"]
    assert body.bounding_box().size == near((0.6, 0.6, 0.6))
    world.mj_model.geom_size[0, 0] = 0.4
    assert body.bounding_box().size == near((0.8, 0.8, 0.8))


def test_reading_changes_nothing() -> None:
    (asked, body), (unasked, _) = posed(1, None), posed(1, None)
    for _ in range(20):
        body.bounding_box()
        asked.step(5)
        unasked.step(5)
    assert asked.state().mj_state.tobytes() == unasked.state().mj_state.tobytes()


def test_unknown_frames_are_refused_with_a_reason() -> None:
    _, body = posed(0, None)
    with pytest.raises(Actr3dError, match="walker: no frame, part or site 'tors'; did you mean 'torso'"):
        body.bounding_box("tors")


def test_mujoco_agrees_on_the_sampled_shapes() -> None:
    """The sampled surfaces are those that rays hit: the oracle does not depend on an interpretation of MuJoCo's sizes."""
    for kind in (mjtGeom.mjGEOM_CAPSULE, mjtGeom.mjGEOM_CYLINDER, mjtGeom.mjGEOM_HFIELD, mjtGeom.mjGEOM_MESH):
        world = World(Scene(parts=(Shape(kind),)))
        world.refresh()
        points = surface(world.mj_model, world.mj_data, 0)
        for axis in range(3):
            far, hit = points[points[:, axis].argmax()], np.zeros(1, dtype=np.int32)
            start, way = far.copy(), np.zeros(3)
            inward = (points.mean(axis=0) - far) * 1e-3
            start[axis] += 1.0
            way[axis] = -1.0
            distance = mujoco.mj_ray(world.mj_model, world.mj_data, start + inward, way, None, 1, -1, hit)
            assert distance == near(1.0, abs=5e-3), (kind, axis)


def test_the_box_in_another_posture_is_that_of_a_body_in_it_and_changes_nothing() -> None:
    world, body = posed(0, Load(size=(1.2, 0.04)))
    (other, turned), joints = posed(1, Load(size=(1.2, 0.04))), [*body.joints.values()]
    positions = {joint.name: turned.joints[joint.name].position for joint in joints}
    before = world.state().mj_state.tobytes()
    there = body.bounding_box("body", positions)
    assert world.state().mj_state.tobytes() == before
    assert there.size == near(turned.bounding_box("body").size, abs=1e-9)
    assert body.get("size_in", positions).width == near(there.width)
    assert other.state().mj_state.tobytes() != before
    with pytest.raises(Actr3dError, match="tors"):
        body.bounding_box("body", {"tors": 0.1})
    with pytest.raises(Actr3dError, match="positions by joint"):
        body.get("size_in", 3)
