"""What a simulation is given by who uses it: checked, and as plain values, so that it can be recorded."""

from __future__ import annotations

import operator
from collections.abc import Collection, Mapping
from numbers import Real
from typing import Any, cast

from actr3d.clock import microseconds, seconds
from actr3d.errors import SimulationError, did_you_mean
from actr3d.world import Scene, World


def world_of(scene: Any, seed: int) -> World:
    """Returns a world that has been given, or that a scene describes.

    Raises:
        SimulationError: If it is neither, or the world is not at its start.
        WorldError: If the scene cannot be compiled.
    """
    if isinstance(scene, World):
        if scene.time:
            now = seconds(scene.time)
            raise SimulationError(f"Simulation.scene: the world must be at its start, as the minds are (it has come to {now:g} s)")
        return scene
    if not isinstance(scene, Scene):
        raise SimulationError(f"Simulation.scene: must be a Scene or a World (got {scene!r})")
    return World(scene, seed)


def seed_of(seed: Any) -> int | str:
    """Returns a seed as a whole number or a text.

    Raises:
        SimulationError: If it is neither.
    """
    if isinstance(seed, str) and seed.isprintable():
        return str(seed)
    return _whole(seed, "Simulation.seed: must be a whole number or a text of printable characters")


def count_of(n: Any, what: str) -> int:
    """Returns how many of something are meant.

    Raises:
        SimulationError: If it is no whole number, or negative.
    """
    message = f"{what}: must be a whole number, at least 0"
    count = _whole(n, message)
    if count < 0:
        raise SimulationError(f"{message} (got {n!r})")
    return count


def factor_of(factor: Any, what: str) -> float | None:
    """Returns how many times as fast as real time something is to go; None for as fast as possible.

    Raises:
        SimulationError: If it is no finite number above 0.
    """
    if factor is None:
        return None
    if not isinstance(factor, Real) or not 0 < cast("Any", factor) < float("inf"):
        raise SimulationError(f"{what}: must be a finite number above 0 (got {factor!r})")
    return float(factor)


def _whole(value: Any, message: str) -> int:
    try:
        return int(operator.index(value))
    except TypeError:
        raise SimulationError(f"{message} (got {value!r})") from None


# -- times


def steps_of(period: float, world: World) -> int:
    """Returns how many physics steps a period is.

    Raises:
        SimulationError: If it is no whole number of them.
    """
    step = world.scene.timestep_us
    steps, rest = divmod(microseconds(period, "Simulation.period"), step)
    if rest or steps < 1:
        raise SimulationError(f"Simulation.period: must be a whole multiple of the physics step of {seconds(step):g} s (got {period!r})")
    return steps


def whole_ticks(time: float, period: int, what: str) -> int:
    """Returns how many ticks of a period [us] a time [s] is.

    Raises:
        SimulationError: If it is no whole number of them, or negative.
    """
    ticks, rest = divmod(microseconds(time, f"the time of {what}"), period)
    if rest or ticks < 0:
        raise SimulationError(f"{what}: must be a whole number of ticks of {seconds(period):g} s, at least 0 (got {time!r})")
    return ticks


# -- minds


def named_minds(given: Any, what: str) -> dict[str, Any]:
    """Returns what makes each mind, by name.

    Raises:
        SimulationError: If it is no mapping, or a name is none.
    """
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise SimulationError(f"{what}: must name what makes each mind, as in {{'walker': Walker}} (got {given!r})")
    named = dict(cast("Mapping[Any, Any]", given))
    for name in named:
        if not isinstance(name, str) or not name.isprintable() or name[:1] in ("", "_"):
            raise SimulationError(f"{what}: a mind's name must be a text that does not begin with '_' (got {name!r})")
    return named


def check_names(minds: Collection[str], bodiless: Collection[str], bodies: Collection[str]) -> None:
    """Checks that minds have the bodies they should have.

    Raises:
        SimulationError: If there is no such body, or there is one of a name that should have none.
    """
    for name in minds:
        if name not in bodies:
            hint = did_you_mean(name, bodies) or f"; there are: {', '.join(bodies) or 'none'}"
            raise SimulationError(f"minds: no body '{name}' in the scene{hint} (a mind without a body goes into `bodiless`)")
    for name in bodiless:
        if name in bodies:
            raise SimulationError(f"bodiless: '{name}' is the name of a body")
