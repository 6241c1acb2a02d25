"""Checks the arguments of a simulation, and converts them to plain values that can be recorded."""

from __future__ import annotations

import operator
from collections.abc import Collection, Mapping
from contextlib import suppress
from numbers import Real
from typing import Any, cast

from actr3d.clock import microseconds, seconds
from actr3d.errors import WITHOUT_BODY, SimulationError, did_you_mean
from actr3d.world import Scene, World


def world_of(scene: Any, seed: int) -> World:
    """Returns the given world, or a new one from a scene.

    Raises:
        SimulationError: If it is neither, or the world is not at its start.
        WorldError: If the scene cannot be compiled.
    """
    if isinstance(scene, World):
        if scene.time:
            now = seconds(scene.time)
            raise SimulationError(f"Simulation.scene: the world must be at its start, as the agents are (got one at {now:g} s)")
        return scene
    if not isinstance(scene, Scene):
        hint = f"; {WITHOUT_BODY}" if scene is None else ""
        raise SimulationError(f"Simulation.scene: must be a Scene or a World (got {scene!r}){hint}")
    return World(scene, seed)


def seed_of(seed: Any) -> int | str:
    """Returns a seed as a whole number or a text.

    Raises:
        SimulationError: If it is neither, or a negative number.
    """
    if isinstance(seed, str) and seed.isprintable():
        return str(seed)
    return _whole(seed, "Simulation.seed: must be a whole number >= 0 or a text of printable characters")


def count_of(n: Any, what: str) -> int:
    """Returns a count as an integer.

    Raises:
        SimulationError: If it is not a whole number, or is negative.
    """
    return _whole(n, f"{what}: must be a whole number >= 0")


def factor_of(factor: Any, what: str) -> float | None:
    """Returns a factor of real time; None for as fast as possible.

    Raises:
        SimulationError: If it is not a finite number > 0.
    """
    if factor is None:
        return None
    if not isinstance(factor, Real) or not 0 < cast("Any", factor) < float("inf"):
        raise SimulationError(f"{what}: must be a finite number > 0 (got {factor!r})")
    return float(factor)


def _whole(value: Any, message: str) -> int:
    """Returns a whole number >= 0.

    Raises:
        SimulationError: If it is something else; it begins with the message.
    """
    with suppress(TypeError):
        if (number := int(operator.index(value))) >= 0:
            return number
    raise SimulationError(f"{message} (got {value!r})")


# -- times


def steps_of(period: float, world: World) -> int:
    """Returns the number of physics steps in a period.

    Raises:
        SimulationError: If it is not a whole number of them.
    """
    step = world.scene.timestep_us
    steps, rest = divmod(microseconds(period, "Simulation.period"), step)
    if rest or steps < 1:
        raise SimulationError(f"Simulation.period: must be a whole multiple of the physics step of {seconds(step):g} s (got {period!r})")
    return steps


def whole_ticks(time: float, period: int, what: str) -> int:
    """Returns the number of ticks of a period [us] in a time [s].

    Raises:
        SimulationError: If it is not a whole number of them, or is negative.
    """
    ticks, rest = divmod(microseconds(time, f"the time of {what}"), period)
    if rest or ticks < 0:
        raise SimulationError(f"{what}: must be a whole number of ticks of {seconds(period):g} s, >= 0 (got {time!r})")
    return ticks


# -- agents


def named_factories(given: Any, what: str) -> dict[str, Any]:
    """Returns the factories of agents by name.

    Raises:
        SimulationError: If it is not a mapping, or a name is invalid.
    """
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise SimulationError(
            f"{what}: must be a dict with the class or function that makes each agent, such as {{'walker': Walker}} (got {given!r})"
        )
    named = dict(cast("Mapping[Any, Any]", given))
    for name in named:
        if not isinstance(name, str) or not name.isprintable() or name[:1] in ("", "_"):
            raise SimulationError(f"{what}: an agent's name must be a text that does not begin with '_' (got {name!r})")
    return named


def check_names(agents: Collection[str], bodiless: Collection[str], bodies: Collection[str]) -> None:
    """Checks that agents have the bodies that they should have.

    Raises:
        SimulationError: If a named body does not exist, or a bodiless agent has the name of a body.
    """
    for name in agents:
        if name not in bodies:
            hint = did_you_mean(name, bodies) or f"; there are: {', '.join(bodies) or 'none'}"
            raise SimulationError(f"agents: no body '{name}' in the scene{hint} (an agent without a body goes into `bodiless`)")
    for name in bodiless:
        if name in bodies:
            raise SimulationError(f"bodiless: '{name}' is the name of a body")
