"""Commands to a session, which the server carries out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic import AfterValidator, Field

from workbench.overlays import OVERLAYS
from workbench.page_commands.command import Name, PageCommand, PlainValue, page_command
from workbench.worker.messages import Reply

if TYPE_CHECKING:
    from workbench.session import Session
    from workbench.worker.run_controller import RunController


@page_command
class Restart(PageCommand):
    """Starts the model again, optionally with other parameters or a new seed."""

    type: Literal["restart"] = "restart"
    settings: dict[Name, PlainValue] | None = Field(default=None, max_length=200)
    """Values of parameters that differ from the model's defaults; None for those of the current run."""
    seed: int | None = Field(default=None, ge=0, lt=2**63)
    new_seed: bool = False
    record: bool = True
    run: bool = False
    """Whether the run starts at once; otherwise it is paused at its start."""

    async def serve(self, session: Session) -> Reply:
        await session.restart(self.settings, self.seed, new_seed=self.new_seed, record=self.record, run=self.run)
        return Reply(id=0)


@page_command
class Stop(PageCommand):
    """Ends the worker process of the run, whatever it does; if it answers, a seek in progress is cancelled instead."""

    type: Literal["stop"] = "stop"
    cancels_seek: ClassVar[bool] = True

    async def serve(self, session: Session) -> Reply:
        if not await session.cancel_seek(self):
            await session.stop()
        return Reply(id=0)

    def carry_out(self, controller: RunController) -> None:
        if controller.run.target is not None:
            controller.pause(f"stopped while {controller.reason}")


def _overlay(name: str) -> str:
    if name not in OVERLAYS:
        raise ValueError(f"there is no overlay of this name; there are: {', '.join(OVERLAYS)}")
    return name


@page_command
class ShowOverlay(PageCommand):
    """Shows or hides an overlay of the 3D view, for all who watch the session."""

    type: Literal["overlay"] = "overlay"
    takes_control: ClassVar[bool] = False
    name: Annotated[Name, AfterValidator(_overlay), Field(json_schema_extra={"enum": [*OVERLAYS]})]
    """The name of one of `OVERLAYS`."""
    shown: bool

    async def serve(self, session: Session) -> Reply:
        session.show_overlay(self.name, self.shown)
        return Reply(id=0)
