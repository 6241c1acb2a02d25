"""The eye of a camera: its position and viewing direction in the world."""

from __future__ import annotations

import math
from typing import Any, Literal

import mujoco
import numpy as np
from mujoco import MjData, MjModel
from numpy.typing import NDArray

from actr3d.errors import CameraError, did_you_mean

Kind = Literal["camera", "site", "body"]


def names_of(mj_model: MjModel, kind: str) -> list[str]:
    """Returns the names of all objects of a kind ('camera', 'site', 'body', 'geom'), ordered by their ids."""
    enum = getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}")
    count = {"camera": mj_model.ncam, "site": mj_model.nsite, "body": mj_model.nbody, "geom": mj_model.ngeom}[kind]
    return [mujoco.mj_id2name(mj_model, enum, i) or "" for i in range(count)]


class Eye:
    """A camera, a site or a body of a MuJoCo model, used as the viewpoint.

    A camera looks as in MuJoCo, along its negative z axis with y up. For sites and bodies, x points forward and z up.
    """

    def __init__(self, mj_model: MjModel, kind: Kind, name: str) -> None:
        """Finds the eye in the model.

        Raises:
            CameraError: If the model has no object of this kind and name.
        """
        names = names_of(mj_model, kind)
        if name not in names or not name:
            known = [known for known in names if known]
            there = f"; there are: {', '.join(known)}" if known else f"; this model has no named {kind}"
            raise CameraError(f"GeometricCamera: no {kind} {name!r}{did_you_mean(str(name), known) or there}")
        self.kind: Kind = kind
        """What it is."""
        self.name = name
        """Its name in the model."""
        self._id = names.index(name)
        bodies = {"camera": mj_model.cam_bodyid, "site": mj_model.site_bodyid, "body": range(mj_model.nbody)}
        self.body = int(bodies[kind][self._id])
        """The id of the body that the eye belongs to."""

    def axes(self, mj_data: MjData) -> NDArray[np.float64]:
        """Returns the right, up and forward axes and the position [m], as rows in the world frame, `(4, 3)`.

        Raises:
            CameraError: If the pose was not computed yet, or is not finite.
        """
        place, turn = self._pose(mj_data)
        numbers, at = turn.tolist(), place.tolist()  # to calculate with small arrays takes longer
        x, y, z = numbers[0::3], numbers[1::3], numbers[2::3]
        length = sum(part * part for part in numbers)
        if not math.isfinite(length + sum(at)):
            raise CameraError(f"GeometricCamera: the pose of the {self.kind} '{self.name}' is not a number; did the physics diverge?")
        if abs(length - 3.0) > 1e-6:
            raise CameraError(
                f"GeometricCamera: the pose of the {self.kind} '{self.name}' was not computed; "
                "call mujoco.mj_forward, or mj_kinematics, mj_comPos and mj_camlight, before looking"
            )
        if self.kind == "camera":
            return np.array((x, y, [-part for part in z], at))
        return np.array(([-part for part in y], z, x, at))

    def _pose(self, mj_data: MjData) -> tuple[Any, Any]:
        if self.kind == "camera":
            return mj_data.cam_xpos[self._id], mj_data.cam_xmat[self._id]
        if self.kind == "site":
            return mj_data.site_xpos[self._id], mj_data.site_xmat[self._id]
        return mj_data.xpos[self._id], mj_data.xmat[self._id]
