"""The view that a camera returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, cast
from zlib import crc32

import numpy as np
from annotated_types import Ge
from numpy.random import Generator
from numpy.typing import NDArray

from actr3d.camera.parameters import CameraParameters, optics_of
from actr3d.configuration import checked
from actr3d.errors import CameraError, alternatives

EDGES = ("x1", "x2", "d1", "d2", "a1", "a2")
"""The fields about the two edges of an extent."""

NOISY = (*EDGES, "xn", "dn")
"""The fields that noise can be added to."""


@dataclass(frozen=True, eq=False)
class View:
    """The visible extents at one moment: for each scan line, which object is seen from where to where.

    An extent runs from `x1` to `x2` on the screen (0 left, 1 right), on the scan line at `y` (0 top, 1 bottom); `d1` and
    `d2` are the distances from the eye to the object at its two edges [m], `a1` and `a2` the angles between the line of
    sight and the directions to them [degrees]. Labels distinguish objects and carry no other information. An object that is
    split by a nearer one has two extents.
    """

    parameters: CameraParameters
    """The camera's parameters: the field of view, and the screen on which `x` and `y` are given."""
    extents: NDArray[Any]
    """See `as_array`."""
    axes: NDArray[np.float64]
    """The orientation of the eye: its right, up and forward axes as rows, in an upright frame (ahead, left, up), `(3, 3)`."""

    @property
    def rows(self) -> int:
        """The number of scan lines, including empty ones."""
        return self.parameters.rows

    @property
    def optics(self) -> NDArray[Any]:
        """The parameters as the compiled functions of `actr3d.camera.kernel` expect them, an array of length 1."""
        return optics_of(self.parameters)

    def as_array(self) -> NDArray[Any]:
        """Returns all extents as one read-only array, ordered by row from the top, and within a row from left to right.

        Its fields are `row`, `label`, `y`, `x1`, `x2`, `d1`, `d2`, `a1` and `a2`; and `xn` and `dn`, the screen position of the point
        between the edges that is nearest on the ground, and its distance from the eye [m].
        """
        return self.extents

    def as_dict(self) -> dict[float, dict[int, list[list[float]]]]:
        """Returns `{y: {label: [[x1, x2, d1, d2, a1, a2], ...]}}`, a new dict at each call; empty rows are included."""
        ys = [(row + 0.5) / self.rows for row in range(self.rows)]
        view: dict[float, dict[int, list[list[float]]]] = {y: {} for y in ys}
        for row, label, _, *extent in self.extents.tolist():
            view[ys[row]].setdefault(label, []).append(extent[: len(EDGES)])
        return view

    def __repr__(self) -> str:
        return f"<View of {self.rows} rows: {len(self.extents)} extents>"

    def summary(self) -> dict[str, int]:
        """Returns what a trace and a recording keep of the view: the number of rows and extents, and the CRC-32 of all its bytes.

        The view itself can be recomputed exactly from the state of the world.
        """
        return {"rows": self.rows, "extents": len(self.extents), "crc32": crc32(self.extents.tobytes())}

    def with_noise(self, sd: Any, random: Generator) -> View:
        """Returns the view with Gaussian noise on some fields of all extents.

        Args:
            sd: Standard deviations by field, in the field's unit: `{"d1": 0.05, "d2": 0.05, "dn": 0.05}`. Fields that are not named
                stay exact.
            random: The random number generator.

        Raises:
            CameraError: If they are not given by field, or there is no such field.
            ConfigurationError: If one of them is not a number >= 0.
        """
        if not isinstance(sd, Mapping):
            fields = ", ".join(NOISY)
            raise CameraError(f"noise of view: its fields have different units; give them by name: {{'d1': {sd}}}; fields: {fields}")
        extents = self.extents.copy()
        for field, of in cast("Mapping[str, float]", sd).items():
            if field not in NOISY:
                raise CameraError(f"noise of view: no field '{field}'{alternatives(field, NOISY)}")
            extents[field] += checked(of, Annotated[float, Ge(0)], f"noise of view: {field}") * random.standard_normal(len(extents))
        extents.flags.writeable = False
        return replace(self, extents=extents)
