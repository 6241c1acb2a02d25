"""Adds the built manual to the wheel and to the source distribution, if it has been built (`uv run mkdocs build`)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PLACES = {"wheel": "workbench/manual", "sdist": "build/site"}


class Manual(BuildHookInterface[Any]):
    """Includes `build/site`."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Names the folder and its place in what is built; an editable installation finds it in the repository."""
        site = Path(self.root) / "build" / "site"
        if site.is_dir() and version != "editable":
            build_data["force_include"][str(site)] = PLACES[self.target_name]
