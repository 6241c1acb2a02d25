"""The change `parameter`."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.actr.changes.agent_change import AgentChange, Parts
from actr3d.actr.chunks.chunk import IMMUTABLE_TYPES
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.parameters import check_parameter
from actr3d.actr.procedural.production_system import ProductionSystem, refresh_attribute
from actr3d.change import change
from actr3d.errors import SimulationError, did_you_mean


@change
@dataclass(frozen=True)
class SetParameter(AgentChange):
    """Sets a parameter of an agent."""

    word = "parameter"
    of = "parameter"
    title = "Set parameter"
    text = "{path} {value}"

    path: str
    """Its path, such as `walker.memory.latency`."""
    value: bool | int | float | str | None
    """Its new value: a number, true, false, None or a text; a text that reads like one of the others in quotation marks."""

    def carry_out(self, on: Parts) -> None:
        place, _, name = self.path.rpartition(".")
        place = place or "top"
        part = on.part(Model, place, "part")
        known = [known for known, now in part.__dict__.items() if known[0] != "_" and type(now) in IMMUTABLE_TYPES]
        if name not in known:
            raise SimulationError(f"no parameter '{self.path}': '{place}' has no '{name}'{did_you_mean(name, known)}")
        check_parameter(part, name, self.value, f"parameter '{self.path}'")
        setattr(part, name, self.value)
        for system in on:
            if isinstance(system, ProductionSystem):
                refresh_attribute(system, part, name)
