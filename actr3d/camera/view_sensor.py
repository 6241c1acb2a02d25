"""The sensor `view`: returns what a body's eye sees."""

from __future__ import annotations

from contextlib import suppress
from typing import Any
from weakref import WeakKeyDictionary

from actr3d.camera.eye_pose import Stand, stand_of
from actr3d.camera.geometric import GeometricCamera
from actr3d.camera.parameters import CameraParameters
from actr3d.camera.view import View
from actr3d.world.body import Body, sensor

USUAL = CameraParameters()
"""The parameters that are used if no options are given."""


class Sight:
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
        self._moment = -1
        self._view: View | None = None
        self._stands: WeakKeyDictionary[View, Stand] = WeakKeyDictionary()

    def look(self) -> View:
        """Returns what is visible now.

        Raises:
            CameraError: If the poses are not finite.
        """
        physics = self._body.physics
        if self._view is None or self._moment != physics.moment:
            physics.refresh()
            stand = stand_of(self._body, physics.mj_data)
            self._view = self._camera.look(physics.mj_data, stand.heading)
            self._stands[self._view] = stand
            self._moment = physics.moment
        return self._view

    def stood(self, view: View) -> Stand | None:
        """Returns the pose of the eye when it saw a view, for observers; None if this eye did not compute the view."""
        return self._stands.get(view)

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
        options: The fields of `CameraParameters`; looks with the same options share their labels. Numbers may be given as text.

    Raises:
        ConfigurationError: If an option is not a field, or its value is invalid.
        CameraError: If an object named as background does not exist.
    """
    if not options:
        return body.sense(Sight, USUAL).look()
    named = {name: _meant(value) for name, value in options.items()}
    return body.sense(Sight, CameraParameters.from_mapping(named)).look()


def _meant(value: Any) -> Any:
    """Returns a text as a number if it is one: values bound by a pattern are text, and no option takes text."""
    for kind in (int, float) if isinstance(value, str) else ():
        with suppress(ValueError):
            return kind(value)
    return value
