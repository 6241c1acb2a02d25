"""Computes what is shown of one simulation: its scene, overlays and curves. Asking changes nothing."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from functools import cache, cached_property, partial
from typing import Any

from actr3d.camera import CameraParameters, EyeSense
from actr3d.clock import microseconds
from actr3d.errors import Actr3dError
from actr3d.parameter_schema import Parameter
from actr3d.simulation import Simulation
from actr3d.simulation.surroundings import surroundings
from actr3d.vision import visions
from actr3d.world import Aperture
from actr3d.world.compiled import from_bytes, to_bytes
from workbench.curves import CurveReader, stretch, thinned
from workbench.geom_colours import colour_of_object, dress
from workbench.overlays import OVERLAYS, Observed
from workbench.worker.state_history import SimulationHistory
from workbench.worker.stop_conditions import Touches

WIDEST = 300
"""Default maximum width of a doorway [cm], if no parameter limits it. Chosen here."""


class SimulationDisplay:
    """Provides what pages show of a simulation.

    Args:
        simulation: The simulation, at its start.
        kept: The past and future that are known from an earlier pass through it.
    """

    def __init__(self, simulation: Simulation, kept: SimulationHistory | None = None) -> None:
        self.simulation = simulation
        self.period = microseconds(simulation.period)
        """Length of a tick [us]."""
        self.kept = kept or SimulationHistory(self.period)
        self.kept.keep(0, simulation.world, {})
        simulation.event_log.keep_states(self.kept)
        self.mj_model = to_bytes(simulation.world.mj_model)
        """The compiled scene at the start, in MuJoCo's binary format."""
        self.surroundings = surroundings(simulation.world)
        self._observed = Observed(simulation, self.eyesight, lambda: self.kept.walked.up_to(simulation.ticks, simulation.world))

    def world(self, parameters: Iterable[Parameter] = ()) -> dict[str, Any]:
        """Returns the description of the world for pages, as plain values; the model's parameters limit the widths of doorways."""
        return {
            **self.surroundings,
            "empty": self.simulation.world.mj_model.ngeom == 0,
            "agents": self.simulation.embodied,
            "objects": self.simulation.world.objects.names,
            "widths": width_limits(self.surroundings["apertures"], parameters),
        }

    @property
    def initial_widths(self) -> dict[str, float]:
        """The widths of apertures at the start [m]."""
        return {part.name: part.width for part in self.simulation.world.scene.parts if isinstance(part, Aperture)}

    def scene(self) -> tuple[bytes, dict[str, float]]:
        """Returns the state of the physics, and the widths of apertures [m]."""
        world = self.simulation.world
        return world.state_bytes(), {name: world.aperture_width(name) for name in self.initial_widths}

    def overlay_data(self, kinds: tuple[str, ...]) -> dict[str, Any]:
        """Returns the current data of overlays by kind; empty if it cannot be computed, for example after the physics has diverged."""
        with self.simulation.only_looking(), suppress(Actr3dError):
            return {kind: OVERLAYS[kind].data(self._observed) for kind in kinds}
        return {}

    def result(self) -> dict[str, Any] | None:
        """Returns the measured result of the run, if any."""
        result = self.simulation.result()
        return None if result is None else asdict(result)

    def touches(self) -> Touches:
        """Returns the contacts of bodies with anything but the ground in the last tick."""
        return frozenset(self.kept.states.contacts(self.simulation.ticks))

    def curves(self, names: Sequence[str] | None, first: float, last: float | None, most: int, begin: int = 0) -> dict[str, Any]:
        """Returns curves of the known run.

        Args:
            names: The names of the curves; None for all.
            first: Start of the interval [s].
            last: Its end, included [s]; None for the furthest time of the run.
            most: Maximum number of times.
            begin: The time at which the simulation began, as pages count it [us].
        """
        states = self.kept.states
        known = partial(states.between, *stretch(first, last, self.period, begin))
        return self._curves.sampled(thinned(known, most, states.every), names, self.period, begin)

    @cached_property
    def _curves(self) -> CurveReader:
        """Computes curves from the past, on a copy of the scene; created at the first request."""
        return CurveReader(from_bytes(self.mj_model), self.surroundings)

    def colours(self, geoms: Mapping[int, tuple[int, ...]]) -> dict[int, str]:
        """Returns the colours with which objects are drawn in the scene, by label."""
        return {label: self._colour_of(own) for label, own in geoms.items()}

    @cached_property
    def _colour_of(self) -> Callable[[tuple[int, ...]], str]:
        """Returns the colour in which an object is drawn, by its geoms; each is computed once."""
        model = from_bytes(self.mj_model)
        dress(model, [self.surroundings["bodies"][name]["root"] for name in self.simulation.embodied])
        return cache(partial(colour_of_object, model))

    def eyesight(self, name: str) -> CameraParameters:
        """Returns how an agent sees with its body's eye: as its vision module does, or else as in the body's first view."""
        agent, body = self.simulation.agents.get(name), self.simulation.world.bodies[name]
        own = None if agent is None else next((vision.eyesight for vision in visions(agent)), None)
        return own or next((sense.parameters for sense in body.senses if isinstance(sense, EyeSense)), CameraParameters())


def width_limits(apertures: Iterable[str], parameters: Iterable[Parameter]) -> dict[str, tuple[int, int]]:
    """Returns the minimum and maximum width of each doorway [cm], from the bounds of the parameter that sets doorways."""
    setting = [one for one in parameters if one.live is not None and one.live.word == "aperture"]
    least = [math.ceil(100 * one.least) for one in setting if one.least is not None]
    least += [math.floor(100 * one.above) + 1 for one in setting if one.above is not None]
    most = [math.floor(100 * one.most) for one in setting if one.most is not None]
    most += [math.ceil(100 * one.below) - 1 for one in setting if one.below is not None]
    lowest = max(least, default=0)
    highest = min(most, default=max(WIDEST, 2 * lowest))
    return dict.fromkeys(apertures, (lowest, max(lowest, highest)))  # no whole number may lie between the bounds
