"""Draws the beginning of a run from its trace: a row for each production, buffer or planning level, and what was printed, over time."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from typing import Any

Event = Mapping[str, Any]

LEVELS = ("planning_unit", "unit_task", "method", "operator")
MAX_FIRINGS = 12
"""A picture ends with this firing, unless the agent has planning units: then it shows the whole run."""
WIDTH, LEFT, RIGHT, ROW, TOP = 900, 190, 12, 24, 8
CHARACTER = 6.4
"""The average width of a character at the font size of the labels [px]."""


@dataclass
class _Row:
    name: str
    kind: str
    bars: list[tuple[float, float, str]] = field(default_factory=list[tuple[float, float, str]])
    open: tuple[float, str] | None = None

    def begin(self, time: float, text: str) -> None:
        self.end(time)
        self.open = (time, text)

    def end(self, time: float) -> None:
        if self.open is not None:
            self.bars.append((self.open[0], time, self.open[1]))
        self.open = None


def read(file: Path) -> list[Event]:
    """Returns the events of a trace that was written as JSON, one a line, without the result at its end."""
    lines = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    return [line for line in lines if "kind" in line]


def printed(events: Sequence[Event]) -> list[str]:
    """Returns the lines that the model printed."""
    return [event["data"]["text"] for event in events if event["kind"] == "output"]


def draw(events: Sequence[Event]) -> str:
    """Returns the picture as a figure with an SVG."""
    planned = any(event["kind"] in LEVELS for event in events)
    end = events[-1]["time"] if planned else _end(events)
    rows = _rows([event for event in events if event["time"] <= end], end, planned=planned)
    marks = [event for event in events if event["kind"] == "output" and event["time"] <= end]
    height = TOP + ROW * (len(rows) + bool(marks)) + 30
    scale = (WIDTH - LEFT - RIGHT) / (end or 1)
    parts = [_axis(end, scale, height)]
    for number, row in enumerate(rows):
        parts += _draw_row(row, TOP + ROW * number, scale)
    if marks:
        parts += _draw_output(marks, TOP + ROW * len(rows), scale)
    about = f"The first {end:.4g} s of the run" if end < events[-1]["time"] else f"The whole run of {end:.4g} s"
    return (
        f'<figure><svg class="run" viewBox="0 0 {WIDTH} {height}" role="img" aria-label="{about}">{"".join(parts)}</svg>'
        f"<figcaption>{about}.</figcaption></figure>"
    )


def _end(events: Sequence[Event]) -> float:
    """Returns when a picture ends: with one of the first firings, or with the last event that shows."""
    fired = [event["time"] for event in events if event["kind"] == "fire"]
    if len(fired) > MAX_FIRINGS:
        return fired[MAX_FIRINGS - 1]
    return max((event["time"] for event in events if event["kind"] in ("fire", "output", "buffer")), default=0.0)


def _rows(events: Sequence[Event], end: float, *, planned: bool) -> list[_Row]:
    rows: dict[tuple[str, str], _Row] = {}
    several = len({event["source"] for event in events if event["kind"] == "fire"}) > 1

    def row(kind: str, source: str, name: str) -> _Row:
        return rows.setdefault((source, name), _Row(name, kind))

    for event in events:
        kind, source, time, data = event["kind"], event["source"], event["time"], event["data"]
        if planned:
            if kind in LEVELS:
                level = row(kind, source, kind.replace("_", " "))
                if data["what"] in ("begun", "resumed", "going on"):
                    level.begin(time, data["name"])
                else:
                    level.end(time)
        elif kind in ("select", "fire", "changed"):
            shown = row("production", source, f"{source}.{data['production']}" if several else data["production"])
            if kind == "select":
                shown.begin(time, data["production"])
            else:
                shown.end(time)
        elif kind == "buffer":
            chunk = data["chunk"]
            held = row("buffer", source, source)
            if chunk is None:
                held.end(time)
            else:
                held.begin(time, " ".join(value if slot.isdigit() else f"{slot}:{value}" for slot, value in chunk.items()))
    for one in rows.values():
        one.end(end)
        one.bars = [bar for bar in one.bars if bar[1] > bar[0]]
    order = {"production": 0, "planning_unit": 1, "unit_task": 2, "method": 3, "operator": 4, "buffer": 5}
    return sorted((one for one in rows.values() if one.bars), key=lambda one: order[one.kind])


def _fitting(text: str, width: float) -> str:
    """Returns as much of a text as fits into a width."""
    room = int(width / CHARACTER)
    return text if len(text) <= room else f"{text[: room - 1]}…" if room > 3 else ""


def _draw_row(row: _Row, y: float, scale: float) -> list[str]:
    name = row.name if len(row.name) <= 26 else f"{row.name[:25]}…"
    shown = f"<title>{escape(row.name)}</title>{escape(name)}"
    parts = [f'<g class="{row.kind}"><text class="name" x="{LEFT - 8}" y="{y + ROW / 2:.0f}">{shown}</text>']
    for begin, end, text in row.bars:
        x, width = LEFT + begin * scale, max((end - begin) * scale - 1, 1.5)
        moment = f"{begin:.3f} to {end:.3f} s: {text}"
        label = "" if row.kind == "production" else _fitting(text, width - 6)
        parts.append(
            f'<g><title>{escape(moment)}</title><rect x="{x:.1f}" y="{y + 3}" width="{width:.1f}" height="{ROW - 6}" rx="3"/>'
            f'<text x="{x + 4:.1f}" y="{y + ROW / 2:.0f}">{escape(label)}</text></g>'
        )
    return [*parts, "</g>"]


def _draw_output(marks: Sequence[Event], y: float, scale: float) -> list[str]:
    parts = [f'<g class="output"><text class="name" x="{LEFT - 8}" y="{y + ROW / 2:.0f}">printed</text>']
    for number, event in enumerate(marks):
        x = LEFT + event["time"] * scale
        following = marks[number + 1]["time"] * scale + LEFT if number + 1 < len(marks) else WIDTH
        text = event["data"]["text"]
        parts.append(
            f'<g><title>{event["time"]:.3f} s: {escape(text)}</title><rect x="{x - 1:.1f}" y="{y + 3}" width="2" height="{ROW - 6}"/>'
            f'<text x="{x + 4:.1f}" y="{y + ROW / 2:.0f}">{escape(_fitting(text, following - x - 6))}</text></g>'
        )
    return [*parts, "</g>"]


def _axis(end: float, scale: float, height: int) -> str:
    """Returns the axis of time, with round numbers."""
    step = next((size for size in _steps() if end / size <= 10), end)
    ticks = [n * step for n in range(int(end / step + 1e-6) + 1)] if step else [0.0]
    parts = [
        f'<line x1="{LEFT + t * scale:.1f}" x2="{LEFT + t * scale:.1f}" y1="{TOP}" y2="{height - 22}"/>'
        f'<text x="{LEFT + t * scale:.1f}" y="{height - 10}">{t:.6g}{" s" if t == ticks[-1] else ""}</text>'
        for t in ticks
    ]
    return f'<g class="axis">{"".join(parts)}</g>'


def _steps() -> list[float]:
    return [m * 10.0**e for e in range(-4, 8) for m in (1, 2, 5)]
