"""Draws which package imports which, from the import statements of the source files."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from functools import cache
from graphlib import TopologicalSorter
from html import escape
from pathlib import Path

ROOT = Path(__file__).parents[2]
WIDTH, ROW, BOX, GAP = 900, 84, 34, 18


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
    floors = _floors(graph)
    height = ROW * len(floors) - ROW + BOX + 2 * GAP
    places: dict[str, tuple[float, float, float]] = {}
    for number, floor in enumerate(floors):
        widths = [24 + 8.4 * len(part) for part in floor]
        x = (WIDTH - sum(widths) - GAP * (len(floor) - 1)) / 2
        for part, width in zip(floor, widths, strict=True):
            places[part] = (x, height - GAP - BOX - ROW * number, width)
            x += width + GAP
    lines = [_line(places[part], places[other]) for part, other in sorted(_direct(graph))]
    boxes = [
        f"<g><title>{escape(part)} imports {escape(', '.join(sorted(graph[part])) or 'nothing of the project')}</title>"
        f'<rect x="{x:.0f}" y="{y:.0f}" width="{width:.0f}" height="{BOX}" rx="6"/>'
        f'<text x="{x + width / 2:.0f}" y="{y + BOX / 2:.0f}">{escape(part)}</text></g>'
        for part, (x, y, width) in places.items()
    ]
    return (
        f'<figure><svg class="packages" viewBox="0 0 {WIDTH} {height}" role="img" aria-label="Which package imports which">'
        f"{''.join(lines)}{''.join(boxes)}</svg><figcaption>Each package imports only packages below it. Lines that follow from other "
        "lines are left out.</figcaption></figure>"
    )


def _line(upper: tuple[float, float, float], lower: tuple[float, float, float]) -> str:
    """Returns a curve from the bottom of a box to the top of another."""
    x1, y1, x2, y2 = upper[0] + upper[2] / 2, upper[1] + BOX, lower[0] + lower[2] / 2, lower[1]
    bend = min(ROW, y2 - y1) / 2
    return f'<path d="M{x1:.0f} {y1:.0f}C{x1:.0f} {y1 + bend:.0f} {x2:.0f} {y2 - bend:.0f} {x2:.0f} {y2:.0f}"/>'
