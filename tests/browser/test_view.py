"""The camera of the 3D view, its keys and its labels in a real browser."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Mapping
from io import BytesIO
from itertools import combinations
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from mujoco import MjData, MjModel
from PIL import Image
from playwright.sync_api import Frame, Page, expect

from actr3d.world import Aperture, Floor, Mannequin, Scene, Wall
from actr3d.world.world import World
from tests.helpers.page import PATIENCE, drawn, shows, until
from workbench.scene_framing import SceneFraming

pytestmark = pytest.mark.scene

ASPECT = 1.5
FOV = np.radians(50)


# -- where cameras stand, computed without a picture


class Standing:
    """Where the page places cameras in a scene, and whether they see what they are to see.

    Args:
        page: A page of the workbench, whose modules compute it.
        parts: What stands there beside the floor and a walker.
        covered: What the page covers of the picture, from the right and from the top.
    """

    def __init__(self, page: Page, *parts: Any, covered: tuple[float, float] = (0.0, 0.0)) -> None:
        self.page = page
        self.covered = np.array(covered)
        self.model: MjModel = World(Scene(parts=(Floor(), Mannequin(name="walker"), *parts))).mj_model
        self.data = MjData(self.model)
        mujoco.mj_forward(self.model, self.data)
        self.stage = SceneFraming(self.model).data([])

    def see(self, view: str, x: float = 0.0) -> None:
        """Moves the walker, and the camera of a view that was chosen at the start."""
        root = self.model.body("walker")
        self.data.qpos[self.model.jnt_qposadr[root.jntadr[0]]] = x
        mujoco.mj_forward(self.model, self.data)
        body = self.data.body("walker").xpos.tolist()
        self.told = self.page.evaluate(
            """async ([view, stage, body, aspect, [right, top]]) => {
                const { cameraPose, anchorOf } = await part("scene/stage.js");
                const { plus, minus } = await part("scene/space.js");
                const found = cameraPose(view, stage, stage.start, aspect, { right, top });
                const way = minus(anchorOf(view, stage, body), anchorOf(view, stage, stage.start));
                return { ...found, target: plus(found.target, way) };
            }""",
            [view, self.stage, body, ASPECT, self.covered.tolist()],
        )
        self.back = np.array(self.told["back"], dtype=float)
        self.position = np.array(self.told["target"]) + self.told["distance"] * self.back

    def at(self, place: Any) -> tuple[float, float]:
        """Returns where a place is in the part that is not covered: from -1 to 1 from the left to the right, and from below to above."""
        right = np.cross((0, 0, 1), self.back)
        right /= np.linalg.norm(right)
        way = np.array(place) - self.position
        edge = np.tan(FOV / 2) * (self.told["distance"] if self.told["flat"] else -way @ self.back)
        assert edge > 0
        x, y = np.array((way @ right / edge / ASPECT, way @ np.cross(self.back, right) / edge)) / (1 - self.covered)
        return float(x), float(y)

    def inside(self, place: Any) -> bool:
        return max(abs(part) for part in self.at(place)) < 1

    def plain(self, part: str) -> bool:
        """Tells whether nothing stands before a part of the walker's body."""
        way = self.data.body(part).xipos - self.position
        hit = np.zeros(1, dtype=np.int32)
        mujoco.mj_ray(self.model, self.data, self.position, way, None, 1, -1, hit, None)
        return self.model.body(self.model.geom_bodyid[hit[0]]).name.startswith("walker")


@pytest.mark.daily(1)
@pytest.mark.parametrize("width", [0.4, 0.8])
@pytest.mark.parametrize("view", ["follow", "free"])
@pytest.mark.parametrize("covered", [(0.0, 0.15), (0.0, 0.0), (0.35, 0.15)])
def test_walker_and_doorway_are_seen_well_from_the_start_to_behind_it(
    blank: Page, view: str, width: float, covered: tuple[float, float]
) -> None:
    seen = Standing(blank, Aperture(width=width), covered=covered)
    seen.see(view)
    corners = [(7.0, side * (2.5 + width / 2), height) for side in (-1, 1) for height in (0.0, 2.5)]
    assert all(seen.inside(corner) for corner in corners)
    for x in np.arange(0, 8.25, 0.25):
        seen.see(view, float(x))
        assert seen.inside((x, 0, 0)), x
        assert seen.inside((x, 0, 1.75)), x
        assert seen.plain("walker_torso"), x
        assert seen.plain("walker_head"), x
        assert view == "free" or seen.at((x, 0, 1.75))[1] - seen.at((x, 0, 0))[1] > 0.45  # of 2: about a quarter of the height, or more
        assert view == "free" or seen.at(seen.data.body("walker").xpos + seen.stage["middle"]) == pytest.approx((0, 0), abs=1e-3)


