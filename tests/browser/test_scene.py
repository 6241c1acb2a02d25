"""The 3D view in a real browser: alone, with viser's panel; framed, without it; and in the dark."""

from __future__ import annotations

import re
import shutil
import time
from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import pytest
import zstandard
from PIL import Image
from playwright.sync_api import Page, Route, WebSocket, expect

from tests.helpers.page import Users, until
from tests.helpers.workbench_server import MODELS, Served, served
from workbench.backdrop import LIGHTS

pytestmark = pytest.mark.scene

PATIENCE = 120_000
"""[ms]; without a graphics card, on a busy machine."""


@pytest.fixture(scope="module")
def workbench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served(tmp_path_factory.mktemp("scene") / "models") as running:
        shutil.copy(MODELS / "aperture_passage.py", running.folder / "aperture_passage.py")
        yield running


@pytest.fixture
def page(users: Users, workbench: Served) -> Iterator[Page]:
    page = users.new(scene=True)
    page.set_viewport_size({"width": 800, "height": 600})
    page.goto(workbench.address)
    yield page
    users.leave()


@pytest.fixture
def session(workbench: Served) -> Iterator[str]:
    name: str = workbench.post("/api/sessions", {"model": "aperture_passage.py", "seed": 1}).json()["id"]
    wait(lambda: told(workbench, name)["session"].get("world"))
    yield name
    workbench.post(f"/api/sessions/{name}/close")


def told(workbench: Served, session: str) -> dict[str, Any]:
    return workbench.get(f"/api/sessions/{session}").json()


def wait(condition: Callable[[], Any]) -> None:
    end = time.monotonic() + PATIENCE / 1000
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def say(workbench: Served, session: str, **said: Any) -> None:
    assert workbench.post(f"/api/sessions/{session}/command", {"command": said}).status_code == 200


def shown(workbench: Served, session: str, overlay: str) -> bool:
    return next(one["shown"] for one in told(workbench, session)["session"]["overlays"] if one["name"] == overlay)


@pytest.mark.slow
def test_viser_alone_has_all_controls_and_they_are_those_of_the_session(workbench: Served, page: Page, session: str) -> None:
    page.goto(f"{workbench.url}/viser/{session}/")
    expect(page.get_by_text("t = 0.00 s")).to_be_visible(timeout=PATIENCE)
    expect(page.locator("canvas").first).to_be_visible(timeout=PATIENCE)
    page.get_by_role("button", name="step", exact=True).click()
    expect(page.get_by_text("t = 0.01 s")).to_be_visible(timeout=PATIENCE)
    page.get_by_role("button", name="back", exact=True).click()
    expect(page.get_by_text("t = 0.00 s")).to_be_visible(timeout=PATIENCE)
    box = page.get_by_role("checkbox", name="edges seen")
    expect(box).not_to_be_checked()
    box.click()
    wait(lambda: shown(workbench, session, "edges"))
    say(workbench, session, type="overlay", name="edges", shown=False)
    expect(box).not_to_be_checked(timeout=PATIENCE)
    page.get_by_role("combobox", name="Camera").select_option("top")
    page.wait_for_function("() => window.scene.camera?.view === 'top'")
    page.get_by_role("button", name="Reset view").click()
    assert told(workbench, session)["session"]["controlled_by"] == ""  # it takes control from no page


@pytest.mark.slow
def test_framed_there_is_the_scene_only_and_the_dark_is_dark(workbench: Served, page: Page, session: str) -> None:
    page.goto(f"{workbench.url}/viser/{session}/?panel=hidden&darkMode")
    expect(page.locator("canvas").first).to_be_visible(timeout=PATIENCE)
    expect(page.locator("html")).to_have_attribute("data-mantine-color-scheme", "dark", timeout=PATIENCE)
    expect(page.get_by_text(re.compile("t = 0.00 s"))).to_have_count(1, timeout=PATIENCE)  # it is connected
    for panel in page.locator(".mantine-Paper-root, .mantine-Notification-root").all():
        expect(panel).to_be_hidden()
    page.set_viewport_size({"width": 400, "height": 400})  # where viser has its panel below
    for panel in page.locator(".mantine-Paper-root").all():
        expect(panel).to_be_hidden()
    page.goto(f"{workbench.url}/viser/{session}/")
    expect(page.locator("html")).to_have_attribute("data-mantine-color-scheme", "light", timeout=PATIENCE)
    expect(page.get_by_text("t = 0.00 s")).to_be_visible(timeout=PATIENCE)


