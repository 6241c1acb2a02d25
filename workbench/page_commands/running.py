"""Commands that continue a run, pause it, or go to another time of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field

from actr3d.clock import MICROSECONDS
from workbench.page_commands.command import Name, PageCommand, Seconds, page_command

if TYPE_CHECKING:
    from workbench.session import Session
    from workbench.worker.messages import Reply
    from workbench.worker.run_controller import RunController


@page_command
class Run(PageCommand):
    """Continues the run."""

    type: Literal["run"] = "run"

    def carry_out(self, controller: RunController) -> None:
        controller.go()


@page_command
class Pause(PageCommand):
    """Pauses the run at the end of the current tick."""

    type: Literal["pause"] = "pause"
    cancels_seek: ClassVar[bool] = True

    async def serve(self, session: Session) -> Reply:
        return await session.ask_all(self)

    def carry_out(self, controller: RunController) -> None:
        if controller.status == "running":
            controller.pause("by the user")


@page_command
class Step(PageCommand):
    """Runs a number of ticks."""

    type: Literal["step"] = "step"
    ticks: int = Field(default=1, ge=1, le=100_000)

    def carry_out(self, controller: RunController) -> None:
        # Steps that arrive before earlier steps are finished add up.
        watch, run = controller.watch, controller.run
        under_way = controller.status == "running" and watch.goal is not None
        begin = (watch.goal or 0) if under_way else run.clock
        controller.go(goal=(begin // run.period + self.ticks) * run.period, goal_reason="after a step")


@page_command
class Cycle(PageCommand):
    """Runs until the next production fires; of one production system if `system` is given."""

    type: Literal["cycle"] = "cycle"
    system: Name | None = None

    def carry_out(self, controller: RunController) -> None:
        # Like steps, cycles that are requested before the previous one is finished add up.
        watch = controller.watch
        if controller.status == "running" and watch.cycles > 0 and watch.system == self.system:
            watch.cycles += 1
        else:
            controller.go(cycles=1, system=self.system)


@page_command
class Speed(PageCommand):
    """Sets the maximum speed of the run as a multiple of real time; None for as fast as possible."""

    type: Literal["speed"] = "speed"
    factor: float | None = Field(default=None, ge=0.05, le=10_000)

    async def serve(self, session: Session) -> Reply:
        session.set_speed(self.factor)
        return await session.apply_setting(self)

    def carry_out(self, controller: RunController) -> None:
        controller.pacer.set(self.factor)
        controller.show()


@page_command
class Breakpoints(PageCommand):
    """Sets the productions after which the run pauses whenever they fire."""

    type: Literal["breakpoints"] = "breakpoints"
    productions: tuple[Name, ...] = Field(default=(), max_length=200)

    async def serve(self, session: Session) -> Reply:
        before = session.breakpoints
        session.set_breakpoints(self.productions)
        reply = await session.apply_setting(self)
        if reply.error is not None and session.breakpoints == self.productions:
            session.set_breakpoints(before)  # the run does not know one of the names
        return reply

    def carry_out(self, controller: RunController) -> None:
        names = controller.run.names()
        for name in sorted({*self.productions} - controller.watch.breakpoints):  # what was named before may be gone
            names.check("production", name)
        controller.watch.breakpoints = frozenset(self.productions)


@page_command
class Back(PageCommand):
    """Goes back by a number of ticks."""

    type: Literal["back"] = "back"
    of_shown_run: ClassVar[bool] = True
    cancels_seek: ClassVar[bool] = True
    ticks: int = Field(default=1, ge=1, le=100_000)

    def carry_out(self, controller: RunController) -> None:
        run = controller.run
        begin = run.clock if run.target is None else run.target
        controller.go_to(max(0, -(-begin // run.period) - self.ticks) * run.period)


@page_command
class Seek(PageCommand):
    """Goes to an earlier time of the run [s]; running on from there repeats what was recorded."""

    type: Literal["seek"] = "seek"
    of_shown_run: ClassVar[bool] = True
    cancels_seek: ClassVar[bool] = True
    time: Seconds

    def carry_out(self, controller: RunController) -> None:
        controller.go_to(round(self.time * MICROSECONDS))
