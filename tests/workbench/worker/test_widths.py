"""How wide a doorway can be set by the sliders of both panels: as its parameter says."""

from __future__ import annotations

from actr3d.configuration import Live
from actr3d.parameter_schema import Parameter
from workbench.worker.simulation_display import width_limits

OPENS = Live("aperture")


def test_a_slider_has_the_bounds_of_the_parameter_that_sets_doorways() -> None:
    other = Parameter(name="speed", takes="number", most=2.0, live=Live("parameter"))
    open_ones = Parameter(name="width", takes="number", above=0.0, most=3.0, live=OPENS)
    closed = Parameter(name="width", takes="number", least=0.25, below=1.2, live=OPENS)
    assert width_limits(["door"], [other, open_ones]) == {"door": (1, 300)}
    assert width_limits(["one", "two"], [closed]) == {"one": (25, 119), "two": (25, 119)}
    assert width_limits(["door"], [other]) == {"door": (0, 300)}


def test_a_slider_has_bounds_also_where_doorways_are_wider_or_leave_no_choice() -> None:
    wide = Parameter(name="width", takes="number", least=3.5, live=OPENS)
    narrow = Parameter(name="width", takes="number", least=0.501, most=0.509, live=OPENS)
    assert width_limits(["door"], [wide]) == {"door": (350, 700)}
    assert width_limits(["door"], [narrow]) == {"door": (51, 51)}
