"""Timer, imaginal module, motor, vision, SOS vision and text output."""

from __future__ import annotations

from statistics import fmean, stdev
from typing import Any

import pytest

from actr3d.actr import ACTR, Buffer, ImaginalModule, Model, Motor, SOSVision, TextOutput, Timer, Vision
from actr3d.actr.kernel.run_limits import RunLimits
from tests.helpers.small_agents import near


class Agent(ACTR):
    """An agent without productions, with every module."""

    visual = Buffer()
    location = Buffer()
    imaginal = Buffer()
    vision = Vision(visual, location)
    sos = SOSVision(visual, delay=0.1)
    hand = Motor()
    picture = ImaginalModule(imaginal)
    mouth = TextOutput()


class World(Model):
    def __init__(self, **things: Any) -> None:
        Model.__init__(self, **things)
        self.agent = Agent()
        self._keys: list[tuple[Any, float]] = []

    def key_pressed(self, key: Any) -> None:
        self._keys.append((key, self.now()))


def world_of(seed: int = 1, **things: Any) -> Any:
    with RunLimits(seed=seed):
        world: Any = World(**things)
        world.run(0)
    return world


# -- timer


def pulses(b: float, count: int, seed: int = 1) -> list[float]:
    with RunLimits(seed=seed):
        agent: Any = Model()
        agent.timer = Timer(b=b)
        times: list[float] = []
        while agent.timer.count < count:
            before = agent.timer.count
            agent.run(0.001)
            if agent.timer.count != before:
                times.append(agent.now())
    return times


def test_pulses_without_noise_grow_by_a_tenth_each() -> None:
    times = pulses(b=0, count=12)
    lengths = [0.011 * 1.1**n for n in range(12)]
    ends = [sum(lengths[: n + 1]) for n in range(12)]
    assert times == near(ends, abs=0.0011)


def test_mean_pulses_with_noise_follow_the_published_equation() -> None:
    def lengths(seed: int) -> list[float]:
        with RunLimits(seed=seed):
            agent: Any = Model()
            agent.timer = Timer()
            agent.run(0)
            found: list[float] = []
            while len(found) < 15:
                if len(found) < agent.timer.count + 1:
                    found.append(agent.timer.t)
                agent.run(0.002)
        return found

    runs = [lengths(seed) for seed in range(300)]
    for n in range(1, 15):
        values = [run[n] for run in runs]
        expected = 0.011 * 1.1**n
        # t_n is a product of n factors 1.1 (1 + 0.015 z), so its relative spread is about 0.015 sqrt(n)
        assert fmean(values) == near(expected, rel=4 * 0.015 * (n / 300) ** 0.5)
        assert stdev(values) / expected == near(0.015 * n**0.5, rel=0.25)


def test_a_timer_counts_from_0_after_reset_also_before_its_first_pulse() -> None:
    agent: Any = Model()
    agent.timer = Timer(b=0)
    agent.run(0.005)
    agent.timer.reset()
    agent.run(0.0109)
    assert agent.timer.count == 0
    agent.run(0.0002)
    assert agent.timer.count == 1
    agent.run(0.5)
    assert agent.timer.count > 5
    agent.timer.reset()
    agent.run(0)
    assert agent.timer.count == 0
    agent.run(0.0111)
    assert agent.timer.count == 1


# -- imaginal module


def test_imaginal_changes_take_200_ms_and_one_at_a_time() -> None:
    agent = world_of().agent
    agent.picture.set("a:1 b:2")
    agent.run(0.1)
    agent.picture.set("other")
    assert agent.picture.busy
    assert agent.imaginal.isEmpty()
    agent.run(0.1)
    assert not agent.picture.busy
    assert agent.imaginal.chunk == {"a": "1", "b": "2"}
    agent.picture.modify(a=3)
    agent.run(0.2)
    assert agent.imaginal["a"] == 3
    agent.picture.clear()
    agent.run(0.19)
    assert not agent.imaginal.isEmpty()
    agent.run(0.01)
    assert agent.imaginal.isEmpty()


def test_imaginal_delays_of_every_kind() -> None:
    agent = world_of().agent
    agent.picture.delay = lambda: 0.5
    assert agent.picture.delay_time() == 0.5
    agent.picture.delay, agent.picture.delay_sd = 0.1, 0.1
    times = [agent.picture.delay_time() for _ in range(500)]
    assert min(times) == 0
    assert fmean(times) == near(0.108, abs=0.015)  # a normal distribution cut off at 0


def test_an_imaginal_change_that_fails_does_not_stay_busy() -> None:
    agent = world_of().agent
    agent.picture.modify(a=1)
    with pytest.raises(Exception, match="buffer 'imaginal' is empty: there is no slot 'a' to modify"):
        agent.run(1)
    assert not agent.picture.busy


