"""Eyes that turn: the words that turn them, saccades to what is attended to, and how long encoding takes."""

from __future__ import annotations

import math
from typing import Any

import pytest

from actr3d.errors import ConfigurationError, ParameterError, WorldError
from actr3d.simulation import Simulation
from actr3d.trace import Trace
from actr3d.vision import Emma, Vision
from actr3d.world import Aperture, Car, Floor, Mannequin, Scene, World
from actr3d.world.actuators.motion import saccade_time
from tests.helpers.small_agents import near
from tests.helpers.vision_scenes import AgentWithoutPhysics, agent, events

SCENE = Scene(parts=(Floor(), Aperture(width=0.8, position=(5.0, 2.0)), Mannequin(name="walker")))
ASIDE = math.degrees(math.atan2(2.0, 5.0))

KIND = """
from actr3d.actr import *
from actr3d.vision import Emma, Vision

class Agent(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual OPTIONS)
    def init():
        goal.set("look")
    def look(goal="look"):
        vision.request("feature:opening", height=1)
        goal.set("seen")
"""


def eye_of(world: World) -> tuple[float, float]:
    """Returns where an eye looks: to the left and up [rad]."""
    forward = world.mj_data.site(world.bodies["walker"].eye).xmat.reshape(3, 3)[:, 0]
    return math.atan2(forward[1], forward[0]), math.asin(forward[2])


# -- words


def test_a_gaze_arrives_when_a_saccade_does_and_stays() -> None:
    world = World(SCENE)
    walker = world.bodies["walker"]
    walker.set("gaze", 0.5, 0.2)
    ticks = math.ceil(saccade_time(0.5) * 100)
    world.step(5 * (ticks - 1))
    world.refresh()
    assert eye_of(world)[0] < 0.49
    world.step(5)
    world.refresh()
    assert eye_of(world) == (near(0.5, abs=1e-3), near(0.2, abs=1e-2))
    world.step(100)
    world.refresh()
    assert eye_of(world) == (near(0.5, abs=1e-3), near(0.2, abs=1e-2))
    walker.set("saccade", -0.3, -0.4)
    world.step(100)
    assert walker.joints["eye_yaw"].position == near(0.2, abs=1e-3)
    assert walker.joints["eye_pitch"].position == near(0.2, abs=1e-3)


def test_a_gaze_stays_within_the_eyes_limits_and_goes_at_a_speed() -> None:
    world = World(SCENE)
    walker = world.bodies["walker"]
    walker.set("gaze", 3.0, -3.0, speed=1.0)
    world.step(250)
    assert walker.joints["eye_yaw"].position == near(0.5, abs=0.01)
    world.step(500)
    assert walker.joints["eye_yaw"].position == near(math.radians(55), abs=1e-3)
    assert walker.joints["eye_pitch"].position == near(math.radians(45), abs=1e-3)
    before = walker.get("view")
    walker.set("gaze", 0)
    world.step(250)
    assert walker.get("view").extents.tobytes() != before.extents.tobytes()
    with pytest.raises(WorldError, match="gaze: left: must be a number"):
        walker.set("gaze", "left")
    with pytest.raises(WorldError, match="has no actuator 'gaze'"):
        World(Scene(parts=(Floor(), Car(name="car")))).bodies["car"].set("gaze", 0.1)


def seen(options: str, seconds: float = 1.0, seed: int = 1) -> tuple[Simulation, Any]:
    simulation = Simulation(SCENE, {"walker": agent(KIND.replace(" OPTIONS", options))}, seed=seed, trace="all")
    simulation.run(seconds)
    return simulation, simulation.agents["walker"]


def arrival(options: str) -> float:
    simulation, _ = seen(options)
    ((time, _),) = list(events(simulation.trace, "sight"))
    return time


# -- eye movements of the module


