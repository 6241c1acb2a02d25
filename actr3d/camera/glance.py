"""What an eye sees, for observers: the labels that the agent knows stay as they are."""

from __future__ import annotations

from actr3d.camera.parameters import CameraParameters
from actr3d.camera.sense import Sight
from actr3d.camera.view import View
from actr3d.errors import CameraError
from actr3d.world.body import Body


def glance(body: Body, parameters: CameraParameters | None = None) -> View:
    """Returns what is visible now, with the labels that the agent knows. What it has not seen yet may get other labels later.

    Args:
        body: Whose eye.
        parameters: How it sees; None for the way it has looked first, or the usual way where it never has.

    Raises:
        CameraError: If the body has no eye, or the poses are no numbers.
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
