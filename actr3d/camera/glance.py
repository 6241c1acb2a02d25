"""Shows observers what an eye sees, without changing the labels that the agent knows."""

from __future__ import annotations

from actr3d.camera.parameters import CameraParameters
from actr3d.camera.view import View
from actr3d.camera.view_sensor import Sight
from actr3d.errors import CameraError
from actr3d.world.body import Body


def glance(body: Body, parameters: CameraParameters | None = None) -> View:
    """Returns what is visible now, with the labels that the agent knows. Objects not seen before may get other labels later.

    Args:
        body: The body whose eye is used.
        parameters: How it sees; None for the parameters of its first view sense, or the default if it has none.

    Raises:
        CameraError: If the body has no eye, or the poses are not finite.
    """
    if body.eye is None:
        raise CameraError(f"body '{body.name}' has no eye")
    if parameters is None:
        parameters = next((sense.parameters for sense in body.senses if isinstance(sense, Sight)), CameraParameters())
    eye = body.unused_sense(Sight, parameters)
    labels = eye.state()
    try:
        return eye.look()
    finally:
        if eye.state() != labels:
            eye.restore(labels)