def test_the_eye_turns_to_what_a_request_has_found_and_then_looks_at_it() -> None:
    simulation, mind = seen(", saccades=True")
    left, up = eye_of(simulation.world)
    assert math.degrees(left) == near(mind.visual.chunk["direction"], abs=0.2)
    assert up == near(0, abs=0.01)
    still, _ = seen("")
    assert eye_of(still.world) == (near(0, abs=1e-6), near(0, abs=1e-6))


def test_directions_are_from_the_body_wherever_the_eye_looks() -> None:
    world = World(SCENE)
    kind = agent(KIND.replace(" OPTIONS", ""))
    straight = AgentWithoutPhysics(world, kind).tick(12).agent.visual.chunk["direction"]
    world.bodies["walker"].set("gaze", 0.4, -0.1)
    world.step(100)
    turned = AgentWithoutPhysics(world, kind).tick(12).agent.visual.chunk["direction"]
    assert straight == near(ASIDE, abs=0.6)
    assert turned == near(straight, abs=0.2)


def test_an_agent_turns_its_eye_in_degrees() -> None:
    class_ = agent(
        """
from actr3d.actr import *
from actr3d.vision import Vision
class Agent(Model):
    visual = Buffer()
    vision = Vision(visual)
    def start(self):
        yield 0.02
        self.vision.gaze(20, 5)
"""
    )
    simulation = Simulation(SCENE, {"walker": class_}, seed=1)
    simulation.run(0.5)
    assert eye_of(simulation.world) == (near(math.radians(20), abs=1e-3), near(math.radians(5), abs=5e-3))


# -- times


def test_an_attention_shift_takes_its_time_and_a_saccade_its_own() -> None:
    assert arrival("") == 0.1
    assert arrival(", encoding=0.085") == 0.185
    _, mind = seen(", saccades=True")
    angle = math.radians(mind.visual.chunk["direction"])
    assert arrival(", saccades=True") == near(0.1 + saccade_time(angle), abs=2e-4)
    assert arrival(", saccades=True, encoding=0.085") == 0.185


def test_emmas_times_are_those_of_its_equations() -> None:
    emma = Emma()
    base = -0.006 * math.log(0.5)
    assert emma.course(0.0) == (near(base), None)
    small, large = math.radians(5.0), math.radians(20.0)
    assert emma.course(small) == (near(base * math.exp(2.0)), None)
    assert base * math.exp(2.0) < 0.135
    landing = 0.135 + 0.05 + 0.02 + 0.002 * 20
    alone = base * math.exp(8.0)
    assert alone > landing
    assert emma.course(large) == (near(landing + (1 - landing / alone) * base), near(0.185))
    between = math.radians(9.3)  # encoded while the eye is on its way
    time, start = emma.course(between)
    assert (time, start) == (near(base * math.exp(0.4 * 9.3)), near(0.185))
    with pytest.raises(ConfigurationError, match=r"Emma\.frequency: must be < 1"):
        Emma(frequency=1.0)


def test_emma_sets_the_time_of_a_chunk_and_turns_the_eye_where_it_may() -> None:
    simulation, mind = seen(", encoding='emma', saccades=True")
    angle = math.radians(mind.visual.chunk["direction"])
    ((time, _),) = list(events(simulation.trace, "sight"))
    assert time == near(0.1 + Emma().course(angle)[0], abs=3e-4)
    assert math.degrees(eye_of(simulation.world)[0]) == near(math.degrees(angle), abs=0.2)
    ((turned, _),) = [(at, data) for at, data in events(simulation.trace, "request") if data.get("word") == "saccade"]
    assert turned == near(0.1 + 0.185)
    covert, _ = seen(", encoding=Emma(factor=0.01)")
    assert math.degrees(eye_of(covert.world)[0]) == near(0, abs=1e-6)


LOOKS = """
from actr3d.actr import *
from actr3d.vision import Vision
class Agent(Model):
    visual = Buffer()
    vision = Vision(visual, encoding="emma", saccades=True)
    def start(self):
        self.vision.request("feature:opening", height=1)
        yield 0.05 + SECONDS
        self.vision.request("feature:opening", height=WANTED)
"""
"""An agent that requests something else some time after its first shift of attention."""
NEAR = Scene(parts=(Floor(), Aperture(width=0.8, position=(5.0, 0.77)), Mannequin(name="walker")))
"""A doorway that is encoded after the turn of the eye is prepared, and before it begins."""