# -- motor


def test_a_key_is_struck_after_400_ms_and_the_hand_is_free_after_550() -> None:
    world = world_of()
    world.agent.hand.press("x")
    world.run(0.1)
    world.agent.hand.press("ignored while busy")
    world.run(0.3)
    assert world._keys == [("x", 0.4)]
    assert world.agent.hand.busy
    world.run(0.15)
    assert not world.agent.hand.busy
    world.run(1)
    assert world._keys == [("x", 0.4)]


def test_a_press_without_an_environment_says_what_is_missing() -> None:
    agent = Agent()
    agent.run(0)
    agent.hand.press("x")
    with pytest.raises(AttributeError, match=r"Motor 'hand'.*key_pressed.*environment"):
        agent.run(1)


# -- SOS vision


def test_sos_vision_returns_what_matches() -> None:
    world = world_of(ball=Model(color="red", salience=1.0), box=Model(color="blue", salience=1.0), air=Model(color="red"))
    world.agent.sos.request("color:red")
    world.run(0.05)
    assert world.agent.sos.busy
    assert world.agent.visual.isEmpty()
    world.run(0.05)
    assert not world.agent.sos.busy
    assert world.agent.visual["color"] == "red"
    assert world.agent.visual["salience"] == 1.0
    world.agent.sos.request("color:green")
    world.run(0.1)
    assert world.agent.visual.isEmpty()
    assert world.agent.sos.error
    world.agent.sos.request("color:blue")
    world.run(0.1)
    assert not world.agent.sos.error


def test_sos_vision_overlooks_what_is_hidden_worthless_or_goes_away() -> None:
    things: list[dict[str, Any]] = [{"visible": False}, {"value": None, "visible": True}, {"salience": 0.0, "visible": True}]
    for attributes in things:
        world = world_of(ball=Model(color="red", **attributes))
        world.agent.sos.request("color:red")
        world.run(0.1)
        assert world.agent.sos.error
    world = world_of(ball=Model(color="red", visible=True))
    world.agent.sos.request("color:red")
    world.run(0.05)
    world.ball.visible = False
    world.run(0.05)
    assert world.agent.sos.error


def test_salience_is_the_probability_of_being_noticed() -> None:
    world = world_of(ball=Model(color="red", salience=0.3))
    found = 0
    for _ in range(2000):
        world.agent.sos.request("color:red")
        world.run(0.1)
        found += not world.agent.sos.error
    assert found / 2000 == near(0.3, abs=0.041)  # four standard errors


def test_variables_of_a_production_mean_nothing_to_sos_vision_as_in_python_actr() -> None:
    world = world_of(ball=Model(color="red", visible=True))
    world.sch.bound = {"color": "blue"}
    world.agent.sos.request("color:?color")
    world.run(0.1)
    assert world.agent.visual["color"] == "red"


# -- vision


def test_vision_is_drawn_to_what_appears_and_examines_it() -> None:
    world = world_of(ball=Model(x=1, y=2.5, color="red"))
    agent = world.agent
    world.run(0)
    assert agent.location.chunk == {0: "1", 1: "2.5"}
    agent.vision.examine("1 2.5")
    world.run(0.084)
    assert agent.vision.busy
    assert agent.visual.isEmpty()
    world.run(0.001)
    assert not agent.vision.busy
    assert agent.visual["color"] == "red"


def test_attend_to_new_and_unattended() -> None:
    world = world_of(ball=Model(x=1, y=2, color="red"))
    agent = world.agent
    world.run(1)
    agent.location.clear()
    agent.vision.attendToNew("color:red")
    assert agent.location.isEmpty()
    agent.vision.attendTo("color:red")
    assert agent.location[0] == "1"
    agent.vision.examine("color:red")
    world.run(0.1)
    agent.location.clear()
    agent.vision.attendToUnattended("color:red")
    assert agent.location.isEmpty()
    world.box = Model(x=5, y=6, color="red")
    agent.vision.attendToNew("color:red")
    assert agent.location[0] == "5"


def test_examining_an_object_that_is_gone_clears_the_buffer() -> None:
    world = world_of(ball=Model(x=1, y=2, color="red"))
    world.agent.visual.set("old")
    world.agent.vision.examine("color:red")
    world.run(0.05)
    world.ball.parent = None
    world.run(0.05)
    assert world.agent.visual.isEmpty()


# -- text


def test_text_output_prints(capsys: pytest.CaptureFixture[str]) -> None:
    agent = world_of().agent
    agent.mouth.write("hello")
    agent.mouth.write(3)
    assert capsys.readouterr().out == "hello\n3\n"
