"""The contacts of bodies within ticks."""

from __future__ import annotations

from actr3d.simulation.tick_contacts import TickContacts
from actr3d.world import Floor, Mannequin, Scene, SimpleObject, Wall, World


def test_contacts_of_a_resting_object_count_while_a_body_holds_it() -> None:
    table = Wall(name="table", start=(0.05, -0.5), end=(0.05, -0.22), thickness=0.1, height=0.56)
    cup = SimpleObject(name="cup", size=(0.05, 0.05, 0.2), position=(0.05, -0.24, 0.66), mass=0.5)
    world = World(Scene(parts=(Floor(), table, cup, Mannequin(name="walker"))))
    body, contacts = world.bodies["walker"], TickContacts(world)
    found: list[set[tuple[str, str, str]]] = []
    for command in (("stop",), ("grasp", "cup"), ("release",)):
        body.set(*command)
        for _ in range(5):
            world.step(5)
        contacts.take()
        world.step(5)
        found.append(set(contacts.take()))
    assert world.mj_data.ncon > 0, "the cup is on the table all the time"
    assert found == [set(), {("walker", "cup", "table")}, set()]
    assert contacts.take() == {}
