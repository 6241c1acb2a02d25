"""Reads the colours that the 3D view and the HTML replay share, from `static/scene/colours.json`."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

from workbench.shipped import static


@cache
def palette() -> dict[str, Any]:
    """Returns the colours in the file: of sky and ground by theme, of outlines and of clothes."""
    return json.loads((static() / "scene" / "colours.json").read_text(encoding="utf-8"))


def channels(colour: str) -> tuple[int, int, int]:
    """Returns red, green and blue of a colour such as `#5b7fa6`, each from 0 to 255."""
    red, green, blue = bytes.fromhex(colour.removeprefix("#"))
    return red, green, blue
