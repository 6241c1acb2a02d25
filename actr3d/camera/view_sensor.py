"""The sensor `view`: returns what a body's eye sees; and views for observers, which leave the labels that the agent knows unchanged."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar
from weakref import WeakKeyDictionary

from mujoco import mj_name2id, mjtObj

from actr3d.camera.geometric import GeometricCamera
from actr3d.camera.parameters import CameraParameters
from actr3d.camera.view import View
from actr3d.errors import CameraError
from actr3d.world.body import Body, sensor
from actr3d.world.frames import heading_of

T = TypeVar("T")

USUAL = CameraParameters()
"""The parameters that are used if no options are given."""


class EyePose(NamedTuple):
    """The position of an eye and the heading of its body, in the world frame; for observers, agents never receive it."""

    x: float
    """[m]"""
    y: float
    """[m]"""
    z: float
    """[m]"""
    heading: float
    """[rad]"""


def eye_pose_of(body: Body, data: Any) -> EyePose:
    """Returns the pose of a body's eye in simulation data whose geometry is up to date.

    Args:
        body: A body with an eye.
        data: The `mj_data` of the world, or a copy in another state.
    """
    site = mj_name2id(body.physics.mj_model, mjtObj.mjOBJ_SITE, body.eye or "")
    x, y, z = data.site_xpos[site].tolist()
    return EyePose(x, y, z, heading_of(data.xmat[body.root]))


class EyeSense:
    """A body's eye with one set of parameters; computes at most one view for each state of the world.

    Args:
        body: The body whose eye is used.
        parameters: How it sees.
    """

    def __init__(self, body: Body, parameters: CameraParameters) -> None:
        self.parameters = parameters
        """How it sees."""
        self._body = body
        self._camera = GeometricCamera(body.physics.mj_model, site=body.eye, parameters=parameters)
        self._unseen = self._camera.state()
        self._state_number = -1
        self._view: View | None = None
        self._poses: WeakKeyDictionary[View, EyePose] = WeakKeyDictionary()

    def look(self) -> View:
        """Returns what is visible now.

        Raises:
            CameraError: If the poses are not finite.
        """
        physics = self._body.physics
        if self._view is None or self._state_number != physics.state_number:
            physics.refresh_positions()
            pose = eye_pose_of(self._body, physics.mj_data)
            self._view = self._camera.look(physics.mj_data, pose.heading)
            self._poses[self._view] = pose
            self._state_number = physics.state_number
        return self._view

    def pose_of(self, view: View) -> EyePose | None:
        """Returns the pose of the eye when it saw a view, for observers; None if this eye did not compute the view."""
        return self._poses.get(view)

    def geoms_by_label(self) -> dict[int, tuple[int, ...]]:
        """Returns the geoms of all objects that have a label, by label; for observers."""
        return self._camera.geoms_by_label()

    def state(self) -> tuple[int, ...]:
        """Returns the labels that were given."""
        return self._camera.state()

    def restore(self, state: Any) -> None:
        """Restores the labels of a saved state; None restores the state before the first look."""
        self._camera.restore(self._unseen if state is None else state)
        self._view = None


@sensor.if_body(lambda body: body.eye is not None)
def view(body: Body, **options: Any) -> View:
    """Senses the edges of all that is visible from the eye.

    Args:
        body: The body whose eye is used.
        options: The fields of `CameraParameters`; readings with the same options use the same labels. Numbers may be given as text.

    Raises:
        ConfigurationError: If an option is not a field, or its value is invalid.
        CameraError: If an object named as background does not exist.
    """
    if not options:
        return body.sense(EyeSense, USUAL).look()
    named = {name: _meant(value) for name, value in options.items()}
    try:
        parameters = _parameters(**named)
    except TypeError:  # a value has no hash, such as a list
        parameters = CameraParameters.from_mapping(named)
    return body.sense(EyeSense, parameters).look()


@lru_cache(typed=True)
def _parameters(**options: Any) -> CameraParameters:
    """Returns the same parameters for the same options, which are checked once."""
    return CameraParameters.from_mapping(options)


def _meant(value: Any) -> Any:
    """Returns a text as a number if it is one: values bound by a pattern are text, and no option takes text."""
    for kind in (int, float) if isinstance(value, str) else ():
        with suppress(ValueError):
            return kind(value)
    return value


def view_for_observer(body: Body, parameters: CameraParameters | None = None) -> View:
    """Returns what is visible now, with the labels that the agent knows. Objects not seen before may get other labels later.

    Args:
        body: The body whose eye is used.
        parameters: How it sees; None for the parameters of its first view sense, or the default if it has none.

    Raises:
        CameraError: If the body has no eye, or the poses are not finite.
    """
    return _observed(body, parameters, EyeSense.look)


def view_and_geoms_for_observer(body: Body, parameters: CameraParameters | None = None) -> tuple[View, dict[int, tuple[int, ...]]]:
    """Returns what is visible now, as `view_for_observer` does, and the geoms of all objects that have a label, by label.

    Args:
        body: The body whose eye is used.
        parameters: How it sees, as in `view_for_observer`.

    Raises:
        CameraError: If the body has no eye, or the poses are not finite.
    """
    return _observed(body, parameters, lambda eye: (eye.look(), eye.geoms_by_label()))


def _observed(body: Body, parameters: CameraParameters | None, read: Callable[[EyeSense], T]) -> T:
    """Returns what an observer reads from a body's eye, which keeps the labels that the agent knows."""
    if body.eye is None:
        raise CameraError(f"body '{body.name}' has no eye")
    if parameters is None:
        parameters = next((sense.parameters for sense in body.senses if isinstance(sense, EyeSense)), CameraParameters())
    eye = body.unused_sense(EyeSense, parameters)
    labels = eye.state()
    try:
        return read(eye)
    finally:
        if eye.state() != labels:
            eye.restore(labels)
