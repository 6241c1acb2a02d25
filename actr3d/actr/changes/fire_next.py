"""The change `fire_next`."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.actr.changes.agent_change import AgentChange, Parts
from actr3d.actr.explain.condition_tests import why
from actr3d.actr.explain.present_state import Present
from actr3d.actr.procedural.production_system import choose_next
from actr3d.change import change
from actr3d.errors import ProductionException


@change
@dataclass(frozen=True)
class FireNext(AgentChange):
    """Makes a production that matches fire next, whatever its utility, instead of the one that was about to fire."""

    word = "fire_next"
    of = "production"
    title = "Fire next"
    text = "{production}"

    system: str
    """The path of the production system."""
    production: str
    """The name of the production."""

    def carry_out(self, on: Parts) -> None:
        system, production = on.production(self.system, self.production)
        reason = why(production, Present(system))
        if reason.matches is False:
            raise ProductionException(
                f"'{self.production}' cannot fire next, because it does not match: {reason.condition}, expected {reason.expected}, "
                f"found {reason.found}"
            )
        if reason.selected:
            raise ProductionException(f"'{self.production}' is about to fire already")
        choose_next(system, production)
