"""Converts compiled scenes to bytes, and to text that a recording can store."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import mujoco
import numpy as np
from mujoco import MjModel


def to_bytes(model: MjModel) -> bytes:
    """Returns a compiled scene in MuJoCo's binary format (MJB)."""
    image = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, image)
    return image.tobytes()


def from_bytes(image: bytes) -> MjModel:
    """Loads a compiled scene from MuJoCo's binary format."""
    kind: Any = MjModel
    return kind.from_binary_path("scene.mjb", {"scene.mjb": image})


def to_text(image: bytes) -> str:
    """Returns bytes as text, compressed and base64-encoded."""
    return base64.b64encode(zlib.compress(image, 1)).decode("ascii")


def from_text(text: str) -> bytes:
    """Returns the bytes that `to_text` has encoded.

    Raises:
        ValueError: If the text is not such an encoding.
    """
    try:
        return zlib.decompress(base64.b64decode(text))
    except zlib.error as error:
        raise ValueError(f"no compiled scene: {error}") from None
