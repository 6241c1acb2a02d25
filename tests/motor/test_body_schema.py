"""Felt positions on the grid: computed only where they can have changed, and always equal to rounding each of them."""

import random

import pytest

from actr3d.motor.limbs import Limbs, on_grid
from actr3d.motor.schema import BodySchema
from actr3d.world import Mannequin, Scene, World


@pytest.mark.parametrize("step", [1e-12, 1e-4, 0.003, 0.1])
def test_felt_positions_and_extremes_are_those_of_each_single_reading(step: float) -> None:
    body = World(Scene(parts=(Mannequin(name="walker"),))).bodies["walker"]
    limbs = Limbs(body.get("anatomy"))
    draw = random.Random(1)
    now = [draw.uniform(-0.5, 0.5) for _ in limbs.order]
    sizes = [0.5, 0.3, 1.7, 0.0]
    schema = BodySchema(limbs, now, sizes, angle_grid=1.0, size_grid=0.001, step=10.0, slide=0.02)
    least, most = list(now), list(now)
    for _ in range(400):
        now, sizes = [[at + draw.gauss(0, step) for at in of] for of in (now, sizes)]
        new, _ = schema.feel(now, sizes)
        least, most = [*map(min, least, now)], [*map(max, most, now)]
        for number, joint in enumerate(limbs.order):
            grid = 1.0 if limbs.joints[joint].kind == "hinge" else 0.001
            assert schema.at[joint] == on_grid(now[number] / limbs.unit[joint], grid)
            knows = schema.degree_of_freedom(joint)
            assert (knows.angle, knows.minimum, knows.maximum) == (now[number], least[number], most[number])
        assert [*schema.box.values()] == [on_grid(size, 0.001) for size in sizes]
        further = schema.extremes(limbs.order)
        assert set(further) <= set(new)
        schema.note(further)
