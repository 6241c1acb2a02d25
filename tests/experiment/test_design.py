"""Designs: the table of trials that follows from factors, groups and a seed, and what is wrong with a design."""

from __future__ import annotations

import math
import signal
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import mean, stdev
from typing import Annotated, Any

import numpy as np
import pytest
from annotated_types import Lt

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError, DesignError, ExperimentError, ModelFileError
from actr3d.experiment import Design, Group, Measured, Normal, Uniform
from actr3d.experiment.specification import Experiment, Specification, library_designs, specify
from actr3d.parameter_schema import parameters_of
from tests.helpers.experiments import write_experiment


@dataclass(frozen=True, kw_only=True)
class Sizes(Configuration):
    a: Annotated[float, Lt(10)] = 1.0
    b: float = 1.0
    c: float = 1.0


def design_of(**changes: Any) -> Design:
    given: dict[str, Any] = {
        "factors": {"a": [1, 2], "b": ["x", "y", "z"]},
        "groups": {
            "young": Group(participants=2, parameters={"size": Normal(mean=1, sd=0.1), "age": 20}),
            "old": Group(participants=1, parameters={"size": Normal(mean=2, sd=0.1), "age": 70}),
        },
        "settings": {"noise": Uniform(low=0, high=0.5), "fixed": 3},
        "trials": 4,
    }
    return Design(**{**given, **changes})


def without_value(values: Mapping[str, Any]) -> dict[str, Any]:
    return {"x": math.nan * values["fixed"]}


def complex_value(_: Mapping[str, Any]) -> dict[str, Any]:
    return {"x": 1j}


def next_level(values: Mapping[str, Any]) -> dict[str, Any]:
    return {"a": values["a"] + 1}


def own_seed(_: Mapping[str, Any]) -> dict[str, Any]:
    return {"seed": 1}


def drawn_value(_: Mapping[str, Any]) -> dict[str, Any]:
    return {"x": Uniform(low=0, high=1)}


def test_each_participant_does_each_cell_as_often_as_the_design_says() -> None:
    design = design_of()
    table = list(design.table())
    assert len(design) == len(table) == 3 * 6 * 4
    cells = Counter((trial.participant.name, trial.values["a"], trial.values["b"]) for trial in table)
    assert set(cells.values()) == {4}
    assert [trial.number for trial in table] == list(range(len(table)))
    assert {trial.participant.name for trial in table} == {"young 1", "young 2", "old 1"}


def test_values_of_groups_belong_to_participants_and_those_of_settings_to_trials() -> None:
    table = list(design_of().table())
    sizes: dict[str, set[float]] = {trial.participant.name: set() for trial in table}
    for trial in table:
        sizes[trial.participant.name].add(trial.values["size"])
    assert all(len(values) == 1 for values in sizes.values())
    assert len({size for values in sizes.values() for size in values}) == 3
    assert len({trial.values["noise"] for trial in table}) == len(table)
    assert {trial.values["fixed"] for trial in table} == {3}


def test_the_table_is_the_same_on_every_machine() -> None:
    trial = design_of().trial(17)
    assert trial.columns == {
        "trial": 17,
        "participant": "young 1",
        "group": "young",
        "position": 18,
        "repetition": trial.repetition,
        "noise": trial.values["noise"],
        "fixed": 3,
        "size": 1.002993,
        "age": 20,
        "a": trial.values["a"],
        "b": trial.values["b"],
        "seed": trial.seed,
    }
    assert trial.seed == f"1 young 1 a={trial.values['a']} b={trial.values['b']} {trial.repetition}"
    assert list(design_of().table()) == list(design_of().table())
    assert [t.values for t in design_of().table()] != [t.values for t in design_of(seed=2).table()]


def test_another_level_of_a_factor_changes_no_other_trial() -> None:
    def by_seed(design: Design) -> dict[str, Any]:
        return {trial.seed: dict(trial.values) for trial in design.table()}

    fewer, more = by_seed(design_of()), by_seed(design_of(factors={"a": [1, 2, 3], "b": ["x", "y", "z"]}))
    assert fewer.items() <= more.items()
    assert len(more) == len(fewer) * 3 // 2


