"""What is measured of a passage is so, and measuring changes nothing."""

from __future__ import annotations

import math
from itertools import groupby
from typing import Any

import numpy as np
import pytest

from actr3d.actr.loading import load_text
from actr3d.errors import SimulationError, WorldError
from actr3d.experiment.aperture import Passage, PassageResult
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Car, Floor, Load, Mannequin, Scene
from tests.helpers.walkers import digest, driving

WALKER = """
from actr3d.actr import *
from actr3d.simulation import BodyPort

class Walker(Model):
    body = BodyPort()

    def start(self):
        yield 0.5
        if self.sideways:
            self.body.set("teleport", self.across, self.sideways)
        if self.speed:
            self.body.set("walk", self.speed)
        yield 0.4
        if self.turn:
            self.body.set("posture", {"torso_yaw": self.turn / 2, "left_shoulder_yaw": 0.1, "right_shoulder_yaw": 0.1}, speed=4.0)
        yield 4.0
        self.stop()
"""


def walked(width: float, load: Load | None = None, trace: str = "none", heading: float = 0.0, **given: float) -> Simulation:
    """Returns a simulation of a person 0.45 m wide, 2.5 m before an aperture, that is not run yet."""
    walker: Any = load_text(WALKER, "walker.py").Walker

    def mind() -> Any:
        return walker(**{"turn": 0.0, "across": 0.0, "sideways": 0.0, "speed": 1.25, **given})

    at = (2.5 * math.cos(heading), 2.5 * math.sin(heading))
    aperture = Aperture(position=at, width=width, heading=heading)
    person = Mannequin(name="walker", shoulder_width=0.45, load=load, heading=heading)
    simulation = Simulation(Scene(parts=(Floor(), aperture, person)), {"walker": mind}, seed=1, trace=trace)
    simulation.measure(Passage("walker"))
    return simulation


def result_of(simulation: Simulation) -> PassageResult:
    simulation.run()
    return simulation.result()


@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_a_straight_walk_through_has_half_the_rest_on_each_side(heading: float) -> None:
    result = result_of(walked(0.8, heading=heading))
    assert result.outcome == "passed"
    assert (result.clearance_left_m, result.clearance_right_m) == (pytest.approx(0.175, abs=2e-4), pytest.approx(0.175, abs=2e-4))
    assert (result.contacts, result.max_force_n) == (0, 0)
    assert (result.onset_distance_m, result.onset_time_s) == (None, None)
    assert (result.wall_angle_deg, result.speed_m_s) == (pytest.approx(0, abs=0.01), pytest.approx(1.25, abs=1e-3))


def test_clearance_is_measured_for_each_side() -> None:
    result = result_of(walked(0.8, sideways=0.1))
    assert result.clearance_left_m == pytest.approx(0.075, abs=2e-4)
    assert result.clearance_right_m == pytest.approx(0.275, abs=2e-4)


def test_what_is_held_counts() -> None:
    result = result_of(walked(0.8, load=Load(shape="bar", size=(0.6, 0.03))))
    assert result.clearance_left_m == pytest.approx(0.1, abs=2e-3)


def test_a_turn_is_measured_in_the_world_and_in_the_joints() -> None:
    result = result_of(walked(0.7, turn=1.2))
    assert result.outcome == "passed"
    assert result.logged_angle_deg == pytest.approx(math.degrees(0.6 + 0.1), abs=0.05)
    assert result.wall_angle_deg == pytest.approx(math.degrees(0.6 + 0.1), abs=0.3)
    assert result.peak_angle_deg is not None
    assert result.wall_angle_deg is not None
    assert result.peak_angle_deg >= result.wall_angle_deg
    # It was told so 0.4 s after it began to walk, and the first degree at 4 rad/s twice over takes 2 to 3 steps.
    assert result.onset_time_s == pytest.approx(0.9, abs=0.012)
    assert result.onset_distance_m == pytest.approx(2.5 - 1.25 * 0.4, abs=0.02)


def test_clearance_of_a_turned_body_is_exact() -> None:
    """The shoulders, spheres at the ends of a line, are what comes nearest to the jambs of a body that is turned a little."""
    simulation = walked(0.7, turn=0.8)
    result = result_of(simulation)
    r = 0.035 * 1.75
    line, clavicle = 0.225 - r, 0.4 + 0.1  # from the spine to the joint; turned as torso and clavicle
    assert result.clearance_left_m == pytest.approx(0.35 - line * math.cos(clavicle) - r, abs=1e-3)


def test_a_walk_into_the_wall_touches_it_and_stops() -> None:
    result = result_of(walked(0.3))
    assert result.outcome == "stopped"
    assert result.contacts >= 2
    assert result.max_force_n > 100
    assert (result.wall_angle_deg, result.clearance_left_m) == (None, pytest.approx(0, abs=2e-3)) or result.clearance_left_m is None


@pytest.mark.daily(1)
@pytest.mark.parametrize(("aside", "heading"), [(0.9, 0.0), (-0.5, 0.0), (0.5, 2.0)])
def test_a_body_that_leans_against_the_wall_beside_the_doorway_has_no_clearance(aside: float, heading: float) -> None:
    """Contacts are soft: it is a few millimetres between the faces of the wall."""
    across: dict[str, Any] = {"across": -aside * math.sin(heading), "sideways": aside * math.cos(heading)}
    simulation = walked(0.8, heading=heading, **across)
    result = result_of(simulation)
    assert (result.outcome, result.contacts > 0) == ("stopped", True)
    assert (result.clearance_left_m, result.clearance_right_m) == (None, None)
    simulation.seek(3.0)
    assert simulation.result().clearance_left_m is None


