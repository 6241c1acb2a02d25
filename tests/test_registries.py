"""Each kind of thing that is registered where it is defined, in one file each, such as sensors: each keeps the common rules."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from string import Formatter
from typing import Any, get_args

import pytest
from mujoco import MjSpec

import actr3d.actr
import actr3d.camera  # pyright: ignore[reportUnusedImport] # it registers `view`
import actr3d.world
from actr3d.actr.declarative.activation_parts import ACTIVATION_PARTS
from actr3d.actr.kernel.model import Model
from actr3d.actr.loading import load_text
from actr3d.actr.modules import MODULES
from actr3d.bench import find_benchmarks
from actr3d.change import CHANGES, Change, Target, change
from actr3d.errors import SimulationError, WorldError
from actr3d.experiment import find_measures
from actr3d.experiment.report.analyses import ANALYSES, find_analyses
from actr3d.simulation import Simulation
from actr3d.simulation.measure import MEASURES
from actr3d.trace_kinds import KINDS
from actr3d.vision import DETECTORS
from actr3d.world import Body, Car, Floor, ImportedBody, Scene, World
from actr3d.world.anatomy import BODY_KINDS, Anatomy, Embodied, body_kind
from actr3d.world.body import ACTUATORS, SENSORS, actuator, sensor
from tests.helpers.syntax_trees import tree_of

ARM = """<mujoco><worldbody><body name="arm"><joint name="elbow" axis="0 0 1"/><geom size="0.1"/><site name="eye"/></body></worldbody>
  <actuator><motor name="turn" joint="elbow"/></actuator></mujoco>"""
REQUIRED: dict[str, dict[str, Any]] = {"ImportedBody": {"name": "arm", "text": ARM, "eye": "eye"}}
"""By kind of body: the fields that have no default."""


def example(kind: str) -> Embodied:
    return BODY_KINDS[kind](**REQUIRED.get(kind, {}))


@cache
def one_of_each_kind() -> list[Body]:
    """Returns bodies to look at: they are shared by tests."""
    return [World(Scene(parts=(example(kind),))).bodies.popitem()[1] for kind in BODY_KINDS]


def analyses() -> list[str]:
    """Returns the names of all analyses."""
    find_analyses([])
    return list(ANALYSES)


@pytest.fixture
def registered() -> Iterator[None]:
    """Forgets after a test what it has registered."""
    before = [(registry, dict(registry)) for registry in (ACTUATORS, SENSORS, BODY_KINDS, CHANGES, MODULES, KINDS, MEASURES, ANALYSES)]
    yield
    for registry, known in before:
        registry.clear()
        registry.update(known)  # pyright: ignore[reportArgumentType, reportCallIssue]


@pytest.mark.parametrize("kind", BODY_KINDS)
def test_each_kind_of_body_describes_itself_and_steps_and_senses(kind: str) -> None:
    description = example(kind)
    assert isinstance(description, Embodied)
    world = World(Scene(parts=(Floor(), description)))
    body = world.bodies[description.name]
    world.step(5)
    for word in set(body.sensors) - {"image", "depth"}:  # these need EGL
        body.get(word)
    state = world.state()
    world.step(5)
    later = world.state_bytes()
    world.restore(state)
    world.step(5)
    assert world.state_bytes() == later


@pytest.mark.parametrize("word", [*ACTUATORS, *SENSORS])
def test_each_word_explains_itself_and_some_body_has_it(word: str) -> None:
    registry = ACTUATORS if word in ACTUATORS else SENSORS
    assert registry[word].meaning.endswith(".")
    assert any(word in (body.actuators if word in ACTUATORS else body.sensors) for body in one_of_each_kind())


@pytest.mark.usefixtures("registered")
def test_a_new_sensor_and_a_new_actuator_are_there_at_once_also_for_bodies_that_exist() -> None:
    world = World(Scene(parts=(Floor(), Car())))
    body = world.bodies["car"]

    @sensor.if_body(lambda body: body.anatomy.steering is not None)
    def height(body: Body) -> float:
        """Senses the height of the body's top [m]."""
        return body.bounding_box().upper[2]

    @actuator
    def honk(body: Body, times: int = 1) -> None:
        """Sounds the horn."""
        honks.append((body.name, times))

    honks: list[tuple[str, int]] = []
    assert body.get("height") == pytest.approx(1.45)
    body.set("honk", 2)
    assert honks == [("car", 2)]
    assert (height(body), honk.__name__) == (body.get("height"), "honk")
    assert {"height", "honk"} <= {*body.sensors, *body.actuators}
    assert "height" not in World(Scene(parts=(ImportedBody(**REQUIRED["ImportedBody"]),))).bodies["arm"].sensors


