"""The video of the 3D view: its dialog, and what is in the file, decoded by a browser."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.helpers.page import PATIENCE, Users, shows, until

DECODED = """async ([video, picture, count]) => {
    const player = Object.assign(document.createElement("video"), { src: video, muted: true });
    document.body.append(player);
    await new Promise((done, fail) => Object.assign(player, { onloadeddata: done, onerror: () => fail(new Error(player.error.message)) }));
    const image = new Image();
    image.src = picture;
    await image.decode();
    const context = new OffscreenCanvas(player.videoWidth, player.videoHeight).getContext("2d", { willReadFrequently: true });
    const pixels = (of) => {
        context.drawImage(of, 0, 0);
        return context.getImageData(0, 0, player.videoWidth, player.videoHeight).data;
    };
    const wanted = pixels(image), off = [], shown = new Set();
    for (let n = 0; n < count; n++) {
        await new Promise((done, fail) => {
            setTimeout(() => fail(new Error(`picture ${n} is not shown`)), 30_000);
            const check = (_, { mediaTime }) => (Math.abs(mediaTime - n / 30) < 0.001 ? done() : player.requestVideoFrameCallback(check));
            player.requestVideoFrameCallback(check);
            player.currentTime = (n + 0.5) / 30;
        });
        const found = pixels(player);
        off.push(found.reduce((sum, value, at) => sum + Math.abs(value - wanted[at]), 0) / found.length);
        shown.add(String(found));
    }
    return { size: [player.videoWidth, player.videoHeight], duration: player.duration, off, different: shown.size };
}"""
"""Compares each picture of a video with a PNG: how far the colours are off on average."""


@pytest.mark.scene
def test_a_video_of_two_pictures_is_made(pages: Callable[..., Page], users: Users, tmp_path: Path) -> None:
    page = pages(width=560, height=400)
    for count in range(1, 5):
        page.click("#step")
        shows(page, "#time", rf"t = 0\.0{count} s")
    page.get_by_role("button", name="Make a video of the 3D view").click()
    dialog = page.get_by_role("dialog", name="Video of the 3D view")
    expect(dialog).to_contain_text("2 pictures, 0.07 s of video")
    with page.expect_download() as download:
        dialog.get_by_role("button", name="Make the video").click()
    assert re.fullmatch(r"doorway_seed_\d+_0\.00_s_to_0\.04_s\.webm", download.value.suggested_filename)
    download.value.save_as(tmp_path / "video.webm")
    video = (tmp_path / "video.webm").read_bytes()
    assert video.startswith(b"\x1a\x45\xdf\xa3")  # a file of Matroska, which WebM is
    decoded = """async (video) => {
        const player = Object.assign(document.createElement("video"), { src: video, muted: true });
        await new Promise((onloadeddata, onerror) => Object.assign(player, { onloadeddata, onerror }));
        return [player.duration, player.videoWidth > 100, player.videoHeight > 100];
    }"""
    player = users.new(scene=False)
    player.goto("about:blank")
    found = player.evaluate(decoded, f"data:video/webm;base64,{b64encode(video).decode()}")
    assert found == [pytest.approx(2 / 30, abs=0.001), True, True]


@pytest.mark.slow
@pytest.mark.scene
def test_a_video_shows_a_stretch_of_the_run_in_its_own_time(pages: Callable[..., Page], users: Users, tmp_path: Path) -> None:
    page = pages(width=560, height=400)
    element = page.wait_for_selector("iframe[title='3D view'][src^='/viser/']", state="attached", timeout=PATIENCE)
    frame = element.content_frame() if element is not None else None
    assert frame is not None
    frame.wait_for_function("() => window.scene?.picture && window.scene.drawnTime() === 0", timeout=PATIENCE)
    button = page.get_by_role("button", name="Make a video of the 3D view")
    dialog = page.get_by_role("dialog", name="Video of the 3D view")
    make = dialog.get_by_role("button", name="Make the video")
    loaded = "(name) => performance.getEntriesByType('resource').some((one) => one.name.endsWith(name))"
    assert page.evaluate(loaded, "/panels/scene.js")
    assert not page.evaluate(loaded, "/mediabunny.js")  # only when a video is made
    button.click()
    expect(dialog).to_contain_text("run it first")
    assert page.evaluate(loaded, "/mediabunny.js")
    page.keyboard.press("Escape")

    def order(command: str) -> None:
        page.evaluate(f"async () => (await part('server.js')).sendCommand({command})")

    order("{ type: 'step', ticks: 60 }")
    shows(page, "#time", r"t = 0\.60 s")
    order("{ type: 'seek', time: 0.5 }")
    until(page, lambda: frame.evaluate("() => window.scene.drawnTime()") == 0.5)
    picture = frame.evaluate("() => window.scene.picture(1).toDataURL()")
    order("{ type: 'seek', time: 0.4 }")

    button.click()
    first, last = (dialog.get_by_role("textbox", name=re.compile(f"^{name}")) for name in ("From", "To"))
    expect(first).to_have_value("0.00")
    expect(last).to_have_value("0.60")
    expect(dialog).to_contain_text("19 pictures, 0.63 s of video")
    for start, end, speed, wrong in (
        ("", "0.6", "1", "must be a time, such as 1.5 or 1:15:12.3"),
        ("0.5", "0.5", "1", "must be later than the first time, 0.50 s"),
        ("0", "0.7", "1", "must be from 0 to 0.60 s, which the run has reached"),
    ):
        first.fill(start)
        last.fill(end)
        dialog.get_by_label("Speed").select_option(speed)
        make.click()
        expect(dialog.get_by_role("alert")).to_contain_text(wrong)

    first.fill("0.3")
    last.fill("0.6")
    expect(dialog).to_contain_text("10 pictures, 0.33 s of video")
    with page.expect_download() as download:
        make.click()
    assert re.fullmatch(r"doorway_seed_\d+_0\.30_s_to_0\.60_s\.webm", download.value.suggested_filename)
    download.value.save_as(tmp_path / "video.webm")
    expect(dialog).to_have_count(0)
    shows(page, "#time", r"t = 0\.40 s")

    video = f"data:video/webm;base64,{b64encode((tmp_path / 'video.webm').read_bytes()).decode()}"
    player = users.new(scene=False)
    player.goto("about:blank")
    found = player.evaluate(DECODED, [video, picture, 10])
    width, height = frame.evaluate("() => [innerWidth, innerHeight]")
    assert found["size"] == [width // 2 * 2, height // 2 * 2]
    assert found["duration"] == pytest.approx(1 / 3, abs=0.001)
    assert found["different"] == 10
    assert found["off"].index(min(found["off"])) == 6  # the picture of 0.5 s
    assert min(found["off"]) < 3

    button.click()
    dialog.get_by_label("Speed").select_option("0.25")
    make.click()
    expect(dialog.get_by_role("status")).to_contain_text(re.compile("[1-9] of 73 pictures"))
    page.keyboard.press("Escape")
    shows(page, "#time", r"t = 0\.40 s")
    button.click()
    make.click()
    order("{ type: 'restart' }")
    expect(dialog.get_by_role("alert")).to_contain_text("There is no video: the run was restarted")
    page.keyboard.press("Escape")
    page.evaluate("() => delete window.VideoEncoder")
    button.click()
    expect(dialog).to_contain_text("This browser cannot make videos")


def test_times_of_which_no_video_can_be_made_are_named(blank: Page) -> None:
    too_long = "async (texts) => (await part('video/dialog.js')).problemsOf(texts, 2000)"
    assert blank.evaluate(too_long, {"begin": "0", "end": "600", "speed": "1"}) == {}
    assert "at most 10 minutes" in blank.evaluate(too_long, {"begin": "0", "end": "600", "speed": "0.5"})["end"]

    wrong = "async (texts) => (await part('video/dialog.js')).problemsOf(texts, 5000)"
    assert blank.evaluate(wrong, {"begin": "1:20:00", "end": "2:00:00", "speed": "1"})["end"] == (
        "must be from 0 to 1:23:20.00, which the run has reached (got 2:00:00)"
    )
    assert blank.evaluate(wrong, {"begin": "1:20:00", "end": "1:10:00", "speed": "1"})["end"] == (
        "must be later than the first time, 1:20:00.00 (got 1:10:00)"
    )