def test_the_order_is_drawn_for_each_participant_or_fixed() -> None:
    def order(design: Design, first: int) -> list[tuple[Any, int]]:
        return [(trial.values["a"], trial.repetition) for trial in map(design.trial, range(first, first + 24))]

    drawn = design_of()
    assert order(drawn, 0) != order(drawn, 24)
    assert sorted(order(drawn, 0)) == sorted(order(drawn, 24))
    fixed = design_of(order="fixed")
    assert order(fixed, 0) == order(fixed, 24) == [(a, r) for r in (1, 2, 3, 4) for a in (1, 1, 1, 2, 2, 2)]


def test_drawn_values_have_the_distribution() -> None:
    many = design_of(groups={"all": Group(participants=2000, parameters={"size": Normal(mean=1, sd=0.2, low=0.9)})}, factors={}, trials=1)
    sizes = [person.parameters["size"] for person in many.participants]
    assert min(sizes) >= 0.9
    # The mean of a normal distribution truncated from below at half a standard deviation under its mean.
    density, above = math.exp(-0.125) / math.sqrt(2 * math.pi), 0.691462
    assert mean(sizes) == pytest.approx(1 + 0.2 * density / above, abs=0.01)
    whole = Normal(mean=0, sd=1)
    assert [round(whole.quantile(p), 3) for p in (0.025, 0.5, 0.975)] == [-1.96, 0, 1.96]
    draws = [trial.values["noise"] for trial in design_of(trials=100).table()]
    assert stdev(draws) == pytest.approx(0.5 / math.sqrt(12), rel=0.05)
    assert Normal(mean=2, sd=0).quantile(0.3) == 2


def test_values_are_derived_from_others() -> None:
    def aperture(values: Mapping[str, Any]) -> dict[str, Any]:
        return {"aperture": round(values["ratio"] * values["size"], 4)}

    def wrong(values: Mapping[str, Any]) -> dict[str, Any]:
        return {"x": values["wrong"]}

    ratios = design_of(factors={"ratio": [1.0, 1.5]}, derive=aperture)
    trial = ratios.trial(0)
    assert trial.values["aperture"] == pytest.approx(trial.values["ratio"] * trial.values["size"], abs=1e-4)
    with pytest.raises(DesignError, match=r"Design\.derive: failed with KeyError: 'wrong'"):
        design_of(derive=wrong).trial(0)
    with pytest.raises(DesignError, match=r"Design\.derive: must return values by name \(returned 3\)"):
        design_of(derive=lambda _: 3).trial(0)  # type: ignore[arg-type, return-value]


ENDLESS: dict[str, Any] = {}
ENDLESS["own"] = ENDLESS
ROUND: list[Any] = [1]
ROUND.append(ROUND)

