"""The options of a model file come from its parameters: one for each, with bounds, units, help and errors."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr.loading import load_text
from actr3d.cli import main
from actr3d.errors import ConfigurationError, SettingError
from actr3d.parameter_schema import parameters_of
from actr3d.runner.cli_options import options_help, read_options, read_settings
from tests.helpers.recording_forgery import forge
from tests.helpers.replays import verdict

LAMP = '''
from dataclasses import dataclass
from typing import Annotated, Literal
from annotated_types import Gt, Le
from actr3d.actr import *
from actr3d.configuration import Configuration
from actr3d.experiment.aperture import Passage
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Mannequin, Scene

@dataclass(frozen=True, kw_only=True)
class Base(Configuration):
    power: Annotated[float, Gt(0), Le(100)] = 60.0
    """How bright it is
    at full power [W]."""

@dataclass(frozen=True, kw_only=True)
class Parameters(Base):
    shade: Literal["paper", "glass"] = "paper"
    """What is around it."""
    half_life: Annotated[int, Gt(0)] | None = None
    lit: bool = False
    """Whether it is on."""
    name: str = "lamp"
    place: tuple[float, float] = (0.0, 0.0)
    """Where it is [m]."""

class Idle(ACTR):
    def init():
        self.stop()

def build(parameters: Parameters) -> Simulation:
    print(parameters)
    simulation = Simulation(Scene(parts=(Floor(), Aperture(), Mannequin(name="walker"))), {"walker": Idle})
    simulation.measure(Passage("walker"))
    return simulation
'''


@pytest.fixture(scope="module")
def lamp() -> Any:
    return load_text(LAMP, "lamp.py")


def test_fields_are_read_as_they_are_written(lamp: Any) -> None:
    fields = parameters_of(lamp.Parameters)
    assert [(field.option, field.domain(), field.default) for field in fields] == [
        ("--power", "number, > 0, <= 100 [W]", 60.0),
        ("--shade", "paper or glass", "paper"),
        ("--half-life", "whole number, > 0, or None", None),
        ("--lit", "True or False", False),
        ("--name", "text", "lamp"),
        ("--place", "tuple [m]", (0.0, 0.0)),
    ]
    with pytest.raises(ConfigurationError, match=r"power: must be a number \(got 1000"):
        fields[0].check(10**400)
    assert fields[0].help == "How bright it is at full power [W]."
    assert fields[2].help == ""


def test_a_field_without_default_must_be_given() -> None:
    text = "from dataclasses import dataclass\n@dataclass\nclass A:\n    a: int\n"
    (field,) = parameters_of(load_text(text, "a.py").A)
    assert field.required
    assert "must be given" in options_help([field])


def test_a_redeclared_field_without_docstring_has_no_help_even_as_the_last_one() -> None:
    text = """from dataclasses import dataclass

@dataclass
class A:
    first: int = 1
    'Of the base class [m].'
    last: int = 1
    'Of the base class [m].'

@dataclass
class B(A):
    first: int = 2
    last: int = 2
