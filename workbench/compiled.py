"""Compiled scenes as bytes, and as text that a recording can keep."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import mujoco
import numpy as np
from mujoco import MjModel


def saved(model: MjModel) -> bytes:
    """Returns a compiled scene as MuJoCo saves it."""
    image = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, image)
    return image.tobytes()


def loaded(image: bytes) -> MjModel:
    """Returns a compiled scene that MuJoCo has saved."""
    kind: Any = MjModel
    return kind.from_binary_path("scene.mjb", {"scene.mjb": image})


def to_text(image: bytes) -> str:
    """Returns bytes as text, packed."""
    return base64.b64encode(zlib.compress(image, 1)).decode("ascii")


def from_text(text: str) -> bytes:
    """Returns the bytes of such a text.

    Raises:
        ValueError: If it is none.
    """
    try:
        return zlib.decompress(base64.b64decode(text))
    except zlib.error as error:
        raise ValueError(f"no compiled scene: {error}") from None