def looked(seconds: float, wanted: float = 50) -> tuple[Simulation, int]:
    """Returns what happens if the agent requests an opening of another height so many seconds after its first shift of attention, and how
    often the eye turns."""
    kind = agent(LOOKS.replace("SECONDS", str(seconds)).replace("WANTED", str(wanted)))
    simulation = Simulation(NEAR, {"walker": kind}, seed=1, trace="all")
    simulation.run(1)
    return simulation, [data.get("word") for _, data in events(simulation.trace, "request")].count("saccade")


def test_with_emma_the_eye_turns_although_encoding_ends_before_it_is_there() -> None:
    simulation, _ = looked(5)
    direction = simulation.agents["walker"].visual.chunk["direction"]
    encoded, start = Emma().course(math.radians(direction))
    assert start is not None
    assert 0.135 < encoded < start
    ((time, _),) = list(events(simulation.trace, "sight"))
    assert time == near(0.05 + encoded, abs=4e-3), "the direction is rounded"
    assert math.degrees(eye_of(simulation.world)[0]) == near(direction, abs=0.2)


@pytest.mark.parametrize(("seconds", "turns"), [(0.12, 0), (0.14, 1), (0.18, 1)])
def test_with_emma_a_request_calls_off_a_turn_of_the_eye_until_it_is_prepared(seconds: float, turns: int) -> None:
    simulation, turned = looked(seconds)
    assert simulation.agents["walker"].vision.error
    assert turned == turns


@pytest.mark.parametrize("seconds", [0.14, 0.18])
def test_the_eye_looks_at_what_it_saw_before_it_had_turned_to_something_else(seconds: float) -> None:
    simulation, turned = looked(seconds, 1)
    assert turned == 2
    assert math.degrees(eye_of(simulation.world)[0]) == near(simulation.agents["walker"].visual.chunk["direction"], abs=0.3)


def test_a_request_that_is_replaced_turns_no_eye() -> None:
    kind = agent(
        """
from actr3d.actr import *
from actr3d.vision import Vision
class Agent(Model):
    visual = Buffer()
    vision = Vision(visual, saccades=True)
    def start(self):
        self.vision.request("feature:opening", height=1)
        yield 0.03
        self.vision.request("feature:opening", width=">50")
"""
    )
    trace = Trace("all")
    AgentWithoutPhysics(World(SCENE), kind, 1, trace).tick(30)
    assert [data["call"] for _, data in events(trace, "request")] == ["request", "request"]


def test_an_invalid_encoding_is_reported() -> None:
    for wrong in ("ema", -1, None, True):
        with pytest.raises(ParameterError, match=r"Vision\.encoding: must be a time >= 0 \[s\], 'emma' or an Emma"):
            Vision(None, encoding=wrong)


def test_a_driver_sees_with_a_cars_eye() -> None:
    kind = agent(
        """
from actr3d.actr import *
from actr3d.vision import Vision
class Agent(Model):
    visual = Buffer()
    vision = Vision(visual, horizontal_fov=2.0)
    def start(self):
        yield self.vision.request("feature:opening", height=1)
"""
    )
    scene = Scene(parts=(Floor(), Aperture(width=3.0, position=(9.0, 0.0), heading=0.4), Car(name="walker", heading=0.4)))
    chunk = AgentWithoutPhysics(World(scene), kind).tick(10).agent.visual.chunk
    assert chunk["width"] == near(3.0, abs=0.01)
    eye = (1.2 * math.cos(0.4) - 0.35 * math.sin(0.4), 1.2 * math.sin(0.4) + 0.35 * math.cos(0.4))
    assert chunk["direction"] == near(math.degrees(math.atan2(-eye[1], 9.0 - eye[0]) - 0.4), abs=1)
