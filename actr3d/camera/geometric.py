"""The Geometric Camera: computes a `View` from a MuJoCo model and its current poses."""

from __future__ import annotations

import math
from functools import partial
from typing import Any, Literal

import mujoco
import numpy as np
from mujoco import MjData, MjModel
from numpy.typing import NDArray

from actr3d.camera.eye import Eye, Kind, names_of
from actr3d.camera.kernel.dtypes import EXTENT
from actr3d.camera.kernel.scan import MAX_PIECES_OF_A_PATCH, row_tracer, scan, scene_setter
from actr3d.camera.kernel.scene import room_for_scene
from actr3d.camera.kernel.upper_envelope import room_for
from actr3d.camera.parameters import CameraParameters, optics_of
from actr3d.camera.topology import geoms_of, objects_of, topology_of
from actr3d.camera.view import View
from actr3d.configuration import checked
from actr3d.errors import CameraError
from actr3d.warnings import warn_modeller
from actr3d.world.frames import upright_axes


class GeometricCamera:
    """Computes the visible edges from one viewpoint in a MuJoCo model: exactly, and without pixels, names or meanings.

    Visibility follows MuJoCo's ray casts: fully transparent geoms are not seen, planes are seen from their front only, and from inside a
    geom its inner sides are seen. Signed distance fields are an exception: they are seen as the meshes that MuJoCo draws for them; these
    differ slightly from the surfaces that its rays hit. Flexes and skins are not seen, and a warning names them. Changes in `mj_model`
    (sizes, colours, heights, poses) take effect at the next look; only the list of geoms and their types is read once. The sensor `view`
    looks again after a step, or after `World.changed`.

    A camera is not thread-safe. A copy has the same labels; a deep or pickled one also has its own copy of the model.
    """

    def __init__(
        self,
        mj_model: MjModel,
        *,
        camera: str | None = None,
        site: str | None = None,
        body: str | None = None,
        parameters: CameraParameters | None = None,
    ) -> None:
        """Creates a camera that looks from a camera, a site or a body of the model; name exactly one of these.

        MuJoCo's cameras look along their negative z axis, with y up; from sites and bodies the view is along x, with z up.

        Args:
            mj_model: The MuJoCo model.
            camera: The name of one of its cameras; its own field of view is not used.
            site: Or the name of a site.
            body: Or the name of a body.
            parameters: The camera's parameters; None for `CameraParameters()`.

        Raises:
            CameraError: If there is no such eye, or if `background` names no geom.
            ConfigurationError: If model or parameters have another type.
            ModelWarning: (a warning) Names flexes and skins, which are not seen.
        """
        checked(mj_model, MjModel, "GeometricCamera.mj_model")
        checked(parameters, CameraParameters | None, "GeometricCamera.parameters")
        _warn_of_unseen(mj_model)
        self.parameters = CameraParameters() if parameters is None else parameters
        self._mj_model = mj_model
        self._eye = _the_eye(mj_model, camera=camera, site=site, body=body)
        self._objects = objects_of(mj_model, self._eye.body, self.parameters)
        self._geoms = geoms_of(mj_model)
        self._topology = topology_of(mj_model, self._objects, self.parameters.groups)
        self._scene = room_for_scene(self._topology, self.parameters.rows)
        most = MAX_PIECES_OF_A_PATCH * len(self._scene.patches) + len(self._topology.face_geom) + 1
        self._row = room_for(most, self._scene.places, self._scene.reaches)
        self._optics = optics_of(self.parameters)
        self._labels = np.zeros(max(0, *self._objects, 0) + 1, np.int64)
        self._extents = np.zeros(16 * self.parameters.rows, EXTENT)

    def look(self, mj_data: MjData, heading: float | None = None) -> View:
        """Returns what is visible now.

        Reads the poses in `mj_data` (`geom_xpos`, `cam_xpos` and so on) and writes nothing there. After `mj_step` these poses belong
        to the positions before the step: the caller updates them first with `mj_kinematics`, and for the model's cameras also with
        `mj_comPos` and `mj_camlight`.

        Args:
            mj_data: The poses.
            heading: The direction that counts as straight ahead, usually the heading of the body [rad, in the world frame]; None for the
                viewing direction. See `View.axes`.

        Raises:
            CameraError: If the poses were not computed, are not finite, or belong to another model.
            ConfigurationError: If it is no `MjData`, or the heading is not a number.
        """
        if type(mj_data) is not MjData or type(heading) is not float or not math.isfinite(heading):  # the checks take longer
            checked(mj_data, MjData, "GeometricCamera.look: mj_data")
            heading = checked(heading, float | None, "GeometricCamera.look: heading")
        if len(mj_data.geom_xpos) != len(self._objects):
            got = len(mj_data.geom_xpos)
            raise CameraError(f"GeometricCamera.look: mj_data belongs to another model: {got} geoms, not {len(self._objects)}")
        axes = self._eye.axes(mj_data)
        while True:
            count = self._scan(axes, mj_data)
            if count < len(self._extents):
                break
            self._extents = np.zeros(2 * len(self._extents), EXTENT)
        # Copied as immutable bytes: numpy copies structured arrays field by field, which is ten times slower.
        extents = np.frombuffer(self._extents[:count].tobytes(), EXTENT)
        return View(self.parameters, extents, _upright(axes[:3], heading))

    def label_of(self, geom: str) -> int | None:
        """Returns the label of the object that a geom belongs to; None if the object was never seen.

        Only for observers such as displays and tests: cognition does not know the names of geoms.

        Raises:
            CameraError: If no geom has this name.
        """
        names = names_of(self._mj_model, "geom")
        if not geom or geom not in names:
            raise CameraError(f"GeometricCamera.label_of: no geom {geom!r}")
        object = int(self._objects[names.index(geom)])
        return int(self._labels[object]) or None if object > 0 else None

    def geoms_by_label(self) -> dict[int, tuple[int, ...]]:
        """Returns the geoms of all objects that have a label, by label, as MuJoCo numbers geoms; for observers, as `label_of`."""
        geoms: dict[int, list[int]] = {}
        for geom, object in enumerate(self._objects.tolist()):
            label = int(self._labels[object]) if object > 0 else 0
            if label:
                geoms.setdefault(label, []).append(geom)
        return {label: tuple(own) for label, own in geoms.items()}

    def state(self) -> tuple[int, ...]:
        """Returns the labels that were given, to be passed to `restore`: all that a camera keeps from one look to the next."""
        return tuple(self._labels.tolist())

    def restore(self, state: tuple[int, ...]) -> None:
        """Restores the labels that `state` returned, on this camera or one like it.

        Raises:
            CameraError: If the state comes from a camera with other objects.
        """
        if len(state) != len(self._labels):
            own = len(self._labels) - 1
            raise CameraError(f"GeometricCamera.restore: the state is of a camera with {len(state) - 1} objects, not {own}")
        self._labels[:] = state

    def __reduce__(self) -> tuple[Any, ...]:
        # Its arrays are views of the model's memory, so they cannot be copied.
        eye = {self._eye.kind: self._eye.name}
        return partial(GeometricCamera, parameters=self.parameters, **eye), (self._mj_model,), self.state()

    def __setstate__(self, state: tuple[int, ...]) -> None:
        self.restore(state)

    def compile_half(self, mj_data: MjData, half: Literal["scene", "rows"]) -> None:
        """Compiles half of what `look` needs, or loads it, so that two processes can share the work: the first look loads both halves.

        Args:
            mj_data: The poses.
            half: What finds all that may be in view, or what traces it row by row.
        """
        axes, optics, topology, scene = self._eye.axes(mj_data), self._optics, self._topology, self._scene
        if half == "scene":
            scene_setter()(axes, mj_data.geom_xpos, mj_data.geom_xmat, optics, self._geoms, topology, scene)
        else:
            row_tracer()(axes, optics, topology, scene, self._row, self._labels, self._extents)

    def _scan(self, axes: NDArray[np.float64], mj_data: MjData) -> int:
        count = scan()(
            axes,
            mj_data.geom_xpos,
            mj_data.geom_xmat,
            self._optics,
            self._geoms,
            self._topology,
            self._scene,
            self._row,
            self._labels,
            self._extents,
        )
        if count < 0:
            name = names_of(self._mj_model, "geom")[-1 - count] or str(-1 - count)
            raise CameraError(f"GeometricCamera.look: the pose of geom '{name}' is not a number; did the physics diverge?")
        return count


