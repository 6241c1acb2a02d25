"""Makes the page of each model: its docstring, what it prints, a picture of its run, and its source.

What a run with seed 1 prints and does is read from the golden traces of the tests, which compare them with the models.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import run_picture

ROOT = Path(__file__).parents[2]
MODELS = ROOT / "models"
GOLDEN = ROOT / "tests" / "golden"
SCREENSHOTS = {"aperture_passage": "workbench.png", "doorway": "doorway.png", "predictive_walker": "predictive_walker.png"}
"""By model, a picture of its run in the workbench; `docs/screenshot.py` takes them."""
LONGEST_OUTPUT = 40


@dataclass(frozen=True)
class ModelPage:
    """The page of one model."""

    file: Path

    @property
    def address(self) -> str:
        """The address of the page in the manual."""
        return f"models/{self.name}.md"

    @property
    def name(self) -> str:
        """The path of the model below `models`, without its ending; folders are joined by dashes."""
        return self.file.relative_to(MODELS).with_suffix("").as_posix().replace("/", "-")

    @property
    def title(self) -> str:
        """The first line of its docstring."""
        return self._text.partition("\n")[0].rstrip(".")

    @property
    def _text(self) -> str:
        return ast.get_docstring(ast.parse(self.file.read_text(encoding="utf-8"))) or ""

    def markdown(self) -> str:
        """Returns the page."""
        path = self.file.relative_to(ROOT).as_posix()
        trace = run_picture.read(GOLDEN / self.file.relative_to(MODELS).with_suffix(".jsonl"))
        described = re.sub(r"^(.+)\n-{3,}$", r"## \1", self._text.partition("\n")[2].strip(), flags=re.MULTILINE)
        parts = [f"---\ntitle: {self.name.replace('-', '/')}\n---\n\n# {self.title}", f"`{path}`", described, "## A run"]
        if self.name in SCREENSHOTS:
            parts.append(f"![The run in the workbench](../images/{SCREENSHOTS[self.name]})")
        parts += [
            f"The beginning of a run with seed 1. Hold the pointer over a bar to see its time and content.\n\n{run_picture.draw(trace)}"
        ]
        printed = run_picture.printed(trace)
        if printed:
            more = ["..."] if len(printed) > LONGEST_OUTPUT else []
            lines = "\n".join([*printed[:LONGEST_OUTPUT], *more])
            parts += [f"`actr3d run {path} --seed 1` prints:", f"```text\n{lines}\n```"]
        parts += ["## Source", f"```python\n{self.file.read_text(encoding='utf-8').strip()}\n```"]
        return "\n\n".join(parts) + "\n"


@cache
def pages() -> tuple[ModelPage, ...]:
    """Returns the page of every model, those of the folder itself first."""
    return tuple(ModelPage(file) for file in sorted(MODELS.rglob("*.py"), key=lambda file: (len(file.parts), file)))


def index() -> str:
    """Returns the page that lists the models: `models/README.md`, with links to the pages of the manual."""
    text = (MODELS / "README.md").read_text(encoding="utf-8")
    names = {page.file.relative_to(MODELS).as_posix(): f"{page.name}.md" for page in pages()}
    return re.sub(r"\]\(([\w/]+\.py)\)", lambda found: f"]({names[found[1]]})", text)
