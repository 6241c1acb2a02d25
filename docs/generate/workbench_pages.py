"""Lists the manual's pages of the parts of the workbench: those of the panels come from `static/panels`."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PANEL = re.compile(r'^export const panel = \{\s*id: "(\w+)",\s*title: "[^"]+",\s*order: ([\d.]+)', re.MULTILINE)


def pages() -> list[str]:
    """Returns their addresses: the bar, the 3D view, the panels in the order of their tabs, the timeline."""
    found = [PANEL.search(file.read_text(encoding="utf-8")) for file in (ROOT / "static" / "panels").glob("*.js")]
    panels = sorted((float(panel[2]), panel[1]) for panel in found if panel)
    return [f"workbench/{name}.md" for name in ("bar", "scene", *(name for _, name in panels), "timeline")]


def table() -> str:
    """Returns the table of these pages, each with its first sentence."""
    rows = ["| Part of the page | What it has |", "|---|---|"]
    for address in pages():
        title, text = (ROOT / "docs" / address).read_text(encoding="utf-8").split("\n\n")[:2]
        sentence = text.replace("\n", " ").partition(". ")[0].rstrip(".")
        rows.append(f"| [{title.removeprefix('# ')}]({Path(address).name}) | {sentence}. |")
    return "\n".join(rows)
