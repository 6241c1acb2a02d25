"""Commands that go to another time of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field

from actr3d.clock import MICROSECONDS
from workbench.page_commands.command import PageCommand, Seconds, page_command

if TYPE_CHECKING:
    from workbench.worker.run_controller import RunController


@page_command
class Back(PageCommand):
    """Goes back by a number of ticks."""

    type: Literal["back"] = "back"
    of_shown_run: ClassVar[bool] = True
    ticks: int = Field(default=1, ge=1, le=100_000)

    def carry_out(self, controller: RunController) -> None:
        clock, period = controller.run.clock, controller.run.period
        controller.go_to(max(0, -(-clock // period) - self.ticks) * period)


@page_command
class Seek(PageCommand):
    """Goes to an earlier time of the run [s]; running on from there repeats what was recorded."""

    type: Literal["seek"] = "seek"
    of_shown_run: ClassVar[bool] = True
    time: Seconds

    def carry_out(self, controller: RunController) -> None:
        controller.go_to(round(self.time * MICROSECONDS))
