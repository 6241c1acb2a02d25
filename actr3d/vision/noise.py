"""Noise of vision: in the directions of edges, and in distances."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.random import PCG64, Generator
from numpy.typing import NDArray

from actr3d.camera import CameraParameters, View

Floats = NDArray[np.float64]
MIN_SEEN = 0.05
"""Least seen fraction of a distance, however large the noise."""


def blurred(view: View, edges: float, distances: float, seed: int) -> View:
    """Returns a view with noise: one error for all left edges of an object, one for its right edges, and one for all distances.

    So straight edges stay straight, measurements over many rows are no more exact, and the two sides of an opening stay at the
    same depth: otherwise its apparent width would grow with distance.

    Args:
        view: The exact one.
        edges: The standard deviation of the directions of edges [rad].
        distances: That of all distances in this view, as a fraction.
        seed: The seed of the noise.
    """
    if not len(view.extents):
        return view
    numbers = Generator(PCG64(seed))
    part = max(MIN_SEEN, 1 + distances * float(numbers.standard_normal()))
    # Copied as bytes: numpy copies structured arrays field by field.
    extents = np.frombuffer(bytearray(view.extents.tobytes()), view.extents.dtype)
    for d in ("d1", "d2", "dn"):
        extents[d] *= part
    if edges > 0:
        left, right = edges * numbers.standard_normal((int(extents["label"].max()) + 1, 2))[extents["label"]].T
        for x, angle in (("x1", left), ("x2", right), ("xn", 0.5 * (left + right))):
            extents[x] = _moved(extents[x], angle, view.parameters)
    extents.flags.writeable = False
    return replace(view, extents=extents)


def _moved(x: Floats, angle: Floats, parameters: CameraParameters) -> Floats:
    """Returns places on the screen moved to the right by angles [rad]; places beyond the screen stay at its border."""
    half, part = parameters.horizontal_fov / 2, 2 * x - 1
    if parameters.retinotopic:
        span = math.log1p(half / parameters.e2)
        at = np.sign(part) * parameters.e2 * np.expm1(np.abs(part) * span)
    else:
        at = np.arctan(part * math.tan(half))
    at = np.clip(at + angle, -half, half)
    if parameters.retinotopic:
        part = np.sign(at) * np.log1p(np.abs(at) / parameters.e2) / math.log1p(half / parameters.e2)
    else:
        part = np.tan(at) / math.tan(half)
    return np.where((x > 0) & (x < 1), 0.5 + 0.5 * part, x)  # at the screen's border there is no edge
