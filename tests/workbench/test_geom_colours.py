"""The colours of what is drawn: clothes of agents, and one colour for each object on the retina."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from actr3d.world import Car, Floor, Load, Mannequin, Scene, Wall
from actr3d.world.compiled import from_bytes, to_bytes
from actr3d.world.world import World
from workbench.geom_colours import colour_of_object, dress
from workbench.scene_colours import channels, palette


def test_each_agent_after_the_first_has_its_own_colour_in_shades_and_the_rest_stays() -> None:
    chosen = (0.9, 0.1, 0.2, 1.0)
    places = {name: (0.0, 2.0 * number) for number, name in enumerate(("first", "second", "third", "chosen", "statue"))}
    people = [Mannequin(name=name, position=place, load=Load() if name == "second" else None) for name, place in places.items()]
    people[3] = replace(people[3], colour=chosen)
    world = World(Scene(parts=(Floor(), *people, Car(name="car", position=(6.0, 0.0)))))
    before: Any = world.mj_model
    drawn: Any = from_bytes(to_bytes(before))
    dress(drawn, [world.bodies[name].root for name in ("first", "second", "third", "chosen", "car")])

    def shirt(model: Any, name: str) -> Any:
        return model.geom(f"{name}_torso").rgba[:3]

    colours = [np.array(channels(colour)) / 255 for colour in palette()["clothes"]]
    assert shirt(drawn, "first") == pytest.approx(shirt(before, "first"))
    assert shirt(drawn, "second") == pytest.approx(colours[0], abs=1e-6)
    assert shirt(drawn, "third") == pytest.approx(colours[1], abs=1e-6)
    assert shirt(drawn, "chosen") == pytest.approx(chosen[:3])
    assert shirt(drawn, "statue") == pytest.approx(shirt(before, "statue"))
    assert drawn.geom("second_pelvis").rgba[:3] == pytest.approx(0.6 * colours[0], abs=1e-6)
    changed = {drawn.geom(geom).name for geom in np.flatnonzero((drawn.geom_rgba != before.geom_rgba).any(axis=1))}
    assert {name.partition("_")[0] for name in changed} == {"second", "third"}
    assert not any(name.endswith(("head", "neck", "hand", "load")) for name in changed)
    assert drawn.geom_rgba[:, 3] == pytest.approx(before.geom_rgba[:, 3])


def test_an_object_has_the_colour_of_its_largest_visible_part() -> None:
    parts = (
        Floor(),
        Mannequin(name="walker", load=Load()),
        Car(name="car", position=(6.0, 0.0)),
        Wall(name="wall", start=(12.0, -1.0), end=(12.0, 1.0)),
    )
    world = World(Scene(parts=parts))
    model: Any = world.mj_model

    def colour(part: str) -> Any:
        geoms = [geom for geom in range(model.ngeom) if model.geom(geom).name.startswith(part)]
        return channels(colour_of_object(model, geoms))

    for name, usual in (("walker", Mannequin.colour), ("car", Car.colour), ("wall", Wall.colour)):
        assert colour(name) == pytest.approx([255 * part for part in usual[:3]], abs=1), name
    model.geom("walker_torso").rgba[3] = 0
    assert colour("walker_torso") == pytest.approx([255 * part for part in Mannequin.colour[:3]], abs=1)  # there is nothing else
    assert colour("walker") != colour("walker_torso")
