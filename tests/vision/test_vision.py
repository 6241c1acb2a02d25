"""The vision module: requests, their times, what comes of them, and who comes first."""

from __future__ import annotations

import math
from typing import Any

import pytest

from actr3d.errors import Actr3dError, ParameterError, SimulationError, VisionError
from actr3d.simulation import Simulation
from actr3d.trace import Trace
from actr3d.vision import Vision
from actr3d.world import Aperture, Floor, Mannequin, Scene, SimpleObject, Wall, World
from tests.helpers.small_agents import near
from tests.helpers.vision_scenes import AgentWithoutPhysics, agent, events
from tests.helpers.walkers import digest

HEAD = """
from actr3d.actr import *
from actr3d.simulation import BodyPort
from actr3d.vision import Vision
"""


def room(*more: Any, width: float = 0.6) -> World:
    return World(Scene(parts=(Floor(), Aperture(width=width), *more, Mannequin(name="walker"))))


def mind(body: str, options: str = "", **keys: Any) -> Any:
    """Returns an agent's class with a visual buffer and module; `body` has its productions."""
    return agent(f"{HEAD}\nclass Agent(ACTR):\n    goal = Buffer()\n    visual = Buffer()\n    vision = Vision(visual{options})\n{body}")


ONCE = """
    def init():
        goal.set("look width:0.4")
    def look(goal="look width:?w"):
        vision.request("feature:opening", width=">?w", height=">1.5", depth=">0.5")
        goal.set("wait")
"""


def asking(request: str, options: str = "", goal: str = "look") -> Any:
    return mind(
        f'\n    def init():\n        goal.set("{goal}")\n    def look(goal="look"):\n        {request}\n        goal.set("done")\n', options
    )


# -- what it is asked, and what comes


def test_an_opening_comes_as_a_chunk_in_metres_and_degrees() -> None:
    seer = AgentWithoutPhysics(room(), mind(ONCE)).tick(11).agent
    chunk = dict(seer.visual.chunk)
    assert chunk.pop("height") == near(2.5, abs=0.1)
    assert chunk.pop("depth") == math.inf
    assert {chunk.pop("left"), chunk.pop("right")} == {1, 2}
    assert chunk.pop("top") - chunk.pop("bottom") == near(2.5, abs=0.1)
    assert chunk.pop("distance") == near(6.95, abs=0.01)
    assert chunk == {"feature": "opening", "width": 0.6, "direction": 0.0, "cut": False}
    assert (seer.vision.busy, seer.vision.error) == (False, False)


@pytest.mark.parametrize(
    "asked", ["width='>0.61'", "width='<0.5'", "height='>4'", "distance='<2'", "distance=2", "left='!1 !2'", "motion='>0'"]
)
def test_what_fails_is_not_returned_and_the_buffer_empties(asked: str) -> None:
    kind = mind(f"""
    def init():
        visual.set("old")
        goal.set("look")
    def look(goal="look"):
        vision.request("feature:opening", {asked})
        goal.set("wait")
    def nothing(goal="wait", vision="busy:False error:True"):
        goal.set("nothing")
""")
    seer = AgentWithoutPhysics(room(), kind).tick(20).agent
    assert seer.visual.chunk is None
    assert seer.vision.error is True
    assert str(seer.goal.chunk) == "nothing"


@pytest.mark.parametrize(
    "asked",
    [
        "width='>0.59 <0.61'",
        "width=0.6",
        "'width:0.55 height:>=1.5'",
        "depth=2",
        "left=1",
        "left='?one'",
        "left='!?two'",
        "direction='>-1 <1'",
        "cut='False'",
        "cut='!True'",
        "cut=False",
    ],
)
def test_what_holds_is_returned(asked: str) -> None:
    request = f"'feature:opening {asked[1:]}" if asked[0] == "'" else f"'feature:opening', {asked}"
    kind = mind(f"""
    def init():
        goal.set("look one:1 two:2")
    def look(goal="look one:?one two:?two"):
        vision.request({request})
        goal.set("wait")
""")
    assert AgentWithoutPhysics(room(), kind).tick(20).agent.visual.chunk["feature"] == "opening"


