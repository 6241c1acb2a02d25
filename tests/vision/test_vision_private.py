"""The raw view: private to an agent's vision module unless that says otherwise, and marked in the trace wherever it is asked for."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.actr.loading import load_text
from actr3d.errors import ParameterError, SimulationError, WorldError
from actr3d.simulation import Simulation
from actr3d.vision import Vision
from tests.helpers.walkers import scene_of

HEAD = """
from actr3d.actr import *
from actr3d.simulation import BodyPort
from actr3d.vision import Vision
"""
SEEING = """
class Seeing(ACTR):
    goal = Buffer()
    seen = Buffer()
    visual = Buffer()
    eye = BodyPort(seen)
    skin = BodyPort()
    PARTS
    def init():
        goal.set("look")
    def look(goal="look"):
        eye.ASK("view", rows=2)
        goal.set("wait")
    def see(goal="wait", seen="view"):
        goal.set("saw")
"""
PRIVATE = "vision = Vision(visual)"
OPEN = "vision = Vision(visual, private_view=False)"


def run(parts: str, ask: str = "request", extra: str = "", **kinds: str) -> Any:
    """Runs agents for 15 ticks, and returns the simulation."""
    module = load_text(HEAD + extra + SEEING.replace("PARTS", parts).replace("ASK", ask), "seeing.py")
    kinds = kinds or {"walker": "Seeing"}
    simulation = Simulation(scene_of(*kinds), {name: getattr(module, kind) for name, kind in kinds.items()}, seed=1, trace="all")
    simulation.run(0.15)
    return simulation


def requests(simulation: Any) -> list[dict[str, Any]]:
    return [event.data for event in simulation.trace if event.kind == "request" and event.data.get("word") == "view"]


@pytest.mark.parametrize("ask", ["request", "get"])
@pytest.mark.parametrize(
    ("parts", "extra", "vision"),
    [
        (PRIVATE, "", "walker.vision"),
        ("looking = Looking()", f"class Looking(ProductionSystem):\n    visual = Buffer()\n    {PRIVATE}\n", "walker.looking.vision"),
        (f"{OPEN}; other = Vision(visual)", "", "walker.other"),
    ],
    ids=["its own", "that of a parallel system", "one of two"],
)
def test_an_agent_with_vision_is_refused_the_raw_view(parts: str, extra: str, vision: str, ask: str) -> None:
    with pytest.raises(SimulationError) as refused:
        run(parts, ask, extra)
    assert str(refused.value) == (
        f"port 'walker.eye' cannot ask body 'walker' for 'view': agent 'walker' (Seeing) keeps it private to its module '{vision}'; "
        "make that with Vision(private_view=False) to let other ports of the agent have it too"
    )
    assert any("seeing.py" in str(entry.path) for entry in refused.traceback)


def test_an_agent_may_open_its_view_and_the_trace_says_that_it_steps_outside() -> None:
    simulation = run(OPEN)
    assert requests(simulation) == [{"call": "request", "word": "view", "named": {"rows": 2}, "outside_vision": True}]
    assert simulation.agents["walker"].goal.chunk[0] == "saw"


def test_so_does_an_agent_without_vision() -> None:
    simulation = run("")
    assert [request["outside_vision"] for request in requests(simulation)] == [True]
    assert simulation.agents["walker"].goal.chunk[0] == "saw"


def test_vision_itself_and_other_words_are_not_marked() -> None:
    text = """
class Looking(ACTR):
    goal = Buffer()
    visual = Buffer()
    felt = Buffer()
    body = BodyPort(felt)
    vision = Vision(visual)
    def init():
        goal.set("look")
    def look(goal="look"):
        vision.request("feature:opening")
        body.request("pose")
        goal.set("wait")
"""
    simulation = run(PRIVATE, extra=text, walker="Looking")
    asked = [event.data for event in simulation.trace if event.kind == "request"]
    assert len(asked) == 2
    assert not any("outside_vision" in data for data in asked)


def test_the_vision_of_one_agent_closes_no_view_of_another() -> None:
    blind = "class Blind(ACTR):\n    visual = Buffer()\n    vision = Vision(visual)\n"
    simulation = run("", extra=blind, walker="Seeing", other="Blind")
    assert simulation.agents["walker"].goal.chunk[0] == "saw"


def test_the_option_may_change_on_the_way() -> None:
    opening = (
        "vision = Vision(visual)\n    def open_up(goal='look', vision='private_view:True', utility=9):\n        vision.private_view = False"
    )
    assert run(opening).agents["walker"].goal.chunk[0] == "saw"


def test_the_option_is_true_or_false() -> None:
    with pytest.raises(ParameterError, match=r"Vision\.private_view: must be True or False \(got 'no'\)"):
        Vision(None, private_view="no")  # type: ignore[arg-type]


@pytest.mark.parametrize("sensor", ["image", "depth"])
def test_pictures_of_the_eye_are_as_private_as_its_view(sensor: str) -> None:
    text = SEEING.replace('eye.ASK("view", rows=2)', f'eye.get("{sensor}", width=4, height=3)').replace("Seeing", "Drawing")
    kinds = {"extra": text.replace("PARTS", PRIVATE), "walker": "Drawing"}
    with pytest.raises(
        SimulationError, match=rf"for '{sensor}': agent 'walker' \(Drawing\) keeps it private to its module 'walker.vision'"
    ):
        run(PRIVATE, **kinds)


@pytest.mark.parametrize("word", [["view"], None, 3])
def test_what_is_no_word_is_refused_as_before(word: Any) -> None:
    text = "class Odd(ACTR):\n    visual = Buffer()\n    vision = Vision(visual)\n    body = BodyPort()\n"
    with pytest.raises(WorldError, match="has no sensor"):
        run("", extra=f"{text}    def init():\n        body.get({word!r})\n", walker="Odd")