@pytest.mark.usefixtures("registered")
def test_a_sensor_or_an_actuator_of_the_library_is_not_replaced_and_the_same_may_be_defined_again() -> None:
    def pose(body: Body) -> int:
        return 1

    def walk(body: Body) -> None: ...

    with pytest.raises(ValueError, match=r"sensor 'pose' is defined twice: actr3d\.world\.sensors\.motion\.pose and .*test_registries"):
        sensor(pose)
    with pytest.raises(ValueError, match=r"actuator 'walk' is defined twice: actr3d\.world\.actuators\.motion\.walk and "):
        actuator(walk)
    for answer in (1, 2):  # as when a model file is loaded again

        @sensor
        def height(body: Body, answer: int = answer) -> int:
            return answer

        assert World(Scene(parts=(Car(),))).bodies["car"].get("height") == answer


@pytest.mark.usefixtures("registered")
def test_code_without_the_name_of_a_module_can_define_things() -> None:
    text = """
from actr3d.vision import Feature, detector
from actr3d.world import sensor
class Glow(Feature): pass
detector(Glow)(lambda view: ())
@sensor
def glow(body): return 1
"""
    try:
        for _ in range(2):
            exec(text, {})
        assert World(Scene(parts=(Car(),))).bodies["car"].get("glow") == 1
        assert DETECTORS["glow"].finds.called() == "glow"
    finally:
        DETECTORS.pop("glow", None)


OWN_THINGS = '''
from actr3d.actr import *
from actr3d.actr.modules import module
from actr3d.change import Change, change
from actr3d.experiment.report import analysis
from actr3d.simulation.measure import measure
from actr3d.trace_kinds import trace_kind
from actr3d.world import Body, actuator, sensor
from actr3d.world.anatomy import body_kind

ANSWER = 1


@sensor
def north(body: Body) -> int:
    """Senses where north is."""
    return ANSWER


@actuator
def whistle(body: Body) -> None:
    """Whistles."""
    heard.append(ANSWER)


heard = []
trace_kind("whistled", source="a walker", data="loudness", meaning=f"It whistled {ANSWER} times.")


@module
class Ear(Model): ...


@body_kind
class Pebble: ...


@measure
class Noise: ...


@change
class Louder(Change):
    word = "louder"
    title = "Louder"


@analysis("noise")
def noises(results, beside):
    return []
'''
OWN: dict[str, Any] = {
    "north": SENSORS,
    "whistle": ACTUATORS,
    "whistled": KINDS,
    "Ear": MODULES,
    "Pebble": BODY_KINDS,
    "Noise": MEASURES,
    "louder": CHANGES,
}
TWICE = r"sensor '{0}' is defined twice: {1}\.{0} and actr3d_model_\w+\.{0}"


@pytest.mark.usefixtures("registered")
def test_each_text_of_a_model_means_what_it_defines_however_often_it_and_others_are_loaded() -> None:
    before = len(ANALYSES)
    kept: list[tuple[Any, Body]] = []
    for text in (OWN_THINGS, OWN_THINGS, OWN_THINGS.replace("ANSWER = 1", "ANSWER = 2"), OWN_THINGS):
        module: Any = load_text(text, "walker.py")
        body = World(Scene(parts=(Car(),))).bodies["car"]
        kept.append((module, body))
        assert all(name in registry for name, registry in OWN.items())
        assert (MODULES["Ear"], BODY_KINDS["Pebble"]) == (module.Ear, module.Pebble)
        assert (MEASURES["Noise"], CHANGES["louder"]) == (module.Noise, module.Louder)
        assert KINDS["whistled"].meaning == f"It whistled {module.ANSWER} times."
    for module, body in kept:  # they are used at the same time
        body.set("whistle")
        assert (body.get("north"), module.heard) == (module.ANSWER, [module.ANSWER])
    assert len(ANALYSES) == before + 2, "one for each of the two texts"


@pytest.mark.usefixtures("registered")
def test_a_text_replaces_nothing_of_the_library_and_its_helper_module_nothing_of_the_text(tmp_path: Path) -> None:
    own = OWN_THINGS.replace("def north(", "def pose(")
    with pytest.raises(ValueError, match=TWICE.format("pose", r"actr3d\.world\.sensors\.motion")):
        load_text(own, "walker.py")
    (tmp_path / "compass.py").write_text(OWN_THINGS, encoding="utf-8")
    with pytest.raises(ValueError, match=TWICE.format("north", r"actr3d_model_\w+_files\.compass")):
        load_text(f"import compass\n{OWN_THINGS}", "walker.py", folder=tmp_path)