def test_a_repeated_request_has_the_present_value_of_its_variable() -> None:
    kind = mind("""
    def init():
        goal.set("look width:0.7 then:0.5")
    def look(goal="look width:?w then:?then", vision="busy:False"):
        vision.request("feature:opening", width=">?w")
        goal.set(f"look width:{then} then:nothing" if then != "nothing" else "wait")
""")
    seer = AgentWithoutPhysics(room(), kind)
    assert seer.tick(11).agent.vision.error
    assert seer.tick(30).agent.visual.chunk["width"] == 0.6


def test_a_request_is_not_taken_for_another_one_with_the_same_text() -> None:
    kind = mind("""
    def init():
        goal.set("look 0.7")
    def look(goal="look ?w", vision="busy:False"):
        width = type("Width", (float,), {"__repr__": lambda self: "a width"})(w)
        vision.request("feature:opening", width=width)
        goal.set("look 0.5" if width == 0.7 else "wait")
""")
    seer = AgentWithoutPhysics(room(), kind)
    assert seer.tick(11).agent.vision.error
    assert seer.tick(30).agent.visual.chunk["width"] == 0.6


def test_a_doorway_whose_top_is_out_of_sight_may_be_high_enough() -> None:
    world = room()
    world.bodies["walker"].set("teleport", 6.2, 0)
    chunk = AgentWithoutPhysics(world, mind(ONCE)).tick(11).agent.visual.chunk
    assert chunk["cut"] is True
    assert chunk["height"] < 1.5
    assert AgentWithoutPhysics(world, asking("vision.request('feature:opening', height='<1.4')")).tick(11).agent.visual.chunk["cut"]


def test_obstacles_within_a_radius_and_a_bearing() -> None:
    world = room(SimpleObject(name="box", position=(1.5, -0.2, 0.9), size=(0.3, 0.3, 1.8)))
    near_by = AgentWithoutPhysics(world, asking("vision.request('feature:obstacle', radius=2, bearing=30)")).tick(11).agent.visual.chunk
    assert near_by["feature"] == "obstacle"
    assert near_by["distance"] == near(1.25, abs=0.01)
    assert -16 < near_by["direction"] < -2
    assert "time_to_contact" not in near_by
    assert AgentWithoutPhysics(world, asking("vision.request('feature:obstacle', radius=1)")).tick(11).agent.vision.error
    assert near_by["aside"] == near(0.05, abs=0.01)
    assert AgentWithoutPhysics(world, asking("vision.request('feature:obstacle', radius=2, aside=0.03)")).tick(11).agent.vision.error
    assert AgentWithoutPhysics(world, asking("vision.request('feature:obstacle', time_to_contact=1)")).tick(11).agent.vision.error
    told = (
        AgentWithoutPhysics(world, asking("vision.request('feature:obstacle', time_to_contact=1, speed=1.4)")).tick(11).agent.visual.chunk
    )
    assert told["time_to_contact"] == near(near_by["distance"] / 1.4, abs=0.04)


WALKING = """
    body = BodyPort()
    def init():
        body.set("walk", 1.5)
        goal.set("look")
    def look(goal="look", vision="busy:False", visual=None):
        vision.request("feature:obstacle", time_to_contact=2.0)
    def arrives(visual="feature:obstacle time_to_contact:?t distance:?d motion:?m"):
        self.seen = (float(t), float(d), float(m))
        self.stop()
"""


def test_the_time_to_contact_is_known_from_two_looks() -> None:
    kind = mind(WALKING)
    simulation = Simulation(
        Scene(parts=(Floor(), Wall(name="wall", start=(6, -4), end=(6, 4)), Mannequin(name="walker"))), {"walker": kind}
    )
    simulation.run(10)
    time, distance, motion = simulation.agents["walker"].seen
    assert 1.8 < time <= 2.0
    assert time == near(distance / 1.5, abs=0.02)
    assert motion == near(1.5, abs=0.05)


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        ("vision.request('feature:openin')", "no feature 'openin' to look for; did you mean 'opening'? There are: feature:obstacle"),
        ("vision.request('opening')", "the request 'opening' must name a feature and slots, all with their names"),
        ("vision.request('width:2')", "must name a feature"),
        ("vision.request(5)", r"a request is a text such as 'feature:opening' \(got 5\)"),
        ("vision.request('feature:opening', widht='>1')", "feature:opening has no 'widht'; did you mean 'width'? It has: distance, "),
        ("vision.request('feature:opening', radius=1)", "feature:opening has no 'radius'"),
        ("vision.request('feature:opening', width='>?wide')", r"'\?wide' is not bound"),
        ("vision.request('feature:opening', width='>>1')", "cannot read width='>>1'; write a number or"),
        ("vision.request('feature:opening', width='>wide')", "width is compared with a number in m"),
        ("vision.request('feature:opening', width='wide')", "width is compared with a number in m"),
        ("vision.request('feature:opening', width='')", "width has no value"),
        ("vision.request('feature:opening', direction=5)", "direction needs a comparison: write '>5' or '<5'"),
        ("vision.request('feature:opening', left='>2')", "left cannot be compared by size"),
        ("vision.request('feature:opening width:1', width=2)", "'width' is given twice"),
        ("vision.request('feature:obstacle', bearing='>20')", r"bearing takes one number \[degrees\]"),
    ],
)
def test_invalid_requests_are_reported(request_: str, says: str) -> None:
    with pytest.raises(Actr3dError, match=says.replace("? ", r"\? ")):
        AgentWithoutPhysics(room(), asking(request_)).tick(11)