def test_from_above_and_from_the_side_all_is_in_the_picture_and_ahead_is_to_the_right(blank: Page) -> None:
    doorway = Aperture(width=0.5, position=(0.0, 7.0), heading=np.pi / 2)
    seen = Standing(blank, doorway, covered=(0.3, 0.1))  # to the left of a body that faces along x
    for view in ("top", "side"):
        seen.see(view)
        assert seen.told["flat"]
        assert all(seen.inside(place) for place in [(0, 0, 0), (0, 0, 1.75), (-2.7, 7, 2.5), (2.7, 7, 2.5)])
        assert seen.at((0, 7, 0))[0] > seen.at((0, 0, 0))[0] + 0.5
        seen.see(view, 30.0)
        assert seen.inside((30, 0, 1))


def test_from_above_and_from_the_side_the_axes_of_the_world_are_not_turned(blank: Page) -> None:
    seen = Standing(blank, Wall(name="pillar", start=(5.4, 2.0), end=(5.6, 2.0)))  # not straight ahead
    for view in ("top", "side"):
        seen.see(view)
        assert seen.at((5, 0, 0))[1] == pytest.approx(seen.at((0, 0, 0))[1])
        assert seen.at((5, 0, 0))[0] > seen.at((0, 0, 0))[0]
    assert seen.back == pytest.approx((0, -1, 0))


def test_what_is_far_away_does_not_make_all_small(blank: Page) -> None:
    for view in ("follow", "free"):
        alone = Standing(blank)
        alone.see(view)
        far = Standing(blank, Wall(name="far", start=(200.0, -100.0), end=(200.0, 100.0)))
        far.see(view)
        assert np.allclose(alone.position, far.position)
        assert np.linalg.norm(alone.position) < 6
        assert alone.inside((0, 0, 0))
        assert alone.inside((0, 0, 1.75))


# -- where labels stand

PLACED = """async ([wanted, blocked, size]) => {
    const { placed } = await part("scene/captions.js");
    return placed(wanted, blocked, size);
}"""


def overlap(a: Mapping[str, float], b: Mapping[str, float]) -> bool:
    across = a["left"] < b["left"] + b["width"] and b["left"] < a["left"] + a["width"]
    return across and a["top"] < b["top"] + b["height"] and b["top"] < a["top"] + a["height"]


@pytest.mark.slow
def test_labels_never_cover_each_other_or_a_head_or_leave_the_picture(blank: Page) -> None:
    chance, size, found = random.Random(1), {"width": 600, "height": 400}, 0
    for _ in range(40):
        close = chance.choice([5, 50, 300])
        place = [{"x": 300 + chance.uniform(-close, close), "y": 200 + chance.uniform(-close, close)} for _ in range(chance.randint(1, 24))]
        wanted = [{**one, "width": chance.uniform(30, 150), "height": 20} for one in place]
        head = {"left": chance.uniform(200, 350), "top": chance.uniform(100, 250), "width": 60, "height": 60}
        boxes = [box for box in blank.evaluate(PLACED, [wanted, [head], size]) if box is not None]
        assert not any(overlap(one, other) for one, other in combinations([*boxes, head], 2))
        assert all(box["left"] >= 0 and box["top"] >= 0 and box["top"] + box["height"] <= 400 for box in boxes)
        found += len(boxes)
    assert found > 200


def test_a_label_without_room_above_and_below_stands_beside_what_is_there(blank: Page) -> None:
    """As that of a walker in a small view, with its head and another label near it, and the picture of the eye at the right."""
    plan = {"x": 278, "y": 188, "width": 330, "height": 38}
    head, opening, eye, bar = (
        {"left": left, "top": top, "width": width, "height": height}
        for left, top, width, height in ((265, 190, 26, 30), (245, 137, 130, 26), (367, 255, 193, 135), (0, 0, 560, 130))
    )
    size = {"width": 560, "height": 290}
    (box,) = blank.evaluate(PLACED, [[plan], [head, opening, eye, bar], size])
    assert box is not None
    assert box["left"] <= plan["x"] <= box["left"] + plan["width"]
    assert not any(overlap(box, other) for other in (head, opening, eye, bar))


CAPTION = """async (lines) => {
  const { Captions } = await part("scene/captions.js");
  const captions = new Captions();
  captions.layer.style = "position: fixed; inset: 0";
  const camera = { at: ([x, y]) => ({ x, y, depth: 1 }), scaleAt: () => 1 };
  return lines.map((line) => {
    const place = line[0].map((x, n) => (x + line[1][n]) / 2);
    captions.draw([{ text: "opening 50 cm", place, line, chosen: false }], [], camera);
    const [label] = captions.layer.children;
    Object.assign(label.style, { position: "absolute", margin: 0 });
    captions.shown[0].text = "";  // measured as it is now
    captions.draw([{ text: "opening 50 cm", place, line, chosen: false }], [], camera);
    return [label.style.visibility !== "hidden", new DOMMatrix(label.style.transform).f + label.offsetHeight];
  });
}"""
"""Whether labels of measured lines are shown, and where they end [px]; lines are parts of the picture."""


