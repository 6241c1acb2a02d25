"""Joints that slide: their noise, speeds and postures are in metres; and other rare bodies."""

from __future__ import annotations

import math
from typing import Any

import pytest

from actr3d.errors import WorldError
from actr3d.simulation import Simulation
from actr3d.world import ImportedBody
from actr3d.world.anatomy import NamedMovement
from tests.helpers.motor_bodies import moving, until
from tests.helpers.small_agents import near

CRANE = """<mujoco><worldbody><body name="base"><geom size="0.1"/>
  <body name="mast" gravcomp="1" pos="0 0 0.2"><joint name="pan" axis="0 0 1" range="-90 90"/>
    <joint name="lift" type="slide" axis="0 0 1" range="0 1"/><geom size="0.05" pos="0.3 0 0"/></body></body></worldbody>
  <actuator><velocity name="a" joint="pan" kv="200"/><velocity name="b" joint="lift" kv="200"/></actuator></mujoco>"""
"""A part that turns and slides."""
MOVEMENTS = NamedMovement(name="look", joints=(("pan", 1),)), NamedMovement(name="raise", joints=(("lift", 1),))


def crane(text: str = CRANE, movements: tuple[NamedMovement, ...] = MOVEMENTS, **parameters: Any) -> tuple[Simulation, Any]:
    return moving(body=ImportedBody(name="crane", text=text, movements=movements), **parameters)


def raised(simulation: Simulation, motor: Any, to: float) -> None:
    motor.rotate("lift", angle=to, speed=1)
    until(simulation, lambda: not motor.busy)


def test_a_slide_is_felt_with_the_noise_of_lengths() -> None:
    simulation, motor = crane(angle_noise=2.0)
    raised(simulation, motor, 0.5)
    assert motor.lift_position == near(0.5, abs=0.001)
    simulation, motor = crane(size_noise=0.01)
    raised(simulation, motor, 0.5)
    assert 0.001 < abs(motor.lift_position - 0.5) < 0.05


def test_each_command_needs_the_speed_of_a_slide() -> None:
    _, motor = crane()
    for command, given in (("assume", ("lift:0.2",)), ("assume", ("pan:10 lift:0.2",)), ("move", ("raise", None, 0.5))):
        with pytest.raises(WorldError, match=r"joint 'lift' slides; give its speed \[m/s\]"):
            getattr(motor, command)(*given)


def test_a_part_turns_and_slides_together_each_in_its_unit() -> None:
    simulation, motor = crane()
    motor.assume("pan:10 lift:0.2", speed=2)
    simulation.step(50)
    pan, lift = (simulation.world.bodies["crane"].joints[name].position for name in ("pan", "lift"))
    assert (math.degrees(pan), lift) == (near(1, abs=0.1), near(0.2, abs=0.001))
    assert motor.mast_busy, "it still turns"
    until(simulation, lambda: not motor.busy)
    assert (motor.mast_end, motor.pan_angle, motor.lift_position) == ("done", 10, near(0.2, abs=0.001))


def test_a_slide_that_is_away_from_its_start_is_in_the_posture() -> None:
    simulation, motor = crane(movements=MOVEMENTS[:1])
    assert "lift" not in motor.parent.posture.chunk
    raised(simulation, motor, 0.05)
    motor.feel("lifted")
    simulation.step(2)
    assert motor.parent.posture.chunk["lift"] == near(0.05, abs=0.001)


def test_new_extremes_of_a_slide_are_stored_on_the_way() -> None:
    simulation, motor = crane(extreme_slide=0.2)
    raised(simulation, motor, 0.5)
    passing = motor.parent.memory.find_matching_chunks("end:passing")
    assert [chunk["lift"] for chunk in passing] == near([0.2, 0.4], abs=0.03)


def test_two_joints_about_one_axis_have_to_be_named() -> None:
    _, motor = crane(CRANE.replace('<joint name="lift" type="slide" axis="0 0 1" range="0 1"/>', '<joint name="lift" axis="0 0.1 1"/>'))
    with pytest.raises(WorldError, match="'mast' has several joints about yaw; name one of them: pan, lift"):
        motor.rotate("mast", "yaw", angle=10)