INVALID: list[tuple[dict[str, Any], str]] = [
    ({"factors": {"a": []}}, r"Design\.factors\['a'\]: must have at least one level \(got \[\]\)"),
    ({"factors": {"a": 3}}, r"Design\.factors\['a'\]: must be a list of levels \(got 3\)"),
    ({"factors": {"a": "abc"}}, r"Design\.factors\['a'\]: must be a list of levels \(got 'abc'\)"),
    ({"factors": {"a": [1, 1]}}, r"Design\.factors\['a'\]: must name each level once \(got 1 and 1\)"),
    ({"factors": {"a": [1, 1.0]}}, r"Design\.factors\['a'\]: must name each level once \(got 1 and 1\.0\)"),
    ({"factors": {"a": [0.3, 0.1 + 0.2]}}, r"Design\.factors\['a'\]: must name each level once \(got 0\.3 and 0\.3\)"),
    ({"factors": {"size": [1]}}, r"Design\.groups\['young'\]: 'size' is a factor already"),
    ({"factors": {"seed": [1]}}, r"Design: 'seed' is a column of every table of trials; rename the parameter"),
    ({"settings": {"age": 1}}, r"Design\.settings: 'age' is already a factor, or a parameter of a group"),
    ({"factors": {"a": [1, math.nan]}}, r"Design\.factors\['a'\]\[1\]: must be finite \(got nan\)"),
    ({"factors": {"a": ["1", 1]}}, r"Design\.factors\['a'\]: has two levels with the same text \(got '1' and 1\)"),
    ({"factors": {"a": [None, "none"]}}, r"Design\.factors\['a'\]: has two levels with the same text \(got None and 'none'\)"),
    ({"factors": {"a": [(1, -math.inf)]}}, r"Design\.factors\['a'\]\[0\]: must be finite \(got \(1, -inf\)\)"),
    ({"settings": {"fixed": math.inf}}, r"Design\.settings\['fixed'\]: must be finite \(got inf\)"),
    ({"factors": {}, "derive": without_value}, r"Design\.derive\['x'\]: must be finite \(got nan\)"),
    (
        {"factors": {"a": [1j]}},
        r"Design\.factors\['a'\]\[0\]: must be a number, text, True, False, None, or a list or dict of these \(got 1j\)",
    ),
    ({"factors": {"a": [b"cat"]}}, r"Design\.factors\['a'\]\[0\]: must be a number, text, .* \(got b'cat'\)"),
    (
        {"factors": {"a": [1, 10**5000]}},
        r"Design\.factors\['a'\]\[1\]: must be a whole number of at most 64 bits, or a float \(got one of 16610 bits\)",
    ),
    ({"factors": {"a": ["\ud800"]}}, r"Design\.factors\['a'\]\[0\]: must be a text of characters that can be stored \(got '\\ud800'\)"),
    (
        {"factors": {"a": [Normal(mean=1, sd=1)]}},
        r"Design\.factors\['a'\]\[0\]: a distribution belongs to Group\.parameters, .* or Design\.settings, .* \(got Normal\(",
    ),
    ({"factors": {"a": [[1, Normal]]}}, r"Design\.factors\['a'\]\[0\]: must be a number, text, "),
    (
        {"settings": {"fixed": {1, 2}}},
        r"Design\.settings\['fixed'\]: must be a number, text, True, False, None, or a list .* \(got \{1, 2\}\)",
    ),
    ({"settings": {"fixed": ENDLESS}}, r"Design\.settings\['fixed'\]: must not contain itself"),
    ({"settings": {"fixed": ROUND}}, r"Design\.settings\['fixed'\]: must not contain itself"),
    ({"factors": {"a": [ROUND]}}, r"Design\.factors\['a'\]\[0\]: must not contain itself"),
    ({"settings": {"fixed": object()}}, r"Design\.settings\['fixed'\]: must be a number, text, "),
    ({"settings": {"fixed": Normal}}, r"Design\.settings\['fixed'\]: must be a number, text, "),
    ({"settings": {"fixed": [Uniform(low=0, high=1)]}}, r"Design\.settings\['fixed'\]: a distribution belongs to"),
    ({"settings": {"fixed": {(1, 2): 3}}}, r"Design\.settings\['fixed'\]: must be a number, text, "),
    ({"factors": {}, "derive": complex_value}, r"Design\.derive\['x'\]: must be a number, text, "),
    ({"factors": {}, "derive": drawn_value}, r"Design\.derive\['x'\]: a distribution belongs to"),
    ({"derive": next_level}, r"Design\.derive: must not return 'a', which is a factor; give it another name"),
    ({"derive": own_seed}, r"Design\.derive: must not return 'seed', which is a column of every table of trials"),
    ({"groups": {"": Group()}}, r"Design\.groups: names must be non-empty strings of printable characters \(got ''\)"),
    ({"groups": {1: Group()}}, r"Design\.groups: names must be non-empty strings of printable characters \(got 1\)"),
    ({"groups": {"\ud800": Group()}}, r"Design\.groups: names must be non-empty strings of printable characters \(got '\\ud800'\)"),
    ({"factors": {2: [1]}}, r"Design\.factors: names must be non-empty strings of printable characters \(got 2\)"),
    ({"settings": {"": 1}}, r"Design\.settings: names must be non-empty strings of printable characters \(got ''\)"),
    ({"measures": ["rt", "a"]}, r"Design\.measures: 'a' is already a column of the trials; rename it"),
    ({"measures": ["size"]}, r"Design\.measures: 'size' is already a column of the trials; rename it"),
    ({"measures": ["seed"]}, r"Design\.measures: 'seed' is already a column of the trials; rename it"),
    ({"measures": ["error"]}, r"Design\.measures: 'error' is already a column of the trials; rename it"),
    ({"measures": [Measured(name="m", over="fixed")]}, r"Design\.measures: 'm' is over 'fixed', which is another column"),
    ({"groups": {}}, r"Design\.groups: must have at least one group \(got \{\}\)"),
    ({"measures": ["m/s"]}, r"measure: its name must be 1 to 100 bytes of printable characters without '/' \(got 'm/s'\)"),
    ({"measures": [""]}, r"measure: its name must be"),
    ({"measures": ["a\0"]}, r"measure: its name must be"),
    ({"measures": ["a" * 101]}, r"measure: its name must be"),
    ({"measures": ["速" * 40]}, r"measure: its name must be"),
    ({"groups": {"a": 3}}, r"Design\.groups\['a'\]: must be a Group \(got 3\)"),
]


