"""Reads the colours that the 3D view, the retina and the HTML replay share, from `static/scene/palette.json`."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import numpy as np

from workbench.shipped import static


@cache
def palette() -> dict[str, Any]:
    """Returns the colours in the file: of sky and ground by theme, of outlines, of clothes, and of the labels in an agent's view."""
    return json.loads((static() / "scene" / "palette.json").read_text(encoding="utf-8"))


def channels(colour: str) -> tuple[int, int, int]:
    """Returns red, green and blue of a colour such as `#5b7fa6`, each from 0 to 255."""
    red, green, blue = bytes.fromhex(colour.removeprefix("#"))
    return red, green, blue


def label_colours(labels: Any) -> Any:
    """Returns the colours `(n, 3)` of the labels in an agent's view, the same as on the retina."""
    known = np.array([channels(colour) for colour in palette()["labels"]], dtype=np.uint8)
    return known[(np.asarray(labels, dtype=np.int64) - 1) % len(known)]