def test_a_label_does_not_cover_the_line_that_was_measured_if_there_is_room(blank: Page) -> None:
    blank.set_viewport_size({"width": 600, "height": 400})
    beside, over = blank.evaluate(CAPTION, [[[0.5, 0.4, 0], [0.5, 0.6, 0]], [[0.5, 0.0, 0], [0.5, 1.0, 0]]])
    assert beside[0]
    assert beside[1] < 0.4 * 400
    assert over[0]  # there is no room beside it


def test_the_retina_pales_colours_with_distance(blank: Page) -> None:
    shades = """async () => {
        const { shadeOf } = await part("eye/drawing.js");
        return [[0, false], [12, false], [99, false], [0, true], [12, true]].map(([distance, dark]) => shadeOf("#64c832", distance, dark));
    }"""
    pale, dark = "rgb(193 233 173)", "rgb(54 94 34)"
    assert blank.evaluate(shades) == ["rgb(100 200 50)", pale, pale, "rgb(100 200 50)", dark]


# -- the picture itself

AT = """() => {
    const { camera, nodeRefFromName } = window.__viserMutable, { shown: now, facts: { stage } } = window.scene;
    const at = (place) => camera.position.clone().set(...place).applyMatrix4(nodeRefFromName[""].matrixWorld).project(camera).toArray();
    const middle = at(now.body.map((x, axis) => x + stage.middle[axis]));
    const { right, top } = window.scene.camera.covered;
    return { middle: [middle[0] + right, middle[1] + top], x: now.body[0], view: window.scene.camera.view,
        position: camera.position.toArray(), distance: window.__viserMutable.cameraControl.distance,
        projection: [...camera.projectionMatrix.elements],
        foot: at([now.body[0], 0, 0]), top: at([now.body[0], 0, 2]), eye: now.eye };
}"""


def frame_of(page: Page) -> Frame:
    """Returns the frame of the 3D view, once it shows the scene."""
    found = page.wait_for_selector("iframe[title='3D view'][src^='/viser/']", state="attached", timeout=PATIENCE)
    assert found is not None
    frame = found.content_frame()
    assert frame is not None
    frame.wait_for_function("() => window.scene?.camera && window.scene.shown", timeout=PATIENCE)
    return frame


def look(page: Page, frame: Frame) -> dict[str, Any]:
    drawn(page)
    return frame.evaluate(AT)


def in_the_middle(page: Page, frame: Frame) -> dict[str, Any]:
    """Asserts that the body is where the view with the body has it: in the middle of what the page does not cover of the picture."""
    told = look(page, frame)
    assert told["view"] == "follow"
    assert np.abs(told["middle"]).max() < 0.04, told
    return told


def steps(page: Page, frame: Frame, ticks: int) -> None:
    """Runs on for some ticks, and waits until the 3D view shows that."""
    before = frame.evaluate("() => window.scene.shown.body[0]")
    page.evaluate("async (ticks) => (await part('server.js')).sendCommand({ type: 'step', ticks })", ticks)
    until(page, lambda: frame.evaluate("() => window.scene.shown.body[0]") > before)


def drag(page: Page, x: float, y: float, button: Any = "left") -> None:
    box = page.locator("#scene").bounding_box()
    assert box is not None
    middle = box["x"] + box["width"] / 3, box["y"] + box["height"] / 2
    page.mouse.move(*middle)
    page.mouse.down(button=button)
    for part in (0.5, 1):
        page.mouse.move(middle[0] + part * x, middle[1] + part * y)
    page.mouse.up(button=button)
    page.wait_for_timeout(200)


@pytest.mark.slow
def test_the_free_camera_is_where_the_user_left_it_after_a_reload_until_the_view_is_reset(pages: Callable[..., Page]) -> None:
    page = pages(width=700, height=500)  # a small scene is drawn quickly
    frame = frame_of(page)
    page.get_by_label("Camera").select_option("side")
    page.get_by_label("Camera").select_option("free")
    until(page, lambda: look(page, frame)["view"] == "free")
    begun = look(page, frame)["position"]
    drag(page, 80, 10)
    until(page, lambda: page.evaluate(KEPT) == 1)
    page.wait_for_timeout(500)
    left = look(page, frame)["position"]
    assert np.linalg.norm(np.subtract(left, begun)) > 0.5
    page.reload()
    frame = frame_of(page)
    until(page, lambda: np.allclose(look(page, frame)["position"], left, atol=0.02))
    page.get_by_label("Camera").select_option("top")
    page.get_by_label("Camera").select_option("free")
    until(page, lambda: np.allclose(look(page, frame)["position"], left, atol=0.02))
    page.get_by_role("button", name="Reset view").click()
    until(page, lambda: np.allclose(look(page, frame)["position"], begun, atol=0.02))
    assert page.evaluate(KEPT) == 0
    page.reload()
    frame = frame_of(page)
    until(page, lambda: np.allclose(look(page, frame)["position"], begun, atol=0.02))


KEPT = "() => JSON.parse(localStorage.getItem('actr3d.free cameras of models') ?? '[]').length"
"""For how many models a free camera is remembered."""