def test_invalid_parameters_are_reported() -> None:
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"dely": 1}, "Vision has no parameter 'dely'; did you mean 'delay'"),
        ({"horizontal_fof": 1}, "did you mean 'horizontal_fov'"),
        ({"delay": -1}, r"Vision\.delay: must be >= 0"),
        ({"delay": "soon"}, r"Vision\.delay: must be a number"),
        ({"error_rate": 2}, r"Vision\.error_rate: must be <= 1"),
        ({"rule": "luck"}, r"Vision\.rule: must be one of 'share', 'sos'"),
        ({"salience": {"opning": "size"}}, "no feature 'opning'; did you mean 'opening'"),
        ({"rows": 0}, r"CameraParameters\.rows"),
        ({"salience": "sise"}, "did you mean 'size'"),
    ]
    for options, says in wrong:
        with pytest.raises(Actr3dError, match=says):
            Vision(None, **options)
    with pytest.raises(ParameterError):
        Vision()  # type: ignore[call-arg]
    with pytest.raises(VisionError, match=r"must return a number >= 0 \(got -1"):
        AgentWithoutPhysics(room(), asking("vision.request('feature:opening')", ", salience=lambda feature: -1")).tick(11)


def test_an_agent_without_a_body_sees_nothing() -> None:
    with pytest.raises(SimulationError, match=r"port '.*vision' has no body"):
        asking("vision.request('feature:opening')")().run(1)
    with pytest.raises(SimulationError, match="before the agent runs"):
        Vision(None).request("feature:opening")


# -- when it comes


def arrivals(body: str, options: str = "", seed: int = 1, ticks: int = 40) -> list[tuple[float, dict[str, Any]]]:
    trace = Trace("all")
    AgentWithoutPhysics(room(), mind(body, options), seed, trace).tick(ticks)
    return list(events(trace, "sight"))


@pytest.mark.parametrize(("delay", "expected"), [("0.05", 0.1), ("0.037712", 0.087712), ("0", 0.05), ("0.000001", 0.050001)])
def test_delays_are_exact(delay: str, expected: float) -> None:
    ((time, _),) = arrivals(ONCE, f", delay={delay}")
    assert time == expected


def test_a_view_is_that_of_the_end_of_the_tick_and_nothing_comes_before_it() -> None:
    body = """
    production_time = 0.043
    def init():
        goal.set("look")
    def look(goal="look"):
        vision.request("feature:opening")
        goal.set("wait")
"""
    ((time, _),) = arrivals(body, ", delay=0.002")
    assert time == 0.05  # asked at 0.043, due at 0.045, but the tick ends at 0.05
    ((time, _),) = arrivals(body, ", delay=0.02")
    assert time == 0.063


def test_noise_of_delays_comes_from_the_seed() -> None:
    first = [arrivals(ONCE, ", delay_sd=0.02", seed)[0][0] for seed in range(20)]
    assert first[:5] == [arrivals(ONCE, ", delay_sd=0.02", seed)[0][0] for seed in range(5)]
    assert len(set(first)) > 15
    assert min(first) >= 0.05
    assert sum(first) / 20 == near(0.1, abs=0.015)