def _warn_of_unseen(mj_model: MjModel) -> None:
    kinds = (("flex", mj_model.nflex, mujoco.mjtObj.mjOBJ_FLEX), ("skin", mj_model.nskin, mujoco.mjtObj.mjOBJ_SKIN))
    names = [f"{kind} '{mujoco.mj_id2name(mj_model, which, n) or n}'" for kind, count, which in kinds for n in range(int(count))]
    if names:
        warn_modeller(f"the Geometric Camera does not see {', '.join(names)}: add a geom to each object that should be seen")


def _the_eye(mj_model: MjModel, **given: str | None) -> Eye:
    """Returns the one eye that is named.

    Raises:
        CameraError: If not exactly one is named.
    """
    named: list[tuple[Any, str]] = [(kind, name) for kind, name in given.items() if name is not None]
    if len(named) != 1:
        got = ", ".join(f"{kind}={name!r}" for kind, name in named) or "none"
        raise CameraError(f"GeometricCamera: name one of camera, site or body to look from (got {got})")
    kind: Kind = named[0][0]
    return Eye(mj_model, kind, named[0][1])


def _upright(axes: NDArray[np.float64], heading: float | None) -> NDArray[np.float64]:
    """Returns the eye's axes `(3, 3)`, given in the world frame, in a frame rotated about the vertical to a heading."""
    if heading is None:
        heading = math.atan2(axes[2, 1], axes[2, 0])
    upright = axes @ upright_axes(heading)
    upright.flags.writeable = False
    return upright