@pytest.mark.slow
def test_with_the_body_it_stays_in_the_middle_whatever_the_user_does(pages: Callable[..., Page]) -> None:
    page = pages()
    frame = frame_of(page)
    begun = in_the_middle(page, frame)
    for _ in range(3):
        steps(page, frame, 60)
        in_the_middle(page, frame)
    assert in_the_middle(page, frame)["x"] > begun["x"] + 1
    # Turned by the mouse, it turns about the body; so far away as before.
    before = in_the_middle(page, frame)
    drag(page, 80, 10)
    turned = in_the_middle(page, frame)
    assert np.linalg.norm(np.subtract(turned["position"], before["position"])) > 0.5
    assert turned["distance"] == pytest.approx(before["distance"], rel=0.01)
    page.keyboard.press("Shift+v")
    until(page, lambda: np.allclose(look(page, frame)["position"], before["position"], atol=0.02))
    # From whatever view there was, turned and shifted there, too.
    chosen = page.get_by_label("Camera")
    for view in ("free", "top", "side", "eye"):
        chosen.select_option(view)
        until(page, lambda view=view: look(page, frame)["view"] == view)
        drag(page, -60, 20)
        drag(page, 40, 20, "right")
        chosen.select_option("follow")
        until(page, lambda: look(page, frame)["view"] == "follow")
        in_the_middle(page, frame)
    page.click("#restart")
    shows(page, "#time", "t = 0.00 s")
    until(page, lambda: abs(frame.evaluate("() => window.scene.shown.body[0]")) < 0.01)
    in_the_middle(page, frame)
    page.reload()
    frame = frame_of(page)
    in_the_middle(page, frame)
    steps(page, frame, 60)
    in_the_middle(page, frame)


UNDER = """() => {
  const frame = document.querySelector("#scene iframe");
  const { left, top } = frame.getBoundingClientRect();
  const inset = document.querySelector(".inset").getBoundingClientRect();
  return [...frame.contentDocument.querySelectorAll(".scene-labels p")].some((label) => {
    const box = label.getBoundingClientRect();
    const isBeside = box.left + left >= inset.right || inset.left >= box.right + left;
    const isAboveOrBelow = box.top + top >= inset.bottom || inset.top >= box.bottom + top;
    return getComputedStyle(label).visibility !== "hidden" && !isBeside && !isAboveOrBelow;
  });
}"""
"""Returns whether a label lies under the small retina."""


COVERS = """() => {
  const frame = document.querySelector("#scene iframe"), { camera, facts: { stage } } = frame.contentWindow.scene;
  const { left, top, width, height } = frame.getBoundingClientRect();
  const covers = [...document.querySelectorAll("#scene :is(.view-bar, .inset)")].map((one) => one.getBoundingClientRect());
  const corners = stage.corners.map((corner) => camera.at(corner)).map(({ x, y }) => [left + x * width, top + y * height]);
  const isUnder = ([x, y], box) => x > box.left && x < box.right && y > box.top && y < box.bottom;
  return corners.some((corner) => covers.some((box) => isUnder(corner, box)) || corner[1] < top || corner[0] < left);
}"""
"""Returns whether the tools or the small retina cover a corner of what is on the stage, or it is not in the picture."""


@pytest.mark.slow
@pytest.mark.parametrize("view", ["follow", "side"])
def test_neither_tools_nor_retina_cover_the_doorway_in_a_small_window(pages: Callable[..., Page], view: str) -> None:
    page = pages(width=853, height=533)
    frame = frame_of(page)
    page.get_by_label("Camera").select_option(view)
    until(page, lambda: look(page, frame)["view"] == view and not page.evaluate(COVERS))
    page.get_by_role("button", name="Eye", exact=True).click()
    expect(page.locator(".inset")).to_be_visible()
    until(page, lambda: not page.evaluate(COVERS))


@pytest.mark.slow
def test_no_label_lies_under_the_retina(pages: Callable[..., Page]) -> None:
    page = pages()
    frame = frame_of(page)
    in_the_middle(page, frame)
    expect(page.locator(".inset")).to_be_visible()
    page.get_by_role("button", name="Hide the retina").click()
    page.add_style_tag(content=".inset { inset: 40px 0 0 0 !important; width: auto !important; height: auto !important; }")
    frame.evaluate(
        """() => {
          const { now } = window.scene.facts;
          window.scene.receive("now", { ...now, labels: [{ text: "opening 50 cm", place: [2, 0, 1], chosen: true }] });
          window.__viserMutable.requestRender();
        }"""
    )
    label = frame.locator(".scene-labels p")
    expect(label).to_be_visible()
    page.get_by_role("button", name="Eye", exact=True).click()
    expect(page.locator(".inset")).to_be_visible()
    until(page, lambda: not page.evaluate(UNDER))
    page.get_by_role("button", name="Hide the retina").click()
    expect(label).to_be_visible()


