"""Computes the 3D positions of the edges that an eye sees, by projecting its view back into space at the seen distances."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from actr3d.camera import EyePose, View

Places = NDArray[np.float64]
"""Points in the world [m], `(..., 3)`."""


def points_of(view: View) -> Places:
    """Returns the points of the two edges of each extent, in the upright frame of the view with the eye as origin [m], `(n, 2, 3)`."""
    extents, parameters = view.extents, view.parameters
    v = _tangent(1 - (2 * extents["row"] + 1) / parameters.rows, parameters.vertical_fov, view)[:, None]
    u = _tangent(2 * np.stack((extents["x1"], extents["x2"]), axis=1) - 1, parameters.horizontal_fov, view)
    deep = np.stack((extents["d1"], extents["d2"]), axis=1) / np.sqrt(1 + u * u + v * v)
    right, up, forward = view.axes
    return deep[..., None] * (u[..., None] * right + v[..., None] * up + forward)


def contours_of(view: View) -> Places:
    """Returns the lines along the edges of objects, including where objects begin and end, `(n, 2, 3)`.

    They are in the upright frame of the view, with the eye as origin [m].
    """
    points = points_of(view)
    by_row: dict[int, dict[int, list[int]]] = {}
    for number, (row, label) in enumerate(zip(view.extents["row"].tolist(), view.extents["label"].tolist(), strict=True)):
        by_row.setdefault(row, {}).setdefault(label, []).append(number)
    lines: list[Places] = []
    empty: dict[int, list[int]] = {}
    for row in range(-1, view.rows):
        above, below = by_row.get(row, empty), by_row.get(row + 1, empty)
        for label in (*above, *(label for label in below if label not in above)):
            upper, lower = above.get(label, []), below.get(label, [])
            if len(upper) == len(lower):
                lines += [points[[one, other], side] for one, other in zip(upper, lower, strict=True) for side in (0, 1)]
            else:  # where an object begins, ends or splits, it is unknown which edge continues which
                lines += [points[number] for number in (*upper, *lower)]
    return np.array(lines).reshape(-1, 2, 3)


def into_world(points: Places, pose: EyePose) -> Places:
    """Converts points from the upright frame of an eye to the world frame, given the pose of that eye."""
    c, s = math.cos(pose.heading), math.sin(pose.heading)
    return points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]]) + np.array(pose[:3])


def _tangent(part: Any, fov: float, view: View) -> Any:
    """Returns tangents for fractions of half the screen (-1 to 1); on a retina, equal fractions are equal parts of the cortex."""
    most, parameters = math.tan(fov / 2), view.parameters
    if not parameters.retinotopic:
        return part * most
    span = math.log1p(math.atan(most) / parameters.e2)
    return np.copysign(np.tan(parameters.e2 * np.expm1(np.abs(part) * span)), part)
