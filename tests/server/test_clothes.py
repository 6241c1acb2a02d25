"""Agents of one scene have clothes of different colours in what is drawn, unless the model chooses them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from actr3d.world import Car, Floor, Load, Mannequin, Scene
from actr3d.world.compiled import loaded, saved
from actr3d.world.world import World
from workbench.clothes import dress
from workbench.palette import channels, palette


def test_each_agent_after_the_first_has_its_own_colour_in_shades_and_the_rest_stays() -> None:
    chosen = (0.9, 0.1, 0.2, 1.0)
    places = {name: (0.0, 2.0 * number) for number, name in enumerate(("first", "second", "third", "chosen", "statue"))}
    people = [Mannequin(name=name, position=place, load=Load() if name == "second" else None) for name, place in places.items()]
    people[3] = replace(people[3], colour=chosen)
    world = World(Scene(parts=(Floor(), *people, Car(name="car", position=(6.0, 0.0)))))
    before: Any = world.mj_model
    drawn: Any = loaded(saved(before))
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