@pytest.mark.usefixtures("registered")
def test_a_new_kind_of_body_lives_in_a_scene_without_any_other_change() -> None:
    @body_kind
    class Marble:
        name = "ball"

        def add_to(self, mj_spec: MjSpec) -> None:
            mj_spec.worldbody.add_body(name="ball", pos=[0, 0, 1]).add_geom(size=[0.1, 0, 0])
            mj_spec.body("ball").add_freejoint()

        def anatomy(self) -> Anatomy:
            return Anatomy(root="ball", prefix="ball_", shoulders=0.2)

    assert BODY_KINDS["Marble"] is Marble
    body = World(Scene(parts=(Floor(), Marble()))).bodies["ball"]
    assert body.anatomy.shoulders == 0.2
    assert body.get("pose").z == 1


def test_no_part_of_the_library_asks_for_a_kind_of_body() -> None:
    root = Path(inspect.getfile(actr3d.world)).parents[2]
    for path in [*root.glob("actr3d/**/*.py"), *root.glob("workbench/**/*.py")]:
        for node in ast.walk(tree_of(path)):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "isinstance":
                asked = {name.id for name in ast.walk(node.args[1]) if isinstance(name, ast.Name)}
                assert not asked & BODY_KINDS.keys(), f"{path.name}:{node.lineno}"


@pytest.mark.usefixtures("registered")
def test_a_new_change_of_the_world_reaches_it_from_a_simulation() -> None:
    @change
    @dataclass(frozen=True)
    class Lower(Change):
        """Lowers the floor."""

        word = "lower"
        of = "object"
        title = "Lower"
        text = "the floor by {metres} m"

        metres: float

        def carry_out(self, on: World) -> None:
            heights.append((on, self.metres))

    heights: list[tuple[World, float]] = []
    simulation = Simulation(Scene(parts=(Floor(),)), {})
    simulation.command("lower", 0.5)
    with pytest.raises(SimulationError, match=r"command 'lower': missing a required argument: 'metres'; it takes \(metres\)"):
        simulation.command(Lower.word)
    assert heights == [(simulation.world, 0.5)]


@pytest.mark.parametrize("word", CHANGES)
def test_each_change_is_described_and_its_text_names_its_fields(word: str) -> None:
    kind = CHANGES[word]
    assert kind.word == word
    assert kind.of in get_args(Target)
    assert kind.title
    assert (inspect.getdoc(kind) or "").endswith(".")
    in_text = {field for _, field, _, _ in Formatter().parse(kind.text) if field is not None}
    assert in_text
    assert in_text <= set(inspect.signature(kind).parameters)


@pytest.mark.parametrize("name", MODULES)
def test_each_module_can_be_put_into_an_agent(name: str) -> None:
    kind = MODULES[name]
    assert issubclass(kind, Model)
    assert inspect.getdoc(kind)
    assert getattr(actr3d.actr, name, kind) is kind  # what models import by this name


@pytest.mark.parametrize("name", [name for name in dir(actr3d.actr) if name.startswith("DM")])
def test_each_activation_module_has_a_name_for_users(name: str) -> None:
    assert ACTIVATION_PARTS[name]


@pytest.mark.parametrize("name", find_measures())
def test_each_measure_reads_a_world_and_says_what_it_cannot_find(name: str) -> None:
    kind = find_measures()[name]
    assert inspect.getdoc(kind)
    assert {"begin", "look", "result"} <= set(dir(kind))
    arguments = ["nobody" for one in inspect.signature(kind).parameters.values() if one.default is one.empty]
    with pytest.raises(WorldError, match="nobody"):
        kind(*arguments).begin(World(Scene(parts=(Floor(), Car()))))


@pytest.mark.parametrize("name", analyses())
def test_each_analysis_describes_itself_and_is_made_of_trials_with_its_columns_only(name: str) -> None:
    function = ANALYSES[name]
    columns = function.__dict__["needed_columns"]
    assert (inspect.getdoc(function) or "").endswith(".")
    inspect.signature(function).bind("results", "others")  # raises an error if it takes something else
    assert columns
    assert function in find_analyses(columns)
    assert all(function not in find_analyses(columns - {one}) for one in columns)


@pytest.mark.parametrize("name", DETECTORS)
def test_each_detector_describes_itself_and_finds_nothing_in_an_empty_view(name: str) -> None:
    detector = DETECTORS[name]
    assert inspect.getdoc(detector.detect)
    body = World(Scene(parts=(Car(),))).bodies["car"]
    assert tuple(detector(body.get("view"))) == ()


@pytest.mark.parametrize("name", find_benchmarks())
def test_each_benchmark_can_be_listed_and_started_by_the_command(name: str) -> None:
    function = find_benchmarks()[name]
    inspect.signature(function).bind()  # raises an error if it needs arguments
    assert len(inspect.getdoc(function) or "") > 40, "the command lists it with this"
