"""The replay of a recording in a real browser, from disk and without a network."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.recording import Recording
from actr3d.runner.facts import program_facts
from actr3d.simulation import Simulation
from actr3d.trace import Trace
from actr3d.world import Floor, Mannequin, Scene, Wall
from tests.browser.test_access import problems_of
from tests.helpers.page import PATIENCE, drawn, until
from tests.helpers.workbench_server import served
from tests.workbench.html_replay.test_html_replay import ZOO, Waiting
from workbench.backdrop import Shades
from workbench.html_replay import make
from workbench.html_replay.shapes import Shapes
from workbench.shipped import static


@pytest.fixture(scope="module")
def replay(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The replay of a run of the doorway, as it is downloaded."""
    folder = tmp_path_factory.mktemp("replay")
    with served(folder / "models") as server:
        name = server.post("/api/sessions", {"model": "doorway.py", "seed": 1, "run": True}).json()["id"]
        end = time.monotonic() + PATIENCE / 1000
        while (told := server.get(f"/api/sessions/{name}").json())["session"]["status"] != "ended":
            assert time.monotonic() < end
            time.sleep(0.1)
        recording = told["session"]["recording"]
        server.post(f"/api/sessions/{name}/close")
        file = folder / "replay.html"
        file.write_bytes(server.get(f"/api/recordings/{recording}/file", params={"form": "replay.html"}).content)
        return file


@contextmanager
def opened(browser: Browser, file: Path, **options: Any) -> Generator[Page]:
    """Opens a replay from disk, in a context with some options of Playwright."""
    with browser.new_context(**options) as context:
        page = context.new_page()
        page.set_default_timeout(PATIENCE)
        page.goto(file.as_uri())
        yield page


@pytest.mark.slow
def test_a_narrow_page_has_room_for_the_scene_and_says_how_far_a_run_went_that_was_not_over(browser: Browser, tmp_path: Path) -> None:
    trace = Trace("all")
    with Recording(tmp_path / "run.sqlite", program_facts("two.py", "", 1, None)) as recording, RunLimits(trace=trace, recorder=recording):
        trace.listen(recording.event_alone)
        Waiting().run(0.2)
        for parts in ((), (Wall(name="wall", start=(2, -1), end=(2, 1)),)):
            Simulation(Scene(parts=(Floor(), Mannequin(), *parts)), bodiless={"waiting": Waiting}).run(0.5)
    make.write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    with opened(browser, tmp_path / "replay.html", viewport={"width": 690, "height": 500}, offline=True) as page:
        expect(page.locator("#outcome")).to_have_text("Shown up to 1.20 s: the run was not over at that time.")
        expect(page.locator("#empty")).to_have_text("No scene is stored before 0.20 s.")
        expect(page.locator("#canvas")).to_be_hidden()
        page.get_by_role("slider", name="Time").fill("0.2")
        expect(page.locator("#empty")).to_be_hidden()
        expect(page.locator("#canvas")).to_be_visible()
        for width in (690, 850):  # below each other, and beside each other
            page.set_viewport_size({"width": width, "height": 500})
            drawn(page)
            scene, filter_box = page.locator("#scene").bounding_box(), page.locator("#filter").bounding_box()
            assert scene is not None
            assert scene["height"] > 150
            assert filter_box is not None
            assert filter_box["width"] >= 190  # what can be written there is shown whole
        page.get_by_label("follow").uncheck()
        shapes = "[0.4, 0.9, 0.5].map((time) => { goTo(time); return [drawing.shapes.length, drawing.camera.following]; })"
        (one, _), (other, _), again = page.evaluate(shapes)
        assert (other, again) == (one + 1, [one, False])  # the second simulation has a wall more; the view is as it was chosen


def test_the_clock_of_a_long_run_has_hours(browser: Browser, tmp_path: Path) -> None:
    trace = Trace("all")
    with Recording(tmp_path / "run.sqlite", program_facts("long.py", "", 1, None)) as recording:
        trace.listen(recording.event_alone)
        for time_us in (0, 4_512_300_000):
            trace.emit(time_us, "top", "begin", {})
    make.write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    with opened(browser, tmp_path / "replay.html", offline=True) as page:
        expect(page.locator("#outcome")).to_have_text("Shown up to 1:15:12.30: the run was not over at that time.")
        expect(page.locator("#clock")).to_have_text("0:00:00.00")
        expect(page.locator(".event time")).to_have_text(["0:00:00.000", "1:15:12.300"])
        page.evaluate("goTo(4000)")
        expect(page.locator("#clock")).to_have_text("1:06:40.00")
        expect(page.get_by_role("slider", name="Time")).to_have_attribute("aria-valuetext", "1:06:40.00")


def test_a_simulation_that_was_left_at_once_has_no_scene(browser: Browser, tmp_path: Path) -> None:
    with Simulation(Scene(parts=(Floor(), Mannequin())), seed=1).record(tmp_path / "run.sqlite"):
        pass
    make.write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    with opened(browser, tmp_path / "replay.html", offline=True) as page:
        expect(page.locator("#outcome")).to_have_text("Shown up to 0.00 s: the run was not over at that time.")
        expect(page.locator("#empty")).to_have_text("No scene is stored.")


