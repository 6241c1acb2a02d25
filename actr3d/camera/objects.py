"""Groups geoms into objects."""

from __future__ import annotations

import numpy as np
from mujoco import MjModel
from numpy.typing import NDArray

from actr3d.camera.eye import names_of
from actr3d.camera.kernel.layout import BACKGROUND, PLANE, UNSEEN
from actr3d.camera.parameters import CameraParameters
from actr3d.errors import CameraError, did_you_mean


def objects_of(mj_model: MjModel, own_body: int, parameters: CameraParameters) -> NDArray[np.int64]:
    """Returns the object number of each geom, counted from 1, or `UNSEEN` or `BACKGROUND`, `(n,)`.

    An object is a top-level body of the world with all its descendants, or one geom that belongs to the world itself.
    The eye's own body is left out, or each of its parts is an object.

    Args:
        mj_model: The MuJoCo model.
        own_body: The id of the body that the eye belongs to, 0 for the world.
        parameters: The camera's parameters.

    Raises:
        CameraError: If `background` names a geom that does not exist.
    """
    background = _background(mj_model, parameters)
    own_root = int(mj_model.body_rootid[own_body])
    numbers: dict[tuple[str, int], int] = {}
    objects = np.zeros(mj_model.ngeom, np.int64)
    for geom in range(mj_model.ngeom):
        body = int(mj_model.geom_bodyid[geom])
        root = int(mj_model.body_rootid[body])
        own = own_root != 0 and root == own_root
        if own and not parameters.own_limbs:
            objects[geom] = UNSEEN
        elif geom in background:
            objects[geom] = BACKGROUND
        else:
            thing = ("body", body if own else root) if body else ("geom", geom)
            objects[geom] = numbers.setdefault(thing, len(numbers) + 1)
    return objects


def _background(mj_model: MjModel, parameters: CameraParameters) -> set[int]:
    """Returns the ids of the geoms that hide others but are not reported."""
    if parameters.background is None:
        return {geom for geom in range(mj_model.ngeom) if mj_model.geom_type[geom] == PLANE}
    names = names_of(mj_model, "geom")
    for name in parameters.background:
        if name not in names or not name:
            known = [known for known in names if known]
            raise CameraError(f"CameraParameters.background: no geom {name!r}{did_you_mean(name, known)}")
    return {names.index(name) for name in parameters.background}