@pytest.mark.parametrize(("changes", "says"), INVALID)
def test_an_invalid_design_is_refused(changes: dict[str, Any], says: str) -> None:
    with pytest.raises(DesignError, match=says):
        design_of(**changes).trial(0)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Design(trials=0), r"Design\.trials: must be >= 1 \(got 0\)"),
        (lambda: Design(order="any"), r"Design\.order: must be one of"),  # type: ignore[arg-type]
        (lambda: Group(participants=0), r"Group\.participants: must be >= 1 \(got 0\)"),
        (lambda: Group(parameters={"a": Group}), r"Group\.parameters\['a'\]: must be a number, text, .* \(got <class '.*Group'>\)"),
        (lambda: Group(parameters={1: 2}), r"Group\.parameters: names must be non-empty strings of printable characters \(got 1\)"),  # type: ignore[dict-item]
        (lambda: Measured(name="m", over=""), r"Measured\.over: names must be non-empty strings of printable characters \(got ''\)"),
        (lambda: Normal(mean="x", sd=1), r"Normal\.mean: must be a number \(got 'x'\)"),  # type: ignore[arg-type]
        (lambda: Normal(mean=1, sd=-1), r"Normal\.sd: must be >= 0 \(got -1.0\)"),
    ],
)
def test_wrong_fields_are_refused(make: Any, says: str) -> None:
    with pytest.raises((ConfigurationError, DesignError), match=says):
        make()


@pytest.mark.parametrize("name", ["group", "limit", "until", "seed"])
def test_factors_with_a_name_that_means_something_else_are_refused(name: str) -> None:
    with pytest.raises(DesignError, match=f"Design: '{name}' is .*; rename the parameter"):
        Design(factors={name: [1, 2]})


def test_a_trial_that_does_not_exist_is_refused() -> None:
    with pytest.raises(DesignError, match=r"trial: must be a number from 0 to 71 \(got 72\)"):
        design_of().trial(72)


def test_changes_replace_levels_numbers_and_values() -> None:
    changed = design_of().changed(participants=3, trials=1, values={"a": [5, 6, 7], "b": "x", "size": 1.5, "fixed": 4, "seed": 9})
    assert changed.factors == {"a": [5, 6, 7], "b": ["x"]}
    assert [group.participants for group in changed.groups.values()] == [3, 3]
    assert {trial.values["size"] for trial in changed.table()} == {1.5}
    assert {trial.values["fixed"] for trial in changed.table()} == {4}
    assert changed.seed == 9
    assert len(changed) == 6 * 3


def test_numbers_of_numpy_are_the_same_levels_as_those_of_python() -> None:
    def more(values: Mapping[str, Any]) -> dict[str, Any]:
        return {"double": np.float64(2) * values["a"]}

    group = {"of numpy": Group(parameters={"size": np.float32(0.5), "age": np.arange(2)})}
    given = design_of(
        factors={"a": np.linspace(0, 1, 3), "b": [np.int64(1), np.bool_(True)]}, groups=group, settings={"c": np.int8(3)}, derive=more
    )
    plain = {"of numpy": Group(parameters={"size": 0.5, "age": [0, 1]})}
    same = design_of(factors={"a": [0.0, 0.5, 1.0], "b": [1, True]}, groups=plain, settings={"c": 3}, derive=more)
    assert repr(list(given.table())) == repr(list(same.table()))
    assert type(given.trial(0).values["double"]) is float
    with pytest.raises(DesignError, match=r"Design\.factors\['a'\]\[1\]: must be finite \(got inf\)"):
        design_of(factors={"a": [0.0, np.float32(math.inf)]})


def test_a_level_is_the_number_that_tables_show() -> None:
    steps: Any = np.arange(0.1, 0.45, 0.1)
    design = Design(factors={"a": steps, "b": [1, True, "x"]})
    assert design.factors == {"a": [0.1, 0.2, 0.3, 0.4], "b": [1, True, "x"]}
    assert [type(level) for level in design.factors["b"]] == [int, bool, str]


# -- designs in files


