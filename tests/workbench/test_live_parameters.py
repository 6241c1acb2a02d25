"""Which parameter of a model a command of a user changes, and to which value."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.configuration import Live
from actr3d.parameter_schema import Parameter
from actr3d.simulation import Simulation
from workbench.live_parameters import parameter_set_by

PARAMETERS = [
    Parameter(name="size", takes="number"),
    Parameter(name="width", takes="number", live=Live("aperture")),
    Parameter(name="speed", takes="number", live=Live("parameter", "walker.speed")),
    Parameter(name="pace", takes="number", live=Live("walk", "forward", body="walker")),
    Parameter(name="gaze", takes="number", live=Live("gaze")),
]


@pytest.mark.parametrize(
    ("word", "values", "named", "body", "found"),
    [
        ("aperture", (0.5,), {}, None, ("width", 0.5)),
        ("aperture", (), {"width": 0.5, "name": "aperture"}, None, ("width", 0.5)),
        ("aperture", (0.5,), {"name": "other"}, None, None),
        ("aperture", (), {}, None, None),
        ("aperture", (1, 2, 3, 4, 5), {}, None, None),
        ("parameter", ("walker.speed", 2), {}, None, ("speed", 2)),
        ("parameter", (), {"path": "walker.speed", "value": None}, None, ("speed", None)),
        ("parameter", ("walker.other", 2), {}, None, None),
        ("parameter", ("walker.speed",), {}, None, None),
        ("walk", ("forward", 1.5), {}, "walker", ("pace", 1.5)),
        ("walk", ("forward", 1.5), {}, "another", None),
        ("walk", ("back", 1.5), {}, "walker", None),
        ("walk", ("forward", 1.5, 2), {}, "walker", None),
        ("gaze", (0.1,), {}, "any", ("gaze", 0.1)),
        ("gaze", (0.1,), {"quickly": True}, "any", None),
        ("size", (1,), {}, None, None),
    ],
)
def test_the_parameter_that_a_command_changes(word: str, values: Any, named: Any, body: str | None, found: Any) -> None:
    assert Simulation  # importing it registers the changes
    set_by = parameter_set_by(PARAMETERS, word, values, named, body)
    assert (None if set_by is None else (set_by[0].name, set_by[1])) == found