@pytest.mark.slow
def test_errors_come_at_their_rate() -> None:
    failed = [arrivals(ONCE, ", error_rate=0.3", seed)[0][1]["failed"] for seed in range(200)]
    assert 40 <= sum(failed) <= 82  # 60 are expected; 3.4 standard deviations
    assert all(arrivals(ONCE, ", error_rate=1", seed)[0][1]["failed"] for seed in range(5))


def test_noise_of_edges_and_distances_is_of_its_size_and_from_the_seed() -> None:
    world = room()

    def widths(options: str, seeds: int = 150) -> list[float]:
        kind = mind("\n    def look(goal=None, vision='busy:False', visual=None):\n        vision.request('feature:opening')\n", options)
        return [AgentWithoutPhysics(world, kind, seed).tick(11).agent.visual.chunk["width"] for seed in range(seeds)]

    def sd(numbers: list[float]) -> float:
        mean = sum(numbers) / len(numbers)
        return math.sqrt(sum((x - mean) ** 2 for x in numbers) / len(numbers))

    assert set(widths("", 5)) == {0.6}
    edges = widths(", edge_noise=0.005")
    assert edges[:5] == widths(", edge_noise=0.005", 5)
    assert sd(edges) == near(0.005 * 6.96 * math.sqrt(2), rel=0.2)
    assert sum(edges) / len(edges) == near(0.6, abs=0.02)
    far = widths(", distance_noise=0.01", 50)  # 10 cm at each edge, along the line of sight
    assert 0.003 < sd(far) < 0.03


def test_a_further_request_takes_the_place_of_the_first() -> None:
    body = """
    def init():
        goal.set("look")
    def look(goal="look"):
        vision.request("feature:opening")
        goal.set("again")
    def again(goal="again"):
        vision.request("feature:obstacle")
        goal.set("wait")
"""
    ((time, data),) = arrivals(body, ", delay=0.12")
    assert (time, data["chunk"]["feature"]) == (0.22, "obstacle")
    ((time, data),) = arrivals(body, ", delay=0.12, rule='sos', salience='equal'")
    assert (time, data["chunk"]["feature"]) == (0.17, "opening")  # SOS Vision does nothing while it is busy


def test_a_generator_can_wait_for_a_search() -> None:
    kind = agent(
        HEAD
        + """
class Agent(Model):
    visual = Buffer()
    vision = Vision(visual)
    def start(self):
        yield 0.02
        yield self.vision.request("feature:opening", width=">0.5")
        self.at = self.now()
        self.width = self.visual["width"]
"""
    )
    seer = AgentWithoutPhysics(room(), kind).tick(11).agent
    assert (seer.at, seer.width) == (0.07, 0.6)


# -- who comes first


def test_contract_bottom_up_vision_gives_way_to_top_down_vision() -> None:
    """A bottom-up request waits until a top-down one is done; that never waits, and what it brings is not overwritten at once."""
    trace = Trace("all")
    kind = agent(
        HEAD
        + """
class Watching(ProductionSystem):
    production_time = 0.01
    def watch(vision="watching:False"):
        vision.request("feature:obstacle", radius=9, bottom_up=True)

class Agent(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual, delay=0.05, bottom_up_delay=0.02, hold=0.06)
    below = Watching()
    def init():
        goal.set("idle")
    def idle(goal="idle"):
        goal.set("look")
    def ask(goal="look"):
        vision.request("feature:opening", width=">0.4")
        goal.set("read")
    def read(goal="read", visual="feature:opening width:?w"):
        goal.set("done ?w")
"""
    )
    seer = AgentWithoutPhysics(room(), kind, 1, trace).tick(30).agent
    asked = [(time, data["bottom_up"]) for time, data in events(trace, "request")]
    came = [(time, data["bottom_up"], data.get("held", False)) for time, data in events(trace, "sight")]
    # Alone, it goes round every 30 ms: 10 ms of a production, 20 ms of a search.
    assert asked[:3] == [(0.01, True), (0.04, True), (0.07, True)]
    assert came[:3] == [(0.03, True, False), (0.06, True, False), (0.09, True, False)]
    # At 0.1 s both ask. The top-down request is answered after its 50 ms; only then the other one begins, and takes its 20 ms.
    assert sorted(asked[3:5]) == [(0.1, False), (0.1, True)]
    assert came[3] == (0.15, False, False)
    # For 60 ms its chunk is safe; then what bottom-up vision sees takes its place.
    assert came[4:7] == [(0.17, True, True), (0.2, True, True), (0.23, True, False)]
    assert str(seer.goal.chunk) == "done 0.6"
    assert seer.visual.chunk["feature"] == "obstacle"