def test_a_level_written_in_another_way_is_the_same_level() -> None:
    before = Design(factors={"a": [0.0, 0.5], "b": [True, 2]})
    after = before.changed(values={"a": [0, 0.5], "b": [True, 2.0]})
    assert [repr(level) for levels in after.factors.values() for level in levels] == ["0.0", "0.5", "True", "2"]
    assert list(after.table()) == list(before.table())


def test_the_designs_of_the_library_fit_their_models() -> None:
    names = library_designs()
    assert [*names] == ["warren_whang_1987", *sorted({*names} - {"warren_whang_1987"})]
    for name in names:
        experiment = specify(name)
        assert len(experiment.description) > 40
        assert len(experiment.design) > 1
        again = Specification.from_json(experiment.specification.to_json(), "it")
        assert again == experiment.specification
        assert list(Experiment(again).design.changed(trials=1).table()) == list(experiment.design.changed(trials=1).table())


def test_a_measure_with_the_name_of_a_derived_value_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "d.py"
    given = "measures=['m'], factors={'n': [1]}, derive=lambda values: {'m': 2 * values['n']}"
    path.write_text(f"n = 1\nm = 2\nfrom actr3d.experiment import *\n@design\ndef a():\n  return Design({given})\n")
    with pytest.raises(DesignError, match=r"d\.py:6: Design\.measures: 'm' is already a column of the trials; rename it"):
        specify(str(path))


@pytest.mark.parametrize(
    ("fields", "says"),
    [
        ("\n    factor={'n': [1]}", r"d\.py:6: Design\.factor: there is no such field; did you mean 'factors'\?"),
        ("groups={'a': Group(\n    partcipants=3)}", r"d\.py:6: Group\.partcipants: there is no such field; did you mean 'participants'\?"),
        ("\n    settings={'n': Uniform(lo=3, high=4)}", r"d\.py:6: Uniform\.lo: there is no such field; did you mean 'low'\?"),
    ],
)
def test_a_misspelled_field_is_refused_with_its_line(tmp_path: Path, fields: str, says: str) -> None:
    path = tmp_path / "d.py"
    path.write_text(f"from actr3d.experiment import *\nn = 1\n@design\ndef a():\n  return Design(measures=['n'], {fields})\n")
    with pytest.raises(DesignError, match=says):
        specify(str(path))


def test_an_unknown_parameter_is_refused_with_its_line(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, factors='{"m": [1, 2]}')
    with pytest.raises(DesignError, match=r"counting_design\.py:10: Design: the model has no parameter 'm'.*it has: n, mode"):
        specify(str(path))
    path = write_experiment(tmp_path, trials=0)
    with pytest.raises(DesignError, match=r"counting_design\.py:12: Design\.trials: must be >= 1 \(got 0\)"):
        specify(str(path))
    path = write_experiment(tmp_path, factors='{"n": [1, float("nan")]}')
    with pytest.raises(DesignError, match=r"counting_design\.py:10: Design\.factors\['n'\]\[1\]: must be finite \(got nan\)"):
        specify(str(path))
    path = write_experiment(tmp_path)
    with pytest.raises(DesignError, match=r"^--set mode: Design\.settings\['mode'\]: must be finite \(got inf\)"):
        specify(str(path), values={"mode": math.inf})
    with pytest.raises(DesignError, match=r"^--set m: Design: the model has no parameter 'm'"):
        specify(str(path), values={"m": 3})


FILE_OF_DESIGN = """from actr3d.experiment import *
WIDTH = 0.4
GROUPS = {{
    "small": Group(
        participants=5,
        parameters={{"shoulder_width": {small}}},
    ),
    "large": Group(
        participants={large},
        parameters={{"shoulder_width": WIDTH, {more}}},
    ),
}}


@design
def one():
    between = Normal(mean=1, sd=1, low={low}, high=2)
    return Design(
        model="{model}",
        groups={groups},
        settings={{"condition": "normal"}},
    )
"""
GROUPS_INSIDE = """{
            "small": Group(participants=1),
            "large": Group(participants=1, parameters={
                "shoulder_width": 7}),
        }"""


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"large": 0}, r":9: Group\.participants: must be >= 1 \(got 0\)"),
        ({"more": '"m": 1'}, r":10: Design: the model has no parameter 'm'"),
        ({"small": 7}, r":6: Design, small 1: shoulder_width: must be <= \S+ \(got 7\)"),
        ({"more": '"condition": "fast"'}, r":21: Design\.settings: 'condition' is already a factor, or a parameter of a group"),
        ({"groups": GROUPS_INSIDE}, r":23: Design, large 1: shoulder_width: must be <= \S+ \(got 7\)"),
        ({"low": 3}, r":17: Normal: no value lies between low 3 and high 2"),
        ({"model": "no.py"}, r":19: Design\.model: there is no file 'no\.py' beside it"),
    ],
)
def test_what_is_wrong_in_a_design_is_named_with_its_own_line(tmp_path: Path, changed: Mapping[str, Any], says: str) -> None:
    path = tmp_path / "some_design.py"
    fields = {"small": 0.4, "large": 5, "more": "", "low": 0, "model": "aperture_passage.py", "groups": "GROUPS", **changed}
    path.write_text(FILE_OF_DESIGN.format(**fields), encoding="utf-8")
    with pytest.raises(DesignError, match=rf"some_design\.py{says}"):
        specify(str(path))


