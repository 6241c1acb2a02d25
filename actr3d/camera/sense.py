"""The sensor word `view`: what a body's eye sees."""

from __future__ import annotations

from contextlib import suppress
from typing import Any
from weakref import WeakKeyDictionary

from actr3d.camera.geometric import GeometricCamera
from actr3d.camera.parameters import CameraParameters
from actr3d.camera.stand import Stand, stand_of
from actr3d.camera.view import View
from actr3d.world.body import Body, sensor

USUAL = CameraParameters()
"""What is looked with where no options are given."""


class Sight:
    """A body's eye, looked through with one set of parameters: at most one look for each state of the world.

    Args:
        body: Whose eye.
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
            CameraError: If the poses are no numbers.
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
        """Returns how the eye stood when it saw a view, for who looks on; None where it has not seen that."""
        return self._stands.get(view)

    def state(self) -> tuple[int, ...]:
        """Returns the labels given so far."""
        return self._camera.state()

    def restore(self, state: Any) -> None:
        """Takes the labels up again that were given then; None for before the first look."""
        self._camera.restore(self._unseen if state is None else state)
        self._view = None


@sensor.if_body(lambda body: body.eye is not None)
def view(body: Body, **options: Any) -> View:
    """Senses the edges of all that is visible from the eye.

    Args:
        body: Whose.
        options: The fields of `CameraParameters`; looks with the same options share their labels. Numbers may come as text.

    Raises:
        ConfigurationError: If an option is no field, or a value is not what it takes.
        CameraError: If something named as background is not there.
    """
    if not options:
        return body.sense(Sight, USUAL).look()
    named = {name: _meant(value) for name, value in options.items()}
    return body.sense(Sight, CameraParameters.from_mapping(named)).look()


def _meant(value: Any) -> Any:
    """Returns the number that a text says: what a pattern binds is text; no option is one."""
    for kind in (int, float) if isinstance(value, str) else ():
        with suppress(ValueError):
            return kind(value)
    return value
