"""Pages that measurements attach: real ones in headless Chromium, or clients that say and hear what a page does."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager, suppress
from typing import Any

import websockets
from websockets.typing import Subprotocol

from tests.helpers.workbench_server import Served

LONGEST = 60.0
"""Nothing that is waited for takes longer [s]."""
CLICKS = """async (count) => {
    const time = document.querySelector("#time"), step = document.querySelector("#step"), taken = [];
    for (let n = 0; n < count; n++) {
        const before = time.textContent;
        const changed = new Promise((done) => {
            const observer = new MutationObserver(() => {
                if (time.textContent === before) return;
                observer.disconnect();
                done(performance.now());
            });
            observer.observe(time, { childList: true, characterData: true, subtree: true });
        });
        const begin = performance.now();
        step.click();
        taken.push((await changed) - begin);
        await new Promise((rest) => setTimeout(rest, 60));
    }
    return taken;
}"""
"""Clicks on step, one time after the other, and returns how long it took each time until the time on the page was another [ms]."""


PANS = """async ([events, pictures]) => {
    const { Lanes } = await part("timeline/lanes.js");
    const { drawTimeline } = await part("timeline/draw.js");
    const { CanvasSurface, scaled } = await part("parts/surface.js");
    const lanes = new Lanes(), hour = 3600, shapes = ["points", "steps", "sum"];
    const slopeOf = (shape) => (shape === "points" ? undefined : 0);
    const series = shapes.map((shape) => ({ name: shape, unit: "", shape, times: [], values: [], slope: slopeOf(shape) }));
    for (let n = 0; n < events; n += 1) {
        const time = (n * hour) / events, { times, values } = series[n % 3];
        lanes.take([Math.round(time * 1e6), `mind.buffer_${n % 10}`, "buffer", { chunk: { 0: `chunk ${n}` } }]);
        times.push(time);
        values.push(n % 3 === 2 ? time / 2 : Math.sin(n));
    }
    const canvas = document.createElement("canvas");
    const surface = new CanvasSurface(scaled(canvas, 900, 260));
    const rows = [...lanes.lanes.values()].map((lane, n) => ({ lane, label: `buffer ${n}`, y: 72 + 18 * n, height: 18 }));
    rows.push({ plot: { title: "numbers", unit: "", series, range: [-1, hour / 2] }, label: "numbers", y: 24, height: 46 });
    const taken = [];
    await new Promise((rest) => setTimeout(rest, 2000)); // what making all that leaves to do is not measured
    for (const span of [10, 100, 1000, hour]) {
        for (let n = 0; n < pictures; n += 1) {
            const from = ((hour - span) * n) / pictures, begin = performance.now();
            const seen = { width: 900, height: 260, column: 100, scroll: 0, span: { from, to: from + span } };
            drawTimeline(surface, { ...seen, layout: { rows }, end: hour, begin: 0 });
            taken.push(performance.now() - begin);
        }
    }
    return taken;
}"""
"""Moves the timeline of a run of an hour with so many events, and a plot of three curves with a value for each, along, at four scales, and
returns the script time of each picture [ms]. It waits two seconds after making the events, which in a run come over an hour."""


class Client:
    """What a page is to the server: a websocket for state and commands.

    Args:
        socket: The websocket.
    """

    def __init__(self, socket: Any) -> None:
        self._socket = socket
        self._number = 0
        self.state: dict[str, Any] = {}
        self.run = 0

    async def say(self, kind: str, **more: Any) -> None:
        """Says something; what comes of it is not waited for."""
        self._number += 1
        await self._socket.send(json.dumps({"id": self._number, "command": {"type": kind, **more}}))

    async def until(self, condition: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
        """Reads until something is true of the newest state; returns that."""
        async with asyncio.timeout(LONGEST):
            while not (self.state and condition(self.state)):
                await self._hear()
        return self.state

    async def restart(self, **more: Any) -> None:
        """Begins a new run; returns when there is a state of it."""
        await self.until(lambda _: True)
        before = self.run
        await self.say("restart", **more)
        await self.until(lambda _: self.run > before)

    async def read_on(self) -> None:
        """Reads all that comes, until the server is gone."""
        with suppress(websockets.ConnectionClosed):
            while True:
                await self._hear()

    async def _hear(self) -> None:
        message = json.loads(await self._socket.recv())
        if message["type"] != "update":
            raise RuntimeError(f"the server refuses: {message}")
        if message["run"] != self.run:
            self.run, self.state = message["run"], {}
        self.state = message.get("state") or self.state


@asynccontextmanager
async def attached(server: Served, session: str) -> AsyncGenerator[Client]:
    """Attaches a client to a session."""
    bearer = {"authorization": f"Bearer {server.token}"}
    async with websockets.connect(f"ws://127.0.0.1:{server.port}/ws", additional_headers=bearer, max_size=None, proxy=None) as socket:
        await socket.send(json.dumps({"type": "attach", "session": session}))
        yield Client(socket)


@asynccontextmanager
async def looking(server: Served, session: str) -> AsyncGenerator[None]:
    """Takes what the 3D view of a session is shown."""
    import viser

    bearer = {"authorization": f"Bearer {server.token}"}
    protocol = [Subprotocol(f"viser-v{viser.__version__}")]
    address = f"ws://127.0.0.1:{server.port}/viser/{session}"
    async with websockets.connect(address, subprotocols=protocol, additional_headers=bearer, max_size=None, proxy=None) as socket:

        async def read_on() -> None:
            with suppress(websockets.ConnectionClosed):
                while True:
                    await socket.recv()

        reading = asyncio.create_task(read_on())
        yield
        reading.cancel()


def opened(server: Served, model: str, **options: Any) -> str:
    """Begins a session, or returns the one that there is with the model."""
    there: list[str] = [one["id"] for one in server.get("/api/sessions").json()["sessions"] if one["model"] == model]
    return there[-1] if there else server.post("/api/sessions", {"model": model, "seed": 1, **options}).json()["id"]


def await_scene(server: Served, session: str) -> None:
    """Waits until a session has a 3D view to look at."""
    end = time.monotonic() + LONGEST
    while not server.get(f"/api/sessions/{session}").json()["session"].get("world"):
        if time.monotonic() > end:
            raise TimeoutError("there is no 3D view")
        time.sleep(0.02)