def test_an_import_before_the_variables_ends_the_parameters(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, model="import math\nn = 1\nrt = luck = 1\n")
    says = r"the model has no parameter 'n'; it has: none \(the variables that its first lines set, before any import\)"
    with pytest.raises(DesignError, match=says):
        specify(str(path))


def test_levels_out_of_the_bounds_of_a_parameter_are_refused_before_anything_runs() -> None:
    with pytest.raises(DesignError, match=r"--set aperture: Design, small 1: aperture: must be <= 3 \(got 4\)"):
        specify("warren_whang_1987", values={"aperture": [0.5, 4]})
    with pytest.raises(DesignError, match=r"--set noise: Design, small 1: noise: must be >= 0 \(got -0\.0"):
        specify("warren_whang_1987", values={"noise": Normal(mean=0.1, sd=0.02)})


@pytest.mark.parametrize(
    ("name", "value", "right"), [("gait", "", "True or False"), ("memories", 1.5, "a whole number"), ("task", "", "one of")]
)
def test_values_of_a_wrong_type_are_refused_before_anything_runs(name: str, value: Any, right: str) -> None:
    with pytest.raises(DesignError, match=rf"--set {name}: Design, small 1: {name}: must be {right}.* \(got {value!r}\)"):
        specify("warren_whang_1987", values={name: value})


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("x = 1\n", r"must define one design \(found 0\); mark a function with @design"),
        (
            "from actr3d.experiment import *\n@design\ndef a(): return Design()\n@design\ndef b(): return Design()\n",
            r"must define one design \(found 2\); there are: a, b; name one as '.*d\.py:NAME'",
        ),
        (
            "from actr3d.experiment import *\n@design\ndef a(): return Design()\n@design\ndef a(): return Design()\n",
            r"d\.py: defines the design 'a' 2 times; give each another name",
        ),
        (
            "from actr3d.experiment import *\n@design\ndef a(): return Design()\nexit()\n",
            r"d\.py:4: must not end the program when it is loaded \(it ended with SystemExit\(None\)\)",
        ),
        (
            "from actr3d.experiment import *\nn = 1\n@design\ndef a():\n  return Design(measures=['n'], derive=lambda _: exit(3))\n",
            r"d\.py:5: Design\.derive: failed with SystemExit: 3 \(given \{\}\)",
        ),
        (
            "n = 1\nm = n\nfrom actr3d.experiment import *\nfrom random import random\n@design\ndef a():\n"
            "  return Design(measures=['m'],\n    factors={'n': [random(), random()]})\n",
            r"d\.py:8: a\(\) must return the same design each time, as each process loads it \(different: n\); draw with a seed",
        ),
        (
            "n = 1\nfrom actr3d.experiment import *\nfrom random import random\n@design\ndef a():\n"
            "  return Design(\n    measures=[Measured(name='n', meaning=f'{random()}')])\n",
            r"d\.py:7: a\(\) must return the same design each time, as each process loads it \(different: measures\); draw with a seed",
        ),
        ("from actr3d.experiment import *\n@design\ndef a(): return 3\n", r"d\.py:3: a\(\) must return a Design \(returned 3\)"),
        (
            "from actr3d.experiment import *\n@design\ndef a(x): pass\n",
            r"d\.py:3: a\(\) must be a function without arguments \(missing .* 'x'\)",
        ),
        ("from actr3d.experiment import *\n@design\ndef a():\n  exit(1)\n", r"d\.py:4: a\(\) must return .* ended with SystemExit\(1\)"),
        (
            "from actr3d.experiment import *\n@design\ndef a():\n  return Design(model='counting.pi')\n",
            r"Design\.model: there is no file 'counting\.pi' beside it or among the library's models.*did you mean 'counting\.py'",
        ),
        (
            "from actr3d.experiment import *\n@design\ndef a():\n  return Design(model='counting.py')\n",
            r"d\.py:3: Design\.measures: must name the variables of the program that are its measures",
        ),
        (
            "from actr3d.experiment import *\nn = 1\n@design\ndef a():\n  return Design(measures=['n'], trials=10**9)\n",
            r"d\.py:5: Design\.trials: must give at most 10,000,000 trials in all \(got 1,000,000,000\)",
        ),
        (
            "from actr3d.experiment import *\nn = 1\n@design\ndef a():\n  return Design(measures=['n',\n    Measured(name='n')])\n",
            r"d\.py:5: Design\.measures: 'n' is there twice",
        ),
        (
            "from actr3d.experiment import *\nn = 1\n@design\ndef a():\n  return Design(factors={'n': [1, 2]},\n    measures=['n_'])\n",
            r"d\.py:6: Design: 'n_' is what reports call 'n'; rename one of them",
        ),
        (
            "from actr3d.experiment import *\n@design\ndef a():\n  return Design(factors={'n': [1],\n    'n_': [1]})\n",
            r"d\.py:5: Design: 'n_' is what reports call 'n'; rename one of them",
        ),
        (
            "from actr3d.experiment import *\n@design\ndef a():\n  return Design(factors={'sd': [1]},\n    settings={'sd_': 1})\n",
            r"d\.py:5: Design: 'sd_' is what reports call 'sd'; rename one of them",
        ),
        (
            "from actr3d.experiment import *\n@design\ndef a():\n"
            "  return Design(\n    factors={'n_': [1]}, measures=[Measured(name='m', over='n')])\n",
            r"d\.py:5: Design: 'n_' is what reports call 'n'; rename one of them",
        ),
        (
            "from actr3d.experiment import *\n@design\ndef a():\n  return Design(\n    factors={'n_': [1]}, measures=['n'])\n",
            r"d\.py:5: Design: 'n_' is what reports call 'n'; rename one of them",
        ),
        (
            "from actr3d.experiment import *\ntime = 1\n@design\ndef a():\n  return Design(\n    measures='time')\n",
            r"d\.py:6: Design\.measures: must be a list of names \(got 'time'\)",
        ),
        (
            "from actr3d.experiment import *\nn = 1\n@design\ndef a():\n  return Design(\n    measures=[Measured(name='m', over='end')])\n",
            r"d\.py:6: Design\.measures: 'm' is over 'end', which is another column",
        ),
        (
            "from actr3d.experiment import *\nn = 1\n@design\ndef a():\n  return Design(measures=['n'],\n    human='fan_efect')\n",
            r"d\.py:6: Design\.human: must name human data of the library \(got 'fan_efect'; .*\); did you mean 'fan_effect'\?",
        ),
    ],
)
def test_files_without_a_valid_design_are_refused(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "d.py"
    path.write_text(text)
    with pytest.raises(ExperimentError, match=says):
        specify(str(path))


@pytest.mark.timeout(20)
@pytest.mark.parametrize("work", ["pass", "\n    try:\n      while True: pass\n    except Exception: pass"])
def test_a_derive_that_never_returns_is_ended_at_the_limit_of_a_trial(tmp_path: Path, work: str) -> None:
    derive = f"def derive(values):\n  while values['b'] == 1: {work}\n  return {{}}\n"
    text = f"from actr3d.experiment import *\na = b = 1\n{derive}@design\ndef x():\n  return Design(measures=['a'], limit=0.2, "
    path = tmp_path / "d.py"
    path.write_text(f"{text}factors={{'b': [0, 1]}}, derive=derive)\n", encoding="utf-8")
    took = r"failed with TimeoutError: it did not return within 0\.2 s, the limit of a trial \(given \{'b': 1\}\)"
    with pytest.raises(DesignError, match=rf"d\.py:\d+: Design\.derive: {took}"):
        specify(str(path))
    path.write_text(f"{text}settings={{'b': 0}}, derive=derive)\n", encoding="utf-8")
    design = specify(str(path)).design
    object.__setattr__(design, "settings", {"b": 1})  # as if it were drawn for a trial
    before = signal.setitimer(signal.ITIMER_REAL, 15, 7)
    try:
        columns = design.columns_of(0)
        left, interval = signal.getitimer(signal.ITIMER_REAL)
    finally:
        signal.setitimer(signal.ITIMER_REAL, *before)
    assert columns["b"] == 1
    assert 5 < left < 15, "the time that has passed counts"
    assert interval == 7


def test_a_design_that_is_named_is_there_once(tmp_path: Path) -> None:
    path = tmp_path / "d.py"
    path.write_text("from actr3d.experiment import *\n@design\ndef a(): return Design()\n@design\ndef a(): return Design()\n")
    with pytest.raises(ExperimentError, match=r"d\.py: defines the design 'a' 2 times; give each another name"):
        specify(f"{path}:a")


def test_a_syntax_error_in_the_model_is_named_with_file_and_line(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, model="n = 1\nmode = (\n")
    with pytest.raises(ModelFileError, match=r"counter\.py:2: '\(' was never closed"):
        specify(str(path))


def test_an_unknown_name_is_refused() -> None:
    with pytest.raises(ExperimentError, match=r"no design, file or folder 'warren_whang'; did you mean 'warren_whang_1987'"):
        specify("warren_whang")


def test_a_file_with_several_designs_runs_the_named_one(tmp_path: Path) -> None:
    first = "from actr3d.experiment import *\nn = 1\n@design\ndef a(): return Design(measures=['n'])\n"
    text = f"{first}@design\ndef b(): return Design(measures=['n'], trials=3)\n"
    path = tmp_path / "d.py"
    path.write_text(text)
    assert len(specify(f"{path}:b").design) == 3


def test_a_specification_from_elsewhere_is_checked() -> None:
    for text in ("", "[]", "{}", '{"format": 1}', '{"format": 1, "design": 3, "model": {}}'):
        with pytest.raises(ExperimentError, match="it: is not the description of an experiment"):
            Specification.from_json(text, "it")
    source = '{"file": "a.py", "text": "", "helpers": {"b": 3}}'
    with pytest.raises(ExperimentError, match=r"it: is not .* \(Source\.helpers\['b'\]: must be a file and its text \(got 3\)\)"):
        Specification.from_json(f'{{"format": 1, "name": "a", "design": {source}, "model": {source}}}', "it")
    with pytest.raises(ExperimentError, match="it: has format 7; this version reads format 1"):
        Specification.from_json('{"format": 7}', "it")


@pytest.mark.parametrize(
    ("name", "trials", "cells"),
    [
        ("warren_whang_1987", 9600, 16),
        ("higuchi_2012", 720, 9),
        ("passability_judgement", 1400, 14),
        ("wilmut_ratios", 420, 7),
        ("misaligned_start", 600, 24),
    ],
)
def test_designs_of_the_literature_have_their_numbers(name: str, trials: int, cells: int) -> None:
    design = specify(name).design
    assert (len(design), len(design.cells)) == (trials, cells)


def test_ratios_become_apertures_and_bars() -> None:
    for trial in specify("higuchi_2012").design.table():
        v = trial.values
        assert v["aperture"] == pytest.approx(v["ratio"] * max(v["bar"], v["shoulder_width"]), abs=1e-4)
        assert v["bar"] == pytest.approx(v["bar_ratio"] * v["shoulder_width"], abs=1e-4)


def test_what_is_the_same_for_many_participants_and_cells_is_checked_once() -> None:
    derived: list[Mapping[str, Any]] = []

    def derive(values: Mapping[str, Any]) -> dict[str, Any]:
        derived.append(values)
        return {"b": values["a"]}

    parameters = parameters_of(Sizes)
    group = Group(participants=50, parameters={"c": 1.0})
    Design(model="m.py", factors={"a": [1.0, 2.0, 3.0]}, groups={"all": group}, derive=derive).check(parameters)
    assert len(derived) == 3
    drawn = Group(participants=5, parameters={"c": Uniform(low=0, high=1)})
    Design(model="m.py", factors={"a": [1.0, 2.0]}, groups={"all": drawn}, derive=derive).check(parameters)
    assert len(derived) == 3 + 10
    for levels in ([1.0, 20.0], [20.0, 1.0]):
        with pytest.raises(DesignError, match=r"Design, all 1: a: must be < 10"):
            Design(model="m.py", factors={"b": [1.0, 2.0], "a": levels}, groups={"all": group}).check(parameters)
