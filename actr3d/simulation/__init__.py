"""Lockstep: agents and a world that go through the same time, tick by tick."""

from actr3d.actr.modules.port import BodyPort, Reading
from actr3d.camera import View  # its package registers the sensor `view`
from actr3d.simulation.commands import Command
from actr3d.simulation.measure import Measure
from actr3d.simulation.observers import Glimpse
from actr3d.simulation.real_time import RunReport
from actr3d.simulation.simulation import Simulation

__all__ = ["BodyPort", "Command", "Glimpse", "Measure", "Reading", "RunReport", "Simulation", "View"]
