"""The contacts of bodies within a tick: many are over at its end."""

from __future__ import annotations

import numpy as np

from actr3d.world import Floor, World


class TickContacts:
    """Collects what touches the bodies of a world in each physics step, for observers; contacts with floors do not count.

    Args:
        world: The world, which is watched from now on.
    """

    def __init__(self, world: World) -> None:
        self._floors = frozenset(part.name for part in world.scene.parts if isinstance(part, Floor))
        self._is_floor = np.array([*(owner in self._floors for owner in world.owners), False])
        self._data = world.mj_data
        self._bodies = [(name, body.contacts) for name, body in world.bodies.items()]
        self._found: dict[tuple[str, str, str], float] = {}
        self._untouched: tuple[bytes, list[list[int]]] = b"", []
        """The pairs of geoms, and the held objects, of the last physics step with contacts in which bodies touched nothing but floors.
        Equal steps are skipped: a standing body has the same contacts for a long time."""
        world.watchers.insert(0, self._look)  # before measures, whose reading of a sensor may update the contacts

    def _look(self) -> None:
        if not self._data.ncon:
            return
        now = self._data.contact.geom.tobytes(), [contacts.held() for _, contacts in self._bodies]
        if now == self._untouched:
            return
        touched = [(name, contacts) for name, contacts in self._bodies if contacts.any_in_step(self._is_floor)]
        if not touched:
            self._untouched = now
        for name, contacts in touched:
            for touch in contacts.touches():
                if touch.other not in self._floors:
                    contact = name, touch.part, touch.other
                    self._found[contact] = max(touch.force, self._found.get(contact, 0.0))

    def take(self) -> dict[tuple[str, str, str], float]:
        """Returns the greatest force of each contact since the last call [N], by body, its part, and the other object."""
        found, self._found = self._found, {}
        return found