UNCOVERED = """() => {
    const scene = document.querySelector("#scene");
    new MutationObserver((_, observer) => {
        if (scene.querySelector(".scene-cover")) return;
        observer.disconnect();
        const { scene: { shown }, __viserMutable: { nodeRefFromName }, __viserSceneTree } = scene.querySelector("iframe").contentWindow;
        const isShape = ([name, node]) => name.startsWith("/bodies/") && /Glb/.test(node?.message.type);
        const nodes = Object.entries(__viserSceneTree.getState()).filter(isShape);
        const isThere = ([name]) => {
            let meshes = 0;
            nodeRefFromName[name]?.traverse((object) => (meshes += object.isMesh ? 1 : 0));
            return meshes > 0;
        };
        window.uncovered = { shapes: nodes.length > 0 && nodes.every(isThere), placed: shown !== undefined };
    }).observe(scene, { childList: true });
}"""
"""Notes whether the shapes of all bodies are there when the 3D view is first seen, and have been placed."""


@pytest.mark.slow
def test_the_frame_is_covered_until_it_has_drawn_and_has_the_page_s_theme_without_reloading(workbench: Served, page: Page) -> None:
    held: list[Route] = []
    released: list[bool] = []
    page.route("**/static/*/viser_shim.js", lambda route: route.continue_() if released else held.append(route))
    page.goto(f"{workbench.url}/?model=aperture_passage.py")
    cover = page.locator(".scene-cover")
    expect(cover).to_have_text("The 3D view loads …", timeout=PATIENCE)
    until(page, lambda: bool(held))
    page.evaluate(UNCOVERED)
    released.append(True)
    for route in held:
        route.continue_()
    expect(cover).to_have_count(0, timeout=PATIENCE)
    assert page.evaluate("uncovered") == {"shapes": True, "placed": True}
    frame = page.frame_locator("iframe[title='3D view']").locator("html")
    begun = frame.evaluate("() => performance.timeOrigin")
    grounds: list[Any] = []
    for theme in ("system", "light"):
        page.get_by_role("button", name=f"Theme: {theme}").click()
        expect(page.locator("html")).to_have_attribute("data-theme", {"system": "light", "light": "dark"}[theme])
        area = page.locator("#scene").bounding_box()
        assert area is not None
        with Image.open(BytesIO(page.screenshot(clip={**area, "width": area["width"] - 20}))) as picture:
            grounds.append(picture.convert("RGB").getpixel((picture.width - 1, 1)))  # above the horizon
    assert min(grounds[0]) > 200
    assert max(grounds[1]) < 60
    assert frame.evaluate("() => performance.timeOrigin") == begun

    page.get_by_label("Speed", exact=True).select_option("1 x")
    page.click("#run")
    lag = page.locator(".scene-lag")
    expect(lag).to_have_count(0)
    frame.evaluate("() => { window.requestAnimationFrame = () => 0; }")  # it draws no more
    expect(lag).to_have_text(re.compile(r"^3D view of \d\.\d s$"), timeout=PATIENCE)
    page.click("#run")
    expect(lag).to_have_count(0)


@pytest.mark.slow
def test_a_browser_that_cannot_draw_in_3d_shows_what_to_do(workbench: Served, page: Page) -> None:
    page.add_init_script("""
        const made = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
            return kind.startsWith("webgl") ? null : made.call(this, kind, ...more);
        };
    """)
    page.goto(f"{workbench.url}/?model=aperture_passage.py")
    expect(page.locator(".scene-cover")).to_contain_text("This browser cannot draw in 3D", timeout=PATIENCE)
    expect(page.locator(".scene-cover progress")).to_have_count(0)


@pytest.mark.slow
def test_where_the_processor_draws_there_are_no_shadows_and_edges_are_not_smoothed(workbench: Served, page: Page, session: str) -> None:
    lights: list[str] = []

    def hear(socket: WebSocket) -> None:
        def take(data: str | bytes) -> None:
            if isinstance(data, bytes) and len(data) > 16:  # two lengths stand before what is told
                told = zstandard.ZstdDecompressor().decompressobj().decompress(data[16:])
                lights.extend([socket.url] * told.count(b"EnableLightsMessage"))

        socket.on("framereceived", take)

    page.on("websocket", hear)
    page.goto(f"{workbench.url}/viser/{session}/?panel=hidden")  # this browser has no graphics card
    expect(page.get_by_text(re.compile("t = 0.00 s"))).to_have_count(1, timeout=PATIENCE)  # it is connected
    end = time.monotonic() + PATIENCE / 1000
    while not lights and time.monotonic() < end:
        page.wait_for_timeout(50)
    assert lights
    assert lights[0].endswith("?shadows=off")
    smooth = "document.querySelector('canvas').getContext('webgl2').getContextAttributes().antialias"
    assert page.evaluate(smooth) is False


NOTE_LIGHTS = """{
  const kind = WebGL2RenderingContext.prototype;
  const { shaderSource } = kind;
  window.lights = [];
  kind.shaderSource = function (shader, text) {
    const found = /directionalLights\\[ (\\d+) \\]/.exec(text);
    if (found) window.lights.push(Number(found[1]));
    return shaderSource.call(this, shader, text);
  };
}"""
"""Notes for how many lights each shader is made that computes light."""