def test_the_view_is_saved_as_a_picture_with_sky_and_labels(pages: Callable[..., Page], tmp_path: Path) -> None:
    page = pages(height=808)
    frame = frame_of(page)
    in_the_middle(page, frame)
    assert min(frame.evaluate(SHADED)) > 100, "feet and walls have shadows on the ground"
    frame.evaluate(
        """() => {
          const { now } = window.scene.facts;
          window.scene.receive("now", { ...now, labels: [{ text: "opening 50 cm", place: [2, 0, 1], chosen: true }] });
          window.__viserMutable.requestRender();
        }"""
    )
    label = frame.locator(".scene-labels p")
    expect(label).to_be_visible()
    with page.expect_download() as download:
        page.get_by_role("button", name="Save the 3D view as a picture").click()
    assert re.fullmatch(r"doorway_seed_\d+_at_0\.00_s\.png", download.value.suggested_filename)
    download.value.save_as(tmp_path / "view.png")
    picture = np.array(Image.open(tmp_path / "view.png").convert("RGB")).astype(int)
    height, width = frame.evaluate("() => [innerHeight, innerWidth]")
    assert picture.shape == (2 * height, 2 * width, 3)
    shot = Image.open(BytesIO(page.locator("iframe[title='3D view']").screenshot())).convert("RGB").resize((2 * width, 2 * height))
    off = np.abs(picture - np.array(shot).astype(int)).max(axis=2)[height // 4 :, :width]  # without the page's own buttons and inset
    assert np.quantile(off, 0.9) < 12
    box = label.bounding_box()
    around = page.locator("iframe[title='3D view']").bounding_box()
    assert box is not None
    assert around is not None
    x, y = round(2 * (box["x"] - around["x"])), round(2 * (box["y"] - around["y"]))
    inside = picture[y + 6 : y + round(2 * box["height"]) - 6, x + 16 : x + round(2 * box["width"]) - 16].min(axis=2)
    assert np.median(inside) > 200, "a label is light"
    assert inside.min() < 100, "its text is dark"


SHADED = """() => {
    const viewer = window.__viserMutable, place = viewer.camera.position.clone();
    let shades = null;
    viewer.scene.traverse((object) => { if (object.material?.uniforms?.strength) shades = object; });
    const pixels = () => {
        const canvas = window.scene.picture(1);
        return canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    };
    const found = [1, 5].map((far) => { // as far from the scene as the view begins, and five times as far
        viewer.camera.position.copy(place).multiplyScalar(far);
        viewer.camera.updateMatrixWorld();
        shades.visible = false;
        const without = pixels();
        shades.visible = true;
        return pixels().reduce((count, value, n) => count + (without[n] - value > 30 ? 1 : 0), 0);
    });
    viewer.camera.position.copy(place);
    return found;
}"""
"""Counts how much of the picture is darker by the shadows on the ground, from near and from far."""


WATCH = """() => {
    const viewer = window.__viserMutable, { facts: told } = window.scene;
    const found = { off: Infinity };
    for (const [name, node] of Object.entries(viewer.nodeRefFromName)) if (name.startsWith("/bodies/")) node?.traverse((object) => {
        for (let n = 0; n < (object.getPositionAt ? object.instancesCount : 0); n++) {
            const off = Math.hypot(...object.getPositionAt(n).toArray().map((x, axis) => x - told.now.body[axis]));
            if (off < found.off) Object.assign(found, { off, object, n });
        }
    });
    const { start, middle } = told.stage, root = viewer.nodeRefFromName[""], place = viewer.camera.position.clone();
    window.watched = [];
    if (found.object) viewer.scene.onAfterRender = (renderer, scene, camera) => {
        if (camera !== viewer.camera) return;
        const drawn = found.object.getPositionAt(found.n).toArray();
        place.set(...drawn.map((x, axis) => x + middle[axis])).applyMatrix4(root.matrixWorld).project(camera);
        const { right, top } = window.scene.camera.covered;
        window.watched.push({ at: [place.x + right, place.y + top], drawn, shown: window.scene.shown.body });
    };
    return found.off;
}"""


def watched(page: Page, frame: Frame, act: Callable[[], None], travelled: float) -> None:
    """Asserts that the drawn body has one place in every picture while something goes on, and that what belongs to it is drawn where it is.

    Args:
        page: The page.
        frame: The 3D view, watched.
        act: What goes on.
        travelled: So far the body goes at least [m].
    """
    frame.evaluate("() => { window.watched = []; window.__viserMutable.requestRender(); }")
    until(page, lambda: frame.evaluate("() => window.watched.length > 0"))  # one before it starts
    act()
    until(page, lambda: bool(np.ptp([one["drawn"][0] for one in frame.evaluate("() => window.watched")]) > travelled))  # its end comes last
    told = frame.evaluate("() => window.watched")
    drawn_at = np.array([one["drawn"] for one in told])
    assert np.abs([one["at"] for one in told]).max() < 0.02, told
    assert np.abs(drawn_at - [one["shown"] for one in told]).max() < 1e-3


WATCH_RESTART = """() => {
    const viewer = window.__viserMutable, root = viewer.nodeRefFromName[""], place = viewer.camera.position.clone();
    window.watched = [];
    viewer.scene.onAfterRender = (renderer, scene, camera) => {
        if (camera !== viewer.camera) return;
        const { body } = window.scene.shown, { middle } = window.scene.facts.stage;
        let off = 100, shapes = 0;
        scene.traverse((object) => {
            for (let n = 0; n < (object.getPositionAt ? object.instancesCount : 0); n++) {
                shapes += 1;
                off = Math.min(off, Math.hypot(...object.getPositionAt(n).toArray().map((x, axis) => x - body[axis])));
            }
        });
        place.set(...body.map((x, axis) => x + middle[axis])).applyMatrix4(root.matrixWorld).project(camera);
        const { right, top } = window.scene.camera.covered;
        window.watched.push({ off, shapes, x: body[0], at: Math.max(Math.abs(place.x + right), Math.abs(place.y + top)) });
    };
}"""
"""Notes of each picture how far the next shape is from where the body is said to be, and how many shapes there are."""


FOCUS = """(place) => {
  const { camera } = window.scene;
  const { x, y } = camera.at(place);
  return { x, y, off: camera.controls.getTarget(camera.vector.clone()).distanceTo(camera.toThree(place)), view: camera.view };
}"""
"""Where a place is in the picture, how far it is from what the camera turns about [m], and the view."""


@pytest.mark.slow
def test_a_double_click_moves_a_thing_to_the_middle(pages: Callable[..., Page]) -> None:
    page = pages()
    frame = frame_of(page)
    in_the_middle(page, frame)
    chosen = page.get_by_label("Camera")
    for view, after, place in (("follow", "free", [6.95, 0.8, 1.2]), ("top", "top", [7.0, 0.8, 2.5])):
        chosen.select_option(view)
        until(page, lambda view=view: look(page, frame)["view"] == view)
        area = page.locator("#scene iframe").bounding_box()
        assert area is not None
        told = frame.evaluate(FOCUS, place)
        page.mouse.dblclick(area["x"] + told["x"] * area["width"], area["y"] + told["y"] * area["height"])
        until(page, lambda place=place: frame.evaluate(FOCUS, place)["off"] < 0.3)
        expect(chosen).to_have_value(after)


@pytest.mark.slow
def test_no_picture_mixes_two_runs(pages: Callable[..., Page]) -> None:
    page = pages()
    frame = frame_of(page)
    in_the_middle(page, frame)
    page.click("#run")
    shows(page, "#status", "ended")
    until(page, lambda: frame.evaluate("() => window.scene.facts.now.moment === window.scene.shown.moment"))
    frame.evaluate(WATCH_RESTART)
    page.click("#restart")
    shows(page, "#time", "t = 0.00 s")
    until(page, lambda: frame.evaluate("() => window.watched.length > 3 && Math.abs(window.watched.at(-1).x) < 0.01"))
    page.wait_for_timeout(1500)
    told = frame.evaluate("() => window.watched")
    assert max(one["off"] for one in told) < 1e-3, told
    assert len({one["shapes"] for one in told}) == 1, told
    assert max(one["at"] for one in told) < 0.05, told


@pytest.mark.slow
def test_while_it_runs_the_drawn_body_stays_at_its_place_in_every_picture(pages: Callable[..., Page]) -> None:
    page = pages()
    frame = frame_of(page)
    in_the_middle(page, frame)
    until(page, lambda: frame.evaluate(WATCH) < 1e-3)
    page.get_by_label("Speed", exact=True).select_option("2 x")

    def to(time: float, how: str = "until") -> Callable[[], None]:
        def act() -> None:
            said = {"type": how, "time": time}
            page.evaluate("async (said) => (await part('server.js')).sendCommand(said)", said)
            shows(page, "#time", f"t = {time:.2f} s")
            until(page, lambda: frame.evaluate("() => window.scene.facts.now.moment === window.scene.shown.moment"))
            drawn(page)

        return act

    watched(page, frame, to(1.5), 1)
    drag(page, 80, 10)
    watched(page, frame, to(3), 1)
    watched(page, frame, to(0, "seek"), 3)
    watched(page, frame, to(1), 0.5)
    page.click("#restart")
    shows(page, "#time", "t = 0.00 s")
    until(page, lambda: abs(frame.evaluate("() => window.scene.shown.body[0]")) < 0.01)
    until(page, lambda: frame.evaluate(WATCH) < 1e-3)
    watched(page, frame, to(1), 0.5)
    page.reload()
    frame = frame_of(page)
    in_the_middle(page, frame)
    until(page, lambda: frame.evaluate(WATCH) < 1e-3)
    watched(page, frame, to(2), 0.5)


HIDDEN = """([hidden, name]) => new Promise((done) => {
    const viewer = window.__viserMutable;
    for (const [at, node] of Object.entries(viewer.nodeRefFromName)) {
        if (at.startsWith(name)) node?.traverse((one) => { if (one.isMesh) one.layers.mask = hidden ? 0 : 1; });
    }
    viewer.scene.onAfterRender = (renderer, scene, camera) => camera === viewer.camera && requestAnimationFrame(() => done());
    viewer.requestRender();
})"""


def part_seen(page: Page, frame: Frame, body: str) -> float:
    """Returns how large the part of the picture is that changes where a body is not drawn, once nothing else moves in it."""
    pictures: list[Any] = []

    def changed(one: int, other: int) -> float:
        return float((np.abs(pictures[one] - pictures[other]).max(axis=2) > 12).mean())

    def rests() -> bool:
        pictures.clear()
        for hidden in (False, True, False):
            frame.evaluate(HIDDEN, [hidden, body])
            drawn(page)
            with Image.open(BytesIO(page.locator("#scene iframe").screenshot())) as picture:
                pictures.append(np.asarray(picture.convert("RGB"), dtype=int))
        return changed(0, 2) < 0.001

    until(page, rests)
    return changed(0, 1)


@pytest.mark.slow
def test_a_wall_between_the_camera_and_the_body_is_cut_away_around_the_body(pages: Callable[..., Page]) -> None:
    page = pages()
    frame = frame_of(page)
    page.evaluate("async () => (await part('server.js')).sendCommand({ type: 'until', time: 4 })")
    shows(page, "#time", "t = 4.00 s")
    until(page, lambda: frame.evaluate("() => window.scene.shown.body[0]") > 4)
    plain = part_seen(page, frame, "/bodies/walker")
    assert plain > 0.01
    frame.evaluate("() => window.__viserMutable.cameraControl.rotate(2.6, 0, false)")
    assert part_seen(page, frame, "/bodies/walker") > 0.75 * plain  # from behind the wall
    page.get_by_label("Camera").select_option("free")  # where the camera stays, but nothing is promised
    until(page, lambda: look(page, frame)["view"] == "free")
    assert part_seen(page, frame, "/bodies/walker") < 0.5 * plain


@pytest.mark.slow
@pytest.mark.parametrize("view", ["follow", "top"])
def test_a_body_is_dragged_elsewhere_by_its_handle(pages: Callable[..., Page], view: str) -> None:
    page = pages()
    frame = frame_of(page)
    page.get_by_label("Camera").select_option(view)
    until(page, lambda: look(page, frame)["view"] == view)
    page.get_by_role("button", name="Overlays").click()
    page.get_by_label("handles to move things").check()
    page.get_by_role("button", name="Overlays").click()
    until(page, lambda: frame.evaluate("() => '/overlays/handles/0' in window.__viserMutable.nodeRefFromName"))
    drawn(page)
    box = page.locator("#scene iframe").bounding_box()
    assert box is not None

    def at(x: float, y: float) -> tuple[float, float]:
        place = frame.evaluate("(place) => window.scene.camera.at(place)", [x, y, 0.02])
        return box["x"] + place["x"] * box["width"], box["y"] + place["y"] * box["height"]

    def drag(begin: tuple[float, float], end: tuple[float, float]) -> None:
        page.mouse.move(*begin)
        drawn(page)
        page.mouse.down()
        for part in (0.3, 0.6, 1):
            page.mouse.move(*(one + part * (other - one) for one, other in zip(begin, end, strict=True)))
            drawn(page)
        page.mouse.up()

    def handle() -> list[float]:
        return frame.evaluate("() => [...window.__viserMutable.nodeRefFromName['/overlays/handles/0'].position]")

    if view == "top":  # where the wall is in view
        before = handle()
        drag(at(0.25, 0.25), at(7.25, 1.25))  # the square between the arrows, into the wall beside the doorway
        expect(page.locator(".toast")).to_contain_text("it would be inside")
        until(page, lambda: handle() == pytest.approx(before, abs=1e-4))
    drag(at(0.25, 0.25), at(0.25, 1.0))
    until(page, lambda: abs(frame.evaluate("() => window.scene.facts.now.body[1]") - 0.75) < 0.1)
    commands = """async () => {
      const { events } = await part("store.js");
      return events.value.list.filter(([, , kind]) => kind === "command").map((event) => event[3]);
    }"""
    (command,) = page.evaluate(commands)
    assert command["command"] == "move"
    assert command["data"]["values"][0] == "walker"
    assert command["data"]["values"][2] == pytest.approx(0.75, abs=0.1)


@pytest.mark.slow
def test_from_above_there_is_no_perspective_and_each_browser_has_a_view_of_its_own(pages: Callable[..., Page]) -> None:
    page = pages()
    frame = frame_of(page)
    page.get_by_label("Camera").select_option("top")
    until(page, lambda: look(page, frame)["projection"][11] == 0)
    told = look(page, frame)
    assert told["view"] == "top"
    assert np.subtract(told["top"], told["foot"])[:2] == pytest.approx([0, 0], abs=2e-3)  # what is above each other is at one place
    assert told["projection"][15] == 1
    page.get_by_label("Camera").select_option("eye")
    until(page, lambda: look(page, frame)["projection"][11] == -1)
    told = look(page, frame)
    assert told["view"] == "eye"
    assert told["projection"][5] == pytest.approx(1 / np.tan(told["eye"]["fov"] / 2), rel=1e-4)
    page.get_by_role("button", name="Overlays").click()
    page.get_by_label("field of view").check()
    seen = "(name) => Boolean(window.__viserMutable.nodeRefFromName[name]?.visible)"
    until(page, lambda: frame.evaluate("() => '/overlays/frustum/0' in window.__viserMutable.nodeRefFromName"))
    drawn(page)
    assert not frame.evaluate(seen, "/overlays/frustum/0")  # nothing hangs before the eye
    page.keyboard.press("v")
    until(page, lambda: look(page, frame)["view"] == "follow")
    until(page, lambda: frame.evaluate(seen, "/overlays/frustum/0"))

    labels = """(far) => {
        const { facts: told, camera } = window.scene, [x, y] = told.stage.start;
        const places = [[x, y, 1.7], [x, y, 1.6], [x + 0.2, y, 1.65], [x, y + 0.1, 1.9], [x + 7, y, 1.5]];
        const labels = places.map((place, n) => ({ text: `opening ${n} of ${far}`, place, chosen: n < 2 }));
        window.scene.receive("now", { ...told.now, labels });
        window.__viserMutable.cameraControl.dollyTo(far, false);
    }"""
    rectangles = """() => {
        const { camera, facts: told } = window.scene, [x, y, z, radius] = told.now.heads[0], at = camera.at([x, y, z]);
        const half = radius * camera.scaleAt(at.depth) * innerHeight;
        const shown = [...document.querySelectorAll(".scene-labels p")].filter((one) => getComputedStyle(one).visibility === "visible");
        const boxes = shown.map((one) => one.getBoundingClientRect()).map(({ left, top, width, height }) => ({ left, top, width, height }));
        return [...boxes, { left: at.x * innerWidth - half, top: at.y * innerHeight - half, width: 2 * half, height: 2 * half }];
    }"""
    for far in (2, 5, 12, 40):
        frame.evaluate(labels, far)
        page.wait_for_timeout(300)
        drawn(page)
        boxes = frame.evaluate(rectangles)
        assert len(boxes) >= 3, far
        assert not any(overlap(one, other) for one, other in combinations(boxes, 2)), far


@pytest.mark.slow
def test_keys_work_after_a_click_into_the_3d_view_and_do_nothing_in_a_field_of_text(page: Page) -> None:
    frame = frame_of(page)
    page.get_by_label("Speed", exact=True).select_option("1 x")
    box = page.locator("#scene").bounding_box()
    assert box is not None
    inside = box["x"] + box["width"] / 3, box["y"] + box["height"] / 2
    page.mouse.click(*inside)
    assert page.evaluate("document.activeElement.tagName") == "IFRAME"
    focused = page.locator("#scene iframe.reached")  # outlined, as it is not after a click
    expect(focused).to_have_count(0)
    page.locator("#scene .view-bar").locator("select, button").first.focus()
    page.keyboard.press("Shift+Tab")
    expect(focused).to_have_count(1)
    page.mouse.click(*inside)
    page.get_by_role("tab", name="Buffers").focus()
    expect(focused).to_have_count(0)
    page.mouse.click(*inside)
    page.keyboard.press("ArrowRight")
    shows(page, "#time", "t = 0.01 s")
    before = look(page, frame)["position"]
    page.keyboard.press("ArrowRight")
    shows(page, "#time", "t = 0.02 s")
    assert look(page, frame)["position"] == pytest.approx(before, abs=0.05)  # arrows do not turn the camera
    page.keyboard.press(" ")
    expect(page.locator("#run")).to_contain_text("Pause")
    page.keyboard.press(" ")
    expect(page.locator("#run")).to_contain_text("Run")
    page.keyboard.press("3")
    expect(page.get_by_role("tab", name="Productions")).to_have_attribute("aria-selected", "true")
    page.keyboard.press("?")
    keys = page.get_by_role("dialog")
    expect(keys).to_contain_text("Reset view")
    expect(keys).to_contain_text("Move the camera, where it is free")
    page.keyboard.press("Escape")

    page.locator("#step").click()  # arrows are keys of the run beside a button, too
    page.keyboard.press("ArrowLeft")
    page.mouse.click(*inside)

    page.get_by_label("Camera").select_option("free")
    for focus in ("frame", "page"):
        page.mouse.click(*inside) if focus == "frame" else page.locator("#run").focus()
        before = look(page, frame)["position"]
        page.keyboard.down("d")
        until(page, lambda before=before: bool(np.linalg.norm(np.subtract(look(page, frame)["position"], before)) > 0.01))
        page.keyboard.up("d")
        page.wait_for_timeout(200)
        before = look(page, frame)["position"]
        page.wait_for_timeout(200)
        assert look(page, frame)["position"] == pytest.approx(before, abs=1e-3), "it stops with the key"
    page.get_by_role("searchbox", name="Filter rows").click()
    page.keyboard.type("dv ")
    assert look(page, frame)["position"] == pytest.approx(before, abs=1e-3)
    assert page.get_by_label("Camera").input_value() == "free"
    expect(page.locator("#run")).to_contain_text("Run")