def test_a_file_that_was_cut_off_says_why_nothing_plays(browser: Browser, tmp_path: Path) -> None:
    with Recording(tmp_path / "run.sqlite", program_facts("cut.py", "", 1, None)):
        pass
    make.write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    whole = (tmp_path / "replay.html").read_text(encoding="utf-8")
    (tmp_path / "cut.html").write_text(whole[: whole.index('"events"')], encoding="utf-8")
    with opened(browser, tmp_path / "cut.html", offline=True) as page:
        expect(page.locator("#outcome")).to_have_text("Nothing plays: the file is not whole, or no scripts run here.")


def test_a_run_whose_last_events_are_left_out_failed_when_it_did(browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(make, "MAX_EVENTS", 1)
    trace = Trace("all")
    with Recording(tmp_path / "run.sqlite", program_facts("long.py", "", 1, None)) as recording:
        trace.listen(recording.event_alone)
        for time_us in (0, 600_000_000):
            trace.emit(time_us, "top", "begin", {})
        recording.fact("failed", "ValueError: no more")
    make.write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    with opened(browser, tmp_path / "replay.html", offline=True) as page:
        expect(page.locator("#outcome")).to_have_text("Shown up to 600.00 s: the run failed at that time (ValueError: no more).")
        expect(page.locator("#count")).to_have_text("1 of 1 events; 1 more are left out")


def test_all_of_it_can_be_read_named_and_reached_in_both_themes(browser: Browser, replay: Path) -> None:
    with opened(browser, replay, viewport={"width": 1200, "height": 800}) as page:
        drawn(page)
        problems = problems_of(page)  # all events are ahead
        page.get_by_text("Parameters and result").click()
        page.evaluate("goTo(2)")
        expect(page.locator(".event.now").first).to_be_visible()
        assert problems + problems_of(page) == []


@pytest.mark.slow
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_plays_from_disk_with_scene_and_trace_at_one_time(browser: Browser, replay: Path, scheme: Any) -> None:
    complaints: list[str] = []
    asked: list[str] = []
    with browser.new_context(viewport={"width": 900, "height": 600}, color_scheme=scheme, offline=True) as context:
        page = context.new_page()
        page.set_default_timeout(PATIENCE)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
        page.on("request", lambda request: asked.append(request.url))
        page.goto(replay.as_uri())
        expect(page.get_by_role("heading", name="doorway.py · seed 1")).to_be_visible()
        expect(page.locator("#outcome")).to_have_text("Ended: the model called stop().")
        page.get_by_text("Parameters and result").click()
        expect(page.get_by_role("row", name="width")).to_be_visible()
        page.get_by_text("Parameters and result").click()
        canvas = page.locator("#canvas")
        drawn(page)
        rows = page.locator(".event")
        expect(rows.first).to_contain_text("walker fires look")  # as in the trace of the page, buffers are among the details
        expect(rows.first).to_have_class("event fire ahead")
        page.get_by_label("all details").check()
        page.get_by_label("Show").fill("buffer approach")
        expect(rows.first).to_contain_text("walker.goal buffer approach")
        expect(rows.first).to_have_class("event now")
        page.get_by_label("Show").fill("")
        expect(rows.last).to_have_class(re.compile("ahead"))
        assert page.evaluate(EXTENT, [0]) < 1  # all that stands there is in the picture
        first = canvas.screenshot()
        page.get_by_role("slider", name="Time").fill("3")
        expect(page.locator("#clock")).to_have_text("3.00 s")
        until(page, lambda: canvas.screenshot() != first)  # it has walked on
        expect(page.locator(".event.now")).to_have_count(4)
        page.get_by_label("all details").uncheck()
        expect(page.locator(".event.now")).to_have_text("3.000walker fires judge")
        follow = page.get_by_label("follow")
        expect(follow).to_be_checked()  # it leaves what is to be seen at first
        places = [page.evaluate(PLACE, [time]) for time in (0, 3, 6.8)]
        assert places[1:] == [pytest.approx(places[0], abs=0.01)] * 2
        follow.uncheck()
        still = [page.evaluate(PLACE, [time]) for time in (6.8, 3)]
        assert still[0] == pytest.approx(places[0], abs=0.01)
        assert still[1] != pytest.approx(places[0], abs=0.1)
        follow.check()
        page.get_by_role("slider", name="Time").fill("0")
        page.get_by_label("Show").fill("look fires")
        expect(rows.first).to_contain_text("look")
        rows.first.click()
        expect(page.locator("#clock")).to_have_text("0.05 s")
        expect(rows.first).to_be_focused()  # though it is drawn anew
        expect(page.locator(".event.now")).to_contain_text("look")
        page.get_by_role("button", name="Play").click()
        expect(page.get_by_role("button", name="Pause")).to_be_visible()
        expect(page.locator("#clock")).not_to_have_text("0.05 s")
    assert complaints == []
    assert asked == [replay.as_uri()]


def test_the_triangles_of_each_kind_of_shape_are_where_it_is(browser: Browser) -> None:
    model = mujoco.MjModel.from_xml_string(ZOO)
    told = Shapes(model)
    with browser.new_page() as page:
        page.add_script_tag(content=scripts_of("space", "solids"))
        for parts in told.parts[1]:
            solid: dict[str, Any] = page.evaluate(JOINED, [[parts], told.meshes])
            places, faces = np.array(solid["places"]).reshape(-1, 3), np.array(solid["faces"]).reshape(-1, 3)
            corners = places[faces]
            volume = abs(np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6)
            if parts["kind"] not in ("mesh", "box"):  # whose triangles need not all turn the same way
                assert volume == pytest.approx(volume_of(parts["kind"], parts["size"]), rel=0.02)
            turned = np.empty(9)
            mujoco.mju_quat2Mat(turned, np.array(parts["turn"]))
            own = (places - parts["place"]) @ turned.reshape(3, 3)  # as MuJoCo has it
            if parts["kind"] != "mesh":
                assert np.abs(own).max(axis=0) == pytest.approx(half_of(parts["kind"], parts["size"]), abs=1e-3)
            facing = np.array(solid["facing"]).reshape(-1, 3)
            if parts["kind"] in ("sphere", "capsule", "ellipsoid"):
                assert ((facing * (places - parts["place"])).sum(axis=1) > 0).all()
            assert solid["clear"] == (parts["colour"][3] < 255)


def test_shadows_on_the_ground_are_those_of_the_workbench(browser: Browser) -> None:
    model = mujoco.MjModel.from_xml_string(ZOO)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    told = Shapes(model)
    expected = sorted(Shades(model, 0.0).quads(data))
    poses = np.concatenate((data.xpos[told.bodies], data.xquat[told.bodies]), axis=1).tolist()
    with browser.new_page() as page:
        page.add_script_tag(content=scripts_of("space", "solids", "shades"))
        found: list[list[float]] = sorted(page.evaluate(SHADES, [told.parts, told.meshes, poses]))
    assert len(found) == len(expected) > 4
    for one, other in zip(found, expected, strict=True):
        assert [*one[:2], *one[6:]] == pytest.approx([*other[:2], *other[6:]], abs=0.01)


def scripts_of(*names: str) -> str:
    """Returns scripts of the HTML replay, and the vectors of the page that they use."""
    paths = (static() / "scene" / "space.js", *(Path(make.__file__).with_name(f"{name}.js") for name in names))
    return "".join(path.read_text(encoding="utf-8").replace('"use strict";', "").replace("export ", "") for path in paths)


SHADES = """([shapes, meshes, poses]) => {
    const known = meshes.map(({ places, faces }) => ({ places: unpacked(places, Float32Array), faces: unpacked(faces, Uint32Array) }));
    return shadesOf(shapes.map((parts, n) => ({ boxes: parts.map((part) => boxOf(part, known)), pose: poseMatrix(poses[n]) })), 0);
}"""
JOINED = """([parts, meshes]) => {
    const known = meshes.map(({ places, faces }) => ({ places: unpacked(places, Float32Array), faces: unpacked(faces, Uint32Array) }));
    const { places, faces, facing, clear } = joined(parts, known);
    return { places: [...places], faces: [...faces], facing: [...facing], clear };
}"""
EXTENT = """([time]) => {
    const { camera, scene, canvas } = drawing, { view } = camera.seen(drawing.pose(scene.stage.follow, time), canvas.width / canvas.height);
    return Math.max(...scene.stage.corners.flatMap((corner) => {
        const at = (row) => view[row] * corner[0] + view[4 + row] * corner[1] + view[8 + row] * corner[2] + view[12 + row];
        return [Math.abs(at(0) / at(3)), Math.abs(at(1) / at(3))];
    }));
}"""
"""How far from the middle of the picture the corners of the stage are; 1 is its edge."""
PLACE = """([time]) => {
    const { camera, scene, canvas } = drawing, body = drawing.pose(scene.stage.follow, time);
    const { view } = camera.seen(body, canvas.width / canvas.height);
    const at = (row) => view[row] * body[0] + view[4 + row] * body[1] + view[12 + row];
    return [at(0) / at(3), at(1) / at(3)];
}"""
"""Where in the picture the body stands, from -1 to 1 each way."""


def volume_of(kind: str, size: Sequence[float]) -> float:
    """Returns the volume of a solid."""
    if kind == "ellipsoid":
        return 4 / 3 * math.pi * math.prod(size)
    ball, round = 4 / 3 * math.pi * size[0] ** 3, math.pi * size[0] ** 2
    return {"sphere": ball, "capsule": ball + round * 2 * size[-1], "cylinder": round * 2 * size[-1]}[kind]


def half_of(kind: str, size: Sequence[float]) -> Sequence[float]:
    """Returns how far a solid reaches from its middle along each of its axes."""
    if len(size) == 3:
        return size
    return (size[0], size[0], size[-1] + (size[0] if kind == "capsule" else 0))
