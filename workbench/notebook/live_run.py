"""A run that lives in a notebook: its cells and its pages take turns."""

from __future__ import annotations

import asyncio
import os
import socket
import weakref
from collections.abc import Generator
from contextlib import contextmanager, suppress

from actr3d.recording import Recording
from actr3d.simulation import Simulation
from actr3d.simulation.observers import Glimpse
from workbench.loader import listing_of
from workbench.worker.channel import Channel
from workbench.worker.error_report import UNFORESEEN, describe_error, notice_of
from workbench.worker.messages import WorkerEnded
from workbench.worker.run_controller import Leaving, RunController
from workbench.worker.simulation_display import SimulationDisplay
from workbench.worker.simulation_run import ENDINGS, SimulationRun

BY_CELL = "by a cell"


class LiveRun(SimulationRun):
    """Shows a simulation of this process while cells run it, and carries out the commands of pages between cells.

    The notebook's event loop runs between cells, in the thread of the cells, to which the simulation belongs.

    Args:
        simulation: The simulation. It holds this run, and this run ends with it.
        wire: The socket to the server.
        loop: The notebook's event loop.

    Raises:
        SimulationError: If the simulation has begun, and does not repeat what it did.
    """

    def __init__(self, simulation: Simulation, wire: socket.socket, loop: asyncio.AbstractEventLoop) -> None:
        arrived = weakref.WeakMethod(self._arrived)
        channel = Channel(wire, arrived=lambda: (call := arrived()) and call(), end=_stay)
        controller = RunController(channel)
        super().__init__(controller, listing_of("", "notebook"))
        channel.busy = None  # its threads hold nothing of the simulation
        self._loop = loop
        self._process = os.getpid()
        self.session = ""
        """The session of the server that shows it."""
        self.left = False
        """Whether the server has left it."""
        self._turn_due: asyncio.TimerHandle | None = None
        self._rest_due = False
        self._own = False
        """Whether pages run the simulation now, and not a cell."""
        self._simulation = simulation
        self._take_past()
        self._events = self._count = 0
        """The numbers of events and of ticks of the run when it was last looked at."""
        controller.channel.post(self._facts(simulation.seed, {}))
        controller.set_run(self)
        if simulation.world.bodies:
            controller.use_real_time()
        channel.events = None
        simulation.observe(self._observe)
        simulation.observe(self._rest, of_calls=True)
        weakref.finalize(simulation, _end, channel, wire)
        self._look()
        controller.pause("at its start" if not simulation.ticks else BY_CELL)

    def _take_past(self) -> None:
        """Repeats a run that has begun, as its events and states from the start on are shown."""
        simulation = self._simulation
        time, furthest = simulation.time, simulation.furthest
        simulation.event_log.raise_level("all", keep=True)
        if simulation.timeline.begun:
            simulation.seek(0)
        self._shown = SimulationDisplay(simulation)
        for moment in (furthest, time):
            if simulation.time != moment:
                simulation.seek(moment)

    # -- what cells do

    def _observe(self, _: Glimpse) -> None:
        """Shows the run while a cell runs it."""
        if self._own or self.left or os.getpid() != self._process:
            return
        self._look()
        controller = self._controller
        controller.status, controller.reason = "running", BY_CELL
        controller.show_if_due(hurried=True)
        if not self._rest_due:
            self._rest_due = True
            self._loop.call_soon(self._rest)

    def _rest(self, _: Glimpse | None = None) -> None:
        """Shows the exact state of the run after a call in a cell, or after the whole cell."""
        self._rest_due &= _ is not None
        if self._own or self.left or os.getpid() != self._process:
            return
        self._look()
        self.take_events()  # a cell may go back next
        if self._simulation.timeline.lockstep.broken:
            self._controller.end("failed", "in a cell of the notebook")
        else:
            self._controller.pause(BY_CELL)

    def _look(self) -> None:
        """Notices that a cell has gone back and given the run another future."""
        if self._simulation.timeline.furthest < self._count:
            self._controller.continue_differently(self._events, "changed by a cell", ahead=True)
        self._note()

    def _note(self) -> None:
        self._count, self._events = self._simulation.timeline.furthest, len(self.trace)

    def write_to(self, recording: Recording) -> None:
        """Writes the run up to now to a new recording, which can only be looked at: commands and answers are left out."""
        for event in self.trace:
            recording.event(event)
        for moment in self._shown.kept.states.between(0, self._simulation.ticks):
            recording.state(1, *moment)

    # -- what pages do

    def _arrived(self) -> None:
        with suppress(RuntimeError):  # the loop has ended, and the process will
            self._loop.call_soon_threadsafe(self._turn)

    def _turn(self) -> None:
        """Carries out the commands of pages; runs a few ticks if they have started it."""
        if self._turn_due is not None:
            self._turn_due.cancel()
            self._turn_due = None
        controller = self._controller
        with self._by_page():
            try:
                controller.attend(wait=False)
                early = controller.pacer.early(self.clock, self.clock)
                if controller.status == "running" and not self._rest_due and early <= 0:
                    over = self.run_ticks()
                    controller.after_ticks()
                    if over is not None:
                        controller.pause(ENDINGS[over])
            except Leaving:
                self.left = True
            except UNFORESEEN as error:
                controller.channel.post(notice_of(error))
                controller.end("failed", describe_error(error))
        if controller.status == "running" and not self.left:
            self._turn_due = self._loop.call_later(max(0.0, controller.pacer.early(self.clock, self.clock)), self._turn)

    @contextmanager
    def _by_page(self) -> Generator[None]:
        self._own = True
        try:
            yield
        finally:
            self._own = False
            self._note()  # a page that has changed the past has been told so


def _end(channel: Channel, wire: socket.socket) -> None:
    """Ends the connection of a simulation that is no more, and its threads."""
    channel.post(WorkerEnded())
    channel.flush(0.2)
    with suppress(OSError):
        wire.shutdown(socket.SHUT_RDWR)
    wire.close()
    channel.post(WorkerEnded())  # cannot be sent, which ends the thread that tries


def _stay(_: int) -> None:
    """Leaves the process of the notebook alone."""