def test_a_body_that_is_stuck_in_the_doorway_has_a_clearance() -> None:
    result = result_of(walked(0.42))
    assert (result.outcome, result.wall_angle_deg) == ("stopped", pytest.approx(0, abs=0.1))
    assert (result.clearance_left_m, result.clearance_right_m) == (pytest.approx(0, abs=2e-3), pytest.approx(0, abs=2e-3))


def test_the_energy_of_contacts_is_summed_by_contact() -> None:
    """Of two brushes of the same impulse it is twice that of one, not four times."""
    simulation = walked(0.4)
    body, option = simulation.world.bodies["walker"], simulation.world.mj_model.opt
    seen: list[dict[tuple[str, str], float]] = []
    simulation.world.watchers.append(
        lambda: seen.append({(touch.part, touch.other): touch.force * option.timestep for touch in body.contacts.touches()})
    )
    result = result_of(simulation)
    energy, number = 0.0, 0
    for pair in {pair for step in seen for pair in step}:
        for touching, steps in groupby([*seen, {}], lambda step, pair=pair: pair in step):
            if touching:
                energy, number = energy + sum(step[pair] for step in steps) ** 2 / (2 * 75.0), number + 1
    assert number == result.contacts > 3
    assert result.impact_j == pytest.approx(energy, rel=0.01)
    assert 0 < result.impact_j < 0.8 * result.impulse_n_s**2 / (2 * 75.0)


def test_a_walker_that_never_starts_declines_unless_it_was_cut_short() -> None:
    simulation = walked(0.8, speed=0)
    simulation.run(1)
    assert simulation.result().outcome == "stopped"
    simulation.run()
    result = simulation.result()
    assert (result.outcome, result.peak_angle_deg, result.speed_m_s, result.time_s) == ("declined", None, None, 4.9)
    assert str(result) == "declined after 4.90 s"


def test_measuring_changes_no_byte() -> None:
    measured, plain = driving("all"), driving("all")
    measured.measure(Passage("walker"))
    measured.run(4)
    plain.run(4)
    assert digest(measured) == digest(plain)
    assert measured.result().speed_m_s is not None


@pytest.mark.parametrize("commanded", [False, True])
def test_the_result_is_the_same_after_going_back(commanded: bool) -> None:
    straight, wandering = walked(0.7, turn=1.2), walked(0.7, turn=1.2)
    for simulation in (straight, wandering):
        simulation.run(2.0)
        if commanded:
            simulation.command("aperture", 0.9)
    straight.run()
    wandering.run(1.5)
    early = wandering.result()
    wandering.seek(0.7)
    wandering.run(0.5)
    wandering.seek(3.5)
    assert wandering.result() == early
    wandering.seek(1.0)
    wandering.run()
    assert wandering.result() == straight.result()


def test_another_future_has_another_result() -> None:
    changed, direct = walked(0.7), walked(0.7)
    changed.run(3.5)
    touched = changed.result().contacts
    changed.seek(1.0)
    changed.command("aperture", 1.0)
    changed.run()
    direct.run(1.0)
    direct.command("aperture", 1.0)
    direct.run()
    assert touched == 0
    assert changed.result() == direct.result()
    assert changed.result().clearance_left_m == pytest.approx(0.275, abs=2e-4)


def test_a_missing_object_is_reported() -> None:
    scene = Scene(parts=(Floor(), Aperture(), Mannequin(name="walker"), Car(name="car", position=(0, 5))))
    simulation = Simulation(scene)
    for body, aperture, message in [
        ("walkr", "aperture", "no body 'walkr'; did you mean 'walker'"),
        ("walker", "door", "no aperture 'door'"),
        ("car", "aperture", "body 'car' has no shoulders to measure"),
    ]:
        with pytest.raises(WorldError, match=message):
            simulation.measure(Passage(body, aperture))
    simulation.measure(Passage("walker"))
    with pytest.raises(SimulationError, match="must be called once"):
        simulation.measure(Passage("walker"))


def test_a_run_without_measure_has_no_result() -> None:
    simulation = driving("all")
    simulation.run(0.1)
    assert simulation.result() is None
    assert simulation.conclude() is None
    assert simulation.trace is not None
    assert simulation.trace.select("result") == []


def test_watching_single_steps_moves_nothing() -> None:
    one, other = walked(0.3), walked(0.3)
    seen: list[float] = []
    one.world.watchers.append(lambda: seen.append(one.world.mj_data.time))
    one.run(3)
    other.run(3)
    assert seen[:3] == pytest.approx([0.002, 0.004, 0.006])
    assert (len(seen) >= 1500, seen[-1]) == (True, pytest.approx(3))
    assert np.array_equal(one.world.state().mj_state, other.world.state().mj_state)


def test_a_body_that_is_put_elsewhere_before_it_sets_out_starts_there() -> None:
    simulation = walked(0.8)
    simulation.command("teleport", 0.4, 0.1, 0.0, body="walker")
    result = result_of(simulation)
    assert result.outcome == "passed"
    assert result.speed_m_s == pytest.approx(1.25, abs=1e-3)
    simulation.seek(0)
    assert result_of(simulation) == result
    standing = walked(0.8, speed=0.0)
    standing.command("teleport", 0.4, 0.1, 0.0, body="walker")
    assert result_of(standing).outcome == "declined"
