"""Commands that change the run itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from workbench.page_commands.command import Name, PageCommand, PlainValue, page_command

if TYPE_CHECKING:
    from workbench.worker.run_controller import RunController


class RunChange(PageCommand):
    """Base of the commands that change the run itself.

    If the run has gone back, it continues differently from here. The part that lies ahead is kept as a recording of its own, a
    branch. If it cannot be kept, the change is refused unless `drop` is true; the reply says so in `loses`.
    """

    drop: bool = False
    """Whether the part that lies ahead may be lost if it cannot be kept."""


@page_command
class Set(RunChange):
    """Changes a live parameter of the model in the running simulation."""

    type: Literal["set"] = "set"
    name: Name
    value: PlainValue

    def carry_out(self, controller: RunController) -> None:
        live = controller.run.live_parameter(self.name, self.value)
        controller.change(live.word, (*live.before, self.value), body=live.body, drop=self.drop)


@page_command
class Undo(RunChange):
    """Undoes the last change by hand up to now: the run goes to its moment, and continues without it and without later changes."""

    type: Literal["undo"] = "undo"

    def carry_out(self, controller: RunController) -> None:
        controller.undo(drop=self.drop)


@page_command
class SimulationCommand(RunChange):
    """Sends any command to the world, the agents or a body, as `Simulation.command` does."""

    type: Literal["command"] = "command"
    word: Name
    values: tuple[PlainValue, ...] = Field(default=(), max_length=100)
    named: dict[Name, PlainValue] = Field(default_factory=dict, max_length=100)
    body: Name | None = None

    def carry_out(self, controller: RunController) -> None:
        controller.change(self.word, self.values, self.named, self.body, drop=self.drop)