def test_a_top_down_request_is_not_delayed_by_a_running_search_which_begins_again() -> None:
    trace = Trace("all")
    kind = agent(
        HEAD
        + """
class Agent(Model):
    visual = Buffer()
    vision = Vision(visual, delay=0.05, bottom_up_delay=0.04, hold=0)
    def start(self):
        yield 0.02
        below = self.vision.request("feature:obstacle", radius=9, bottom_up=True)
        yield 0.013
        yield self.vision.request("feature:opening")
        self.first = self.now()
        yield below
        self.second = self.now()
"""
    )
    seer = AgentWithoutPhysics(room(), kind, 1, trace).tick(30).agent
    assert (seer.first, seer.second) == (0.083, 0.123)
    assert [time for time, _ in events(trace, "answer")] == [0.02, 0.04, 0.09]  # it looks anew
    assert [(data["bottom_up"], data["chunk"]["feature"]) for _, data in events(trace, "sight")] == [(False, "opening"), (True, "obstacle")]


def test_a_bottom_up_search_that_finds_nothing_changes_nothing() -> None:
    kind = agent(
        HEAD
        + """
class Agent(Model):
    visual = Buffer()
    vision = Vision(visual, hold=0)
    def start(self):
        yield self.vision.request("feature:opening")
        yield self.vision.request("feature:obstacle", radius=1, bottom_up=True)
        self.then = (self.visual["feature"], self.vision.error)
        yield self.vision.request("feature:opening", width=">5")
        yield self.vision.request("feature:obstacle", radius=9, bottom_up=True)
        self.at_last = (self.visual["feature"], self.vision.error)
"""
    )
    seer = AgentWithoutPhysics(room(), kind).tick(40).agent
    assert seer.then == ("opening", False)
    assert seer.at_last == ("obstacle", True)  # the error is of what was asked top-down


# -- the same again


LIVING = (
    HEAD
    + """
class Watching(ProductionSystem):
    production_time = 0.01
    def watch(vision="watching:False"):
        vision.request("feature:obstacle", radius=3, bearing=40, bottom_up=True)

class Agent(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual, delay_sd=0.01, edge_noise=0.002, distance_noise=0.02, error_rate=0.1, rows=40)
    below = Watching()
    body = BodyPort()
    def init():
        goal.set("look")
        body.set("walk", 1.0)
    def look(goal="look", vision="busy:False"):
        vision.request("feature:opening", height=1)
        goal.set("see")
    def see(goal="see", visual="feature:opening direction:?d", vision="busy:False"):
        body.set("walk", 1.0, turn=0.02 * float(d))
        goal.set("look")
    def fail(goal="see", vision="busy:False error:True"):
        goal.set("look")
    def avoid(visual="feature:obstacle direction:?d"):
        body.set("walk", 1.0, turn=-0.01 * float(d))
        visual.clear()
        goal.set("look")
"""
)


def living(prefix: str = "", seed: int = 3) -> Simulation:
    kind = agent(LIVING)
    boxes = [SimpleObject(name=f"{prefix}{n}", position=(2.0 + n, 1.2 - 2.4 * (n % 2), 0.5), size=(0.4, 0.4, 1.0)) for n in (3, 1, 2)]
    scene = Scene(parts=(Floor(name=f"{prefix}floor"), Aperture(name=f"{prefix}gap", width=0.9), *boxes, Mannequin(name="walker")))
    return Simulation(scene, {"walker": kind}, seed=seed, trace="all")


def test_the_same_seed_gives_the_same_bytes_also_after_going_back() -> None:
    whole = living()
    whole.step(120)
    assert any(True for _ in events(whole.trace, "sight"))
    expected = digest(whole)
    again = living()
    for _ in range(120):
        again.step()
    assert digest(again) == expected
    for time in (0.37, 1.1, 0.0):
        again.seek(time)
        again.step(120 - again.ticks)
        assert digest(again) == expected
    other = living(seed=4)
    other.step(120)
    assert digest(other) != expected


def test_other_names_of_all_things_change_no_byte_of_what_it_does() -> None:
    first, renamed = living(), living("zzz_")
    first.step(200)
    renamed.step(200)
    assert digest(first) == digest(renamed)
