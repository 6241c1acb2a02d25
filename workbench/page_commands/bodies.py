"""Questions about the bodies of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from actr3d.errors import Actr3dError
from workbench.page_commands.command import LONGEST_TEXT, Name, PlainValue, Question, Seconds, page_command, unknown

if TYPE_CHECKING:
    from actr3d.world.body import Body
    from workbench.worker.controlled_run import ControlledRun
    from workbench.worker.simulation_display import SimulationDisplay


CurveName = Annotated[str, Field(min_length=1, max_length=LONGEST_TEXT)]
"""The name of a curve, which may contain a chunk."""


def _found(run: ControlledRun, name: str | None) -> tuple[SimulationDisplay, Body]:
    """Returns what is shown of a simulation, and one of its bodies; the first without a name."""
    shown = run.shown
    if shown is None or not shown.simulation.world.bodies:
        raise Actr3dError("the run has no body")
    bodies = shown.simulation.world.bodies
    if name is None:
        return shown, next(iter(bodies.values()))
    if name not in bodies:
        raise unknown("body", name, bodies)
    return shown, bodies[name]


@page_command
class ViewQuestion(Question):
    """Returns what a body's eye sees now, row by row, and the colours of the objects in the scene, by label."""

    type: Literal["view"] = "view"
    body: Name | None = None

    def answer(self, run: ControlledRun) -> dict[str, Any]:
        from actr3d.camera import EXTENT_FIELDS, view_and_geoms_for_observer

        shown, body = _found(run, self.body)
        view, geoms = view_and_geoms_for_observer(body, shown.eyesight(body.name))
        fields = [{"name": field.name, "title": field.title, "unit": field.unit, "about": field.about} for field in EXTENT_FIELDS]
        return {
            "body": body.name,
            "rows": view.rows,
            "fields": fields,
            "extents": view.as_array().tolist(),
            "colours": shown.colours(geoms),
        }


@page_command
class BodyState(Question):
    """Returns the current state of a body: joints with their limits, contacts, bounding box, position."""

    type: Literal["body"] = "body"
    body: Name | None = None

    def answer(self, run: ControlledRun) -> dict[str, Any]:
        from actr3d.actr.modules.answers import plain_answer
        from actr3d.world.sensors import SENSORS
        from actr3d.world.sensors.touch import present

        _, body = _found(run, self.body)
        limits = {joint.name: joint.limits for joint in body.joints.values()}
        joints = plain_answer(SENSORS["joints"](body))
        box = body.bounding_box("body")
        return {
            "body": body.name,
            "pose": plain_answer(SENSORS["pose"](body)),
            "joints": {name: {"now": reading, "limits": limits.get(name)} for name, reading in joints.items()},
            "contacts": [plain_answer(touch) for touch in present(body)],
            "box": {"lower": box.lower, "upper": box.upper, "size": box.size},
        }


@page_command
class Present(Question):
    """Returns the present values of what a change by hand would replace, by field: for `move`, the place of an object."""

    type: Literal["present"] = "present"
    word: Name
    """The command of the change."""
    named: dict[Name, PlainValue] = Field(default_factory=dict, max_length=100)
    """The fields that say what is to be changed: `{"object": "walker"}`."""

    def answer(self, run: ControlledRun) -> dict[str, Any]:
        from actr3d.actr.changes import AgentChange
        from actr3d.change import CHANGES

        if self.word not in CHANGES:
            raise unknown("change", self.word, CHANGES)
        kind = CHANGES[self.word]
        if run.shown is None or issubclass(kind, AgentChange):
            return {}
        return kind.present(run.shown.simulation.world, self.named)


@page_command
class Curves(Question):
    """Returns curves of the run over time, up to the furthest time that it has reached, for plots.

    The answer is `{names: [{name, unit, group, of, shape}], times: [s], curves: {name: [value or null]}, events: {name: {times: [s],
    values: [value or null], slope, whole}}}`. `names` lists all curves, with angles in degrees: first those of bodies, with the shape
    `line`, then those of events, such as utilities, activations and numbers in buffers, in the order in which they appeared. `curves`
    holds the requested ones of bodies, with one value for each time, or null if there is no value (for example the clearance of a body
    that is not in the doorway). Their groups are `place`, `speed`, `clearance`, `contact`, `joint` and `joint speed`. All values are
    those at the ends of ticks, except the contact force: it is the greatest in the physics steps since the time before.

    `events` holds the requested ones of events, each with its own times. Their shape is `points` (each value is that of a moment),
    `steps` (each holds until the next one) or `sum` (it grows evenly between two); `slope` says by how much the last value of the run
    changes in a second, and `whole` whether no value of the interval is left out.

    `events` also holds the activation of a chunk over time, with its value at each tick, which is computed from the events if its name is
    among `names`: that of the memory, the chunk, and an end that the question `memory` lists, such as `agent.memory: item:cup base level
    over time`. It is not among the `names` of the answer. If it cannot be computed, `why` is a sentence that says why. `basis` is a text;
    if it differs from that of an earlier answer, the model has changed parameters of the memory, and earlier values are not valid.
    A recording does not return these curves: they need the modules of the memory.

    After going back, a run still returns what lies ahead, until it continues differently. `/api/recordings/{recording}/curves` returns
    the same for a recording.
    """

    type: Literal["curves"] = "curves"
    names: tuple[CurveName, ...] | None = Field(default=None, max_length=500)
    """The names of the curves; None for all."""
    first: Seconds = 0.0
    """Start of the interval [s]: a page need not ask again for what it has."""
    last: Seconds | None = None
    """End of the interval, included [s]; None for the furthest time of the run."""
    most: int = Field(default=1_000, ge=2, le=5_000)
    """Maximum number of times, evenly spaced; the last moment of the interval is included, and so are moments of contacts. A shorter
    interval is returned completely. Of a curve of events, at most `most` values are returned, with its extremes and the last value."""
    seen: int | None = Field(default=0, ge=0)
    """How many curves of events the page knows: `names` need not list these again. None if it wants no curves of events: computing them
    takes time."""

    def answer(self, run: ControlledRun) -> dict[str, Any]:
        return run.curves(self.names, self.first, self.last, self.most, self.seen)