@pytest.mark.slow
def test_nothing_is_drawn_with_the_lights_of_viser_before_those_of_the_workbench_are_there(
    workbench: Served, page: Page, session: str
) -> None:
    page.add_init_script(NOTE_LIGHTS)
    page.goto(f"{workbench.url}/viser/{session}/?panel=hidden")
    page.wait_for_function("() => window.scene?.shown")
    page.wait_for_function("() => window.lights.length > 0")
    assert set(page.evaluate("lights")) == {len(LIGHTS)}


RESTING = """async () => {
    const { FrameBudget } = await part("frame_budget.js");
    const frames = [], rest = new FrameBudget((draw) => frames.push(draw)), told = [], clock = performance.now;
    const frame = () => frames.shift()?.();
    let now = 1000;
    performance.now = () => now;
    for (const [hurried, cost] of [[false, 150], [true, 10], [true, 150]]) {
        rest.hurried = hurried;
        rest.drawing();
        const joins = rest.left === 0;
        now += cost;
        frame();
        await new Promise((done) => setTimeout(done));
        const waits = rest.left > 0;
        frame();
        told.push([joins, waits, rest.left > cost]);
    }
    rest.hurried = false;
    told.push(rest.left);
    performance.now = clock;
    return told;
}"""


@pytest.mark.slow
def test_between_slow_pictures_of_a_hurried_run_it_rests(page: Page) -> None:
    assert page.evaluate(RESTING) == [[True, False, False], [True, True, False], [True, True, True], 0]


SHARPENING = """async () => {
    const { Sharpness } = await part("scene/sharpness.js");
    const clock = performance.now, drawn = [];
    const pixels = { ratio: 1, getPixelRatio: () => pixels.ratio, setPixelRatio: (now) => (pixels.ratio = now) };
    let now = 1000, isBusy = false;
    performance.now = () => now;
    const draw = () => (sharpness.before(), drawn.push(pixels.ratio / devicePixelRatio));
    const sharpness = new Sharpness(pixels, draw, () => isBusy);
    const after = (time) => ((now += time), draw());
    after(1000);
    pixels.ratio = 0.75 * devicePixelRatio; // viser finds the pictures slow
    after(100);
    after(100);
    now += 501;
    await new Promise((done) => setTimeout(done, 700)); // nobody asks for another picture
    after(1000);
    after(100);
    isBusy = true;
    after(1000);
    performance.now = clock;
    return drawn;
}"""


@pytest.mark.slow
def test_a_3d_view_that_rests_is_drawn_with_all_pixels(page: Page) -> None:
    assert page.evaluate(SHARPENING) == [1, 0.75, 0.75, 1, 1, 0.75, 0.75]


@pytest.mark.slow
def test_the_3d_view_draws_when_the_page_does_while_a_run_is_hurried(pages: Callable[..., Page]) -> None:
    page = pages()
    frame = page.frame_locator("iframe[title='3D view']")
    expect(frame.get_by_text("t = 0.00 s")).to_have_count(1, timeout=PATIENCE)
    draws = """async (left) => {
        const { frameBudget: rest } = await part("frame_budget.js");
        Object.defineProperty(rest, "left", { get: () => left, configurable: true });
        const view = document.querySelector("iframe[title='3D view']").contentWindow;
        let drawn = false;
        view.requestAnimationFrame(() => (drawn = true));
        for (let frame = 0; frame < 5; frame++) await new Promise(requestAnimationFrame);
        delete rest.left;
        return drawn;
    }"""
    assert page.evaluate(draws, 100) is False
    assert page.evaluate(draws, 0) is True


@pytest.mark.slow
def test_what_a_model_calls_its_things_is_text(workbench: Served, page: Page) -> None:
    evil = "<img src=x onerror=document.title='run'>"
    source = (
        "from actr3d.simulation import Simulation\nfrom actr3d.world import Aperture, Floor, Scene\n\n"
        f'def build() -> Simulation:\n    return Simulation(Scene(parts=(Floor(), Aperture(name="{evil}"))), seed=1)\n'
    )
    (Path(workbench.folder) / "evil.py").write_text(source, encoding="utf-8")
    name = workbench.post("/api/sessions", {"model": "evil.py", "seed": 1}).json()["id"]
    wait(lambda: told(workbench, name)["session"].get("world") or told(workbench, name)["session"]["ending"])
    page.goto(f"{workbench.url}/viser/{name}/")
    expect(page.get_by_text("<img src=x")).to_be_visible(timeout=PATIENCE)
    assert page.title() != "run"
    workbench.post(f"/api/sessions/{name}/close")
