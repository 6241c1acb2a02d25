"""The change `forbid_once`."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.actr.changes.agent_change import AgentChange, Parts
from actr3d.actr.procedural.production_system import leave_out_once, procedural_state_of
from actr3d.change import change
from actr3d.errors import ProductionException


@change
@dataclass(frozen=True)
class ForbidOnce(AgentChange):
    """Leaves a production out of the next choice for which it matches; if it is about to fire, the choice is made again without it."""

    word = "forbid_once"
    of = "production"
    title = "Forbid once"
    text = "{production}"

    system: str
    """The path of the production system."""
    production: str
    """The name of the production."""

    def carry_out(self, on: Parts) -> None:
        system, production = on.production(self.system, self.production)
        if production.name in procedural_state_of(system).forbidden:
            raise ProductionException(f"'{self.production}' is forbidden already, and has not been left out of a choice yet")
        leave_out_once(system, production)