"""
    first, last = parameters_of(load_text(text, "a.py").B)
    assert (first.help, first.unit) == ("", None)
    assert (last.help, last.unit) == ("", None)


def test_a_field_of_several_types_names_them_all() -> None:
    text = "from dataclasses import dataclass\n@dataclass\nclass A:\n    a: bool | str | None\n    b: int | float\n"
    first, second = parameters_of(load_text(text, "a.py").A)
    assert (first.takes, first.optional, first.value("True"), first.value("x")) == ("bool | str", True, True, "x")
    assert second.takes == "number"


@pytest.mark.parametrize(
    ("words", "settings"),
    [
        (["--power", "40"], {"power": 40}),
        (["--power=-4e-1"], {"power": -0.4}),
        (["--power", "-0.4"], {"power": -0.4}),
        (["--shade", "glass", "--power", "1"], {"shade": "glass", "power": 1}),
        (["--half-life", "None"], {"half_life": None}),
        (["--half_life", "3"], {"half_life": 3}),
        (["--lit"], {"lit": True}),
        (["--lit", "--name", "5"], {"lit": True, "name": "5"}),
        (["--lit", "False"], {"lit": False}),
        (["--no-lit"], {"lit": False}),
        (["--place", "(1, 2)"], {"place": (1, 2)}),
        (["--power", "much"], {"power": "much"}),
        (["--name", ""], {"name": ""}),
    ],
)
def test_options_are_read(lamp: Any, words: list[str], settings: dict[str, Any]) -> None:
    assert read_options(words, parameters_of(lamp.Parameters)) == settings


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--powr", "3"], "no option '--powr'; did you mean '--power'[?] The model has: --power, --shade"),
        (["--sed", "3"], "no option '--sed'; did you mean '--seed'"),
        (["--power"], "--power takes a value: number, > 0, <= 100 .W."),
        (["--power", "--lit"], "--power takes a value"),
        (["--no-power"], "no option '--no-power'"),
        (["3"], "unexpected '3': a parameter is given as --name value"),
    ],
)
def test_wrong_options_are_reported(lamp: Any, words: list[str], message: str) -> None:
    with pytest.raises(SettingError, match=message):
        read_options(words, parameters_of(lamp.Parameters), ["--seed"])


def test_settings_may_be_texts(lamp: Any) -> None:
    assert read_settings(["name=5", "power=5", "other=5"], parameters_of(lamp.Parameters)) == {"name": "5", "power": 5, "other": 5}


def test_a_setting_that_is_given_twice_is_refused() -> None:
    with pytest.raises(SettingError, match=r"--set power: is given twice \('5', '6'\); give one value"):
        read_settings(["power=5", "name=a", "power=6"], ())


@pytest.mark.parametrize(
    ("text", "value"),
    [
        *[("true", True), ("False", False), ("false", False), ("None", None), ("no", "no"), ("0.5", 0.5)],
        *[(text, text) for text in ("{{}}", "{[1]: 2}", "-" * 5_000 + "1", "-" * 100_000 + "1", "1 + " * 3_000 + "1")],
    ],
)
def test_settings_of_unknown_parameters_are_python_literals(text: str, value: Any) -> None:
    assert read_settings([f"lit={text}"], ()) == {"lit": value}


@pytest.mark.parametrize("text", ["[cat,dog]", "(cat)", "['cat'"])
def test_a_list_that_lost_its_quotes_in_the_shell_is_refused(text: str) -> None:
    says = f'--ablate word: must be a list or tuple of Python (got {text!r}); a shell removes quotes, so quote the whole: --ablate "word='
    with pytest.raises(SettingError, match=re.escape(says)):
        read_settings([f"word={text}"], (), "--ablate")
    assert read_settings([f"word={text!r}"], ()) == {"word": text}, "the text keeps its own quotes"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "lamp.py"
    path.write_text(LAMP, encoding="utf-8")
    return path


def test_help_lists_the_options_of_the_model(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(file), "--help"]) == 0
    captured = capsys.readouterr()
    assert "--seed N" in captured.out
    assert (
        "  --power             number, > 0, <= 100 [W]; default 60.0\n                      How bright it is at full power [W].\n"
        in captured.out
    )
    assert "Exit codes: 0 the model ran, whatever its result; 1 it failed" in " ".join(captured.out.split())
    assert main(["run", "--help"]) == 0
    assert "--power" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--power", "-1"], "Parameters.power: must be > 0 (got -1.0)"),
        (["--power", "101"], "Parameters.power: must be <= 100 (got 101.0)"),
        (["--shade", "papr"], "Parameters.shade: must be one of 'paper', 'glass' (got 'papr'); did you mean 'paper'?"),
        (["--powr", "1"], "no option '--powr'; did you mean '--power'? The model has: "),
        (["--power", "much"], "Parameters.power: must be a number (got 'much')"),
        (["--sead", "1"], "no option '--sead'; did you mean '--seed'?"),
    ],
)
def test_impossible_parameters_are_one_line_and_code_2(
    words: list[str], message: str, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(file), *words]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith(f"error: {message}")
    assert captured.err.count("\n") == 1


def test_an_error_of_the_model_itself_is_code_1(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file.write_text(LAMP.replace("    print(parameters)", "    Floor(name=3)"), encoding="utf-8")
    assert main(["run", str(file)]) == 1
    assert "must be text" in capsys.readouterr().err


def test_the_result_is_the_last_line(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(file), "--json", "--seed", "1", "--power", "3", "--record", str(tmp_path / "run")]) == 0
    result = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert list(result.items())[:2] == [("event", "result"), ("outcome", "declined")]
    assert (result["contacts"], result["wall_angle_deg"], result["time_s"]) == (0, None, 0.01)
    assert main(["run", str(file), "--seed", "1"]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "declined after 0.01 s"
    assert main(["replay", str(tmp_path / "run")]) == 0
    assert capsys.readouterr().out.startswith("every byte agrees: 1 ticks, ")


def test_the_result_is_recorded_and_compared(file: Path, tmp_path: Path) -> None:
    assert main(["run", str(file), "--seed", "1", "--record", str(tmp_path / "run")]) == 0
    forge(tmp_path / "run", "UPDATE events SET data = replace(data, '\"declined\"', '\"passed\"') WHERE data LIKE '%\"declined\"%'")
    report = verdict(tmp_path / "run")
    assert report.code == 1
    assert '"passed"' in report.text
