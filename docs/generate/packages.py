"""Draws which package imports which, from the import statements of the source files."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from graphlib import TopologicalSorter
from html import escape
from itertools import pairwise
from pathlib import Path

ROOT = Path(__file__).parents[2]
ROW, BOX, GAP = 84, 34, 18
ROUNDS = 8
"""How often the order of the boxes is improved."""

Node = str | tuple[str, str, int]
"""A part, or the place where a line passes a floor."""


@cache
def imports() -> Mapping[str, frozenset[str]]:
    """Returns every part of the library, and the server, with the parts that it imports; imports inside functions count, too.

    A part is a file or a folder of `actr3d`, without the two that only start it.
    """
    entries = [entry for entry in (ROOT / "actr3d").iterdir() if entry.suffix == ".py" or (entry / "__init__.py").exists()]
    places = {entry.stem: entry for entry in sorted(entries) if not entry.name.startswith("__")}
    places["workbench"] = ROOT / "workbench"
    found = {part: frozenset(_imported(place, places) - {part}) for part, place in places.items()}
    return {part: found[part] for part in TopologicalSorter(found).static_order()}


def _imported(place: Path, parts: Mapping[str, Path]) -> set[str]:
    """Returns the parts that the files of a part import."""
    names: set[str] = set()
    for file in [place] if place.is_file() else place.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            names.update(_names(node))
    return {part for part in parts for name in names if name == part or f"{name}.".startswith(f"actr3d.{part}.")}


def _names(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
        yield node.module
        yield from (f"{node.module}.{alias.name}" for alias in node.names)


def _floors(graph: Mapping[str, frozenset[str]]) -> list[list[str]]:
    """Returns the parts floor by floor: each stands above everything that it imports."""
    height: dict[str, int] = {}
    for part, below in graph.items():  # in an order in which what is imported comes first
        height[part] = max((height[other] + 1 for other in below), default=0)
    return [[part for part in graph if height[part] == floor] for floor in range(max(height.values()) + 1)]


def _direct(graph: Mapping[str, frozenset[str]]) -> Iterator[tuple[str, str]]:
    """Yields the imports that do not follow from others, so that the drawing can be read."""
    reach: dict[str, set[str]] = {}
    for part, below in graph.items():
        reach[part] = set(below).union(*(reach[other] for other in below))
        yield from ((part, other) for other in below if not any(other in reach[between] for between in below))


def diagram() -> str:
    """Returns the diagram of the packages as a figure with an SVG."""
    graph = imports()
    floors, lines = _layout(graph)
    widths = {node: 24 + 8.4 * len(node) if isinstance(node, str) else 10 for floor in floors for node in floor}
    rows = [sum(widths[node] + GAP for node in floor) - GAP for floor in floors]
    width, height = max(rows) + 2 * GAP, ROW * len(floors) - ROW + BOX + 2 * GAP
    places: dict[Node, tuple[float, float]] = {}
    for number, (floor, row) in enumerate(zip(floors, rows, strict=True)):
        x = (width - row) / 2
        for node in floor:
            places[node] = (x + widths[node] / 2, height - GAP - BOX - ROW * number)
            x += widths[node] + GAP
    paths = [_curve([places[node] for node in line]) for line in lines]
    boxes = [
        f"<g><title>{escape(part)} imports {escape(', '.join(sorted(graph[part])) or 'nothing of the project')}</title>"
        f'<rect x="{x - widths[part] / 2:.0f}" y="{y:.0f}" width="{widths[part]:.0f}" height="{BOX}" rx="6"/>'
        f'<text x="{x:.0f}" y="{y + BOX / 2:.0f}">{escape(part)}</text></g>'
        for part in graph
        for x, y in [places[part]]
    ]
    return (
        f'<figure><svg class="packages" viewBox="0 0 {width:.0f} {height}" role="img" aria-label="Which package imports which">'
        f"{''.join(paths)}{''.join(boxes)}</svg><figcaption>Each package imports only packages below it. Lines that follow from other "
        "lines are left out.</figcaption></figure>"
    )


def _layout(graph: Mapping[str, frozenset[str]]) -> tuple[list[list[Node]], list[list[Node]]]:
    """Returns the nodes floor by floor, from the ground up, in an order with few crossings, and the nodes that each line goes through.

    A line that passes a floor has a node of its own there, so that it goes between the boxes.
    """
    floors: list[list[Node]] = [list(floor) for floor in _floors(graph)]
    level = {node: number for number, floor in enumerate(floors) for node in floor}
    lines: list[list[Node]] = []
    for upper, lower in sorted(_direct(graph)):
        between = [(upper, lower, number) for number in range(level[upper] - 1, level[lower], -1)]
        for node in between:
            floors[node[2]].append(node)
        lines.append([upper, *between, lower])
    joined = [pair for line in lines for pair in pairwise(line)]
    for _ in range(ROUNDS):
        for number in [*range(1, len(floors)), *range(len(floors) - 2, -1, -1)]:
            place = {node: (n + 0.5) / len(floor) for floor in floors for n, node in enumerate(floor)}
            near = {node: [place[b if a == node else a] for a, b in joined if node in (a, b)] for node in floors[number]}
            floors[number].sort(key=lambda node: sum(near[node]) / len(near[node]) if near[node] else place[node])
    return floors, lines


def _curve(points: Sequence[tuple[float, float]]) -> str:
    """Returns a smooth line from the bottom of the first box, past those between, to the top of the last one."""
    text = f"M{points[0][0]:.0f} {points[0][1] + BOX:.0f}"
    for (x1, y1), (x2, y2) in pairwise(points):
        bend = (y2 - y1 - BOX) / 2
        text += (
            f"C{x1:.0f} {y1 + BOX + bend:.0f} {x2:.0f} {y2 - bend:.0f} {x2:.0f} {y2:.0f}V{y2 + BOX if (x2, y2) != points[-1] else y2:.0f}"
        )
    return f'<path d="{text}"/>'
