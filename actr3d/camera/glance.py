"""What an eye sees, for who looks on: the mind's own labels stay as they are."""

from __future__ import annotations

from actr3d.camera.parameters import CameraParameters
from actr3d.camera.sense import Sight
from actr3d.camera.view import View
from actr3d.errors import CameraError
from actr3d.world.body import Body


def glance(body: Body, parameters: CameraParameters | None = None) -> View:
    """Returns what is visible now, with the labels that the mind knows; what it has not seen yet gets labels that it may see otherwise.

    Args:
        body: Whose eye.
        parameters: How it sees; None for the way it has looked first, or the usual way where it never has.

    Raises:
        CameraError: If the body has no eye, or the poses are no numbers.
    """
    if body.eye is None:
        raise CameraError(f"body '{body.name}' has no eye")
    looked = [sense for sense in body.senses if isinstance(sense, Sight)]
    own = next((sight for sight in looked if parameters is None or sight.parameters == parameters), None)
    if own is None:
        return Sight(body, parameters or CameraParameters()).look()
    labels = own.state()
    try:
        return own.look()
    finally:
        if own.state() != labels:
            own.restore(labels)
