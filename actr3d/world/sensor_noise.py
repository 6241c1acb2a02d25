"""Noise of sensors, which the physics engine does not add; seeded, so that it is the same in every run of one seed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from numbers import Integral
from typing import Any, cast

from numpy.random import PCG64, Generator, SeedSequence

from actr3d.errors import WorldError, alternatives
from actr3d.world.command_registry import checked_number

Noise = tuple[tuple[str, float | tuple[tuple[str, float], ...]], ...]
"""Of a body's description: the name of a sensor, and the standard deviation of every number of its readings, or by field."""

StandardDeviation = float | Mapping[str, float] | None
"""Of every number of a reading, or by field; None for no noise."""


class SensorNoise:
    """Adds Gaussian noise to readings. Each sensor has its own random numbers: reading one does not change another.

    Args:
        seed: The seed of the world.
        name: The name of the body.
    """

    def __init__(self, seed: int, name: str) -> None:
        self._seed = seed
        self._name = name
        self._generators: dict[str, Generator] = {}

    def added(self, sensor: str, reading: Any, sd: float | Mapping[str, float]) -> Any:
        """Returns the reading with noise on every number that is not a count.

        Args:
            sensor: The name of the sensor.
            reading: Its reading: a number, a dataclass, a tuple or dictionary of readings, or what has `with_noise(sd, random)`. None,
                text and integers stay unchanged.
            sd: The standard deviation in the reading's unit, or one for each field named.

        Raises:
            WorldError: If a standard deviation is not a number >= 0, or is for a field that the reading does not have; or if
                noise cannot be added to a reading of this type.
        """
        of = f"{self._name}: noise of {sensor}"
        fields = {_field(name, of): checked_number(value, of, 0) for name, value in sd.items()} if isinstance(sd, Mapping) else None
        checked = checked_number(sd, of, 0) if fields is None else fields
        if sensor not in self._generators:
            self._generators[sensor] = Generator(PCG64(SeedSequence([self._seed, *f"{self._name} {sensor}".encode()])))
        return _noisy(sensor, reading, checked, self._generators[sensor])

    def state(self) -> tuple[tuple[str, int, int], ...]:
        """Returns the state of the random numbers of each sensor."""
        states = {sensor: dict(generator.bit_generator.state["state"]) for sensor, generator in self._generators.items()}
        return tuple((sensor, int(state["state"]), int(state["inc"])) for sensor, state in states.items())

    def restore(self, state: tuple[tuple[str, int, int], ...]) -> None:
        """Restores a state that `state` returned."""
        self._generators.clear()
        for sensor, at, increment in state:
            bits = PCG64()
            bits.state = {"bit_generator": "PCG64", "state": {"state": at, "inc": increment}, "has_uint32": 0, "uinteger": 0}
            self._generators[sensor] = Generator(bits)


def _field(name: Any, of: str) -> str:
    if not isinstance(name, str):
        raise WorldError(f"{of}: a field is named by text (got {name!r})")
    return name


def _noisy(sensor: str, value: Any, sd: Any, random: Generator) -> Any:
    if isinstance(value, float):
        if isinstance(sd, Mapping):
            raise WorldError(f"noise of {sensor}: its readings have no fields; give one number")
        return value + sd * random.standard_normal()
    if hasattr(value, "with_noise"):
        return value.with_noise(sd, random)
    if isinstance(value, tuple):
        items = cast("tuple[Any, ...]", value)
        names: tuple[str, ...] | None = getattr(items, "_fields", None)
        if names is not None:  # a named tuple
            return type(items)(**_by_name(sensor, dict(zip(names, items, strict=True)), sd, random))
        return tuple(_noisy(sensor, item, sd, random) for item in items)
    if isinstance(value, dict):
        by_key = cast("dict[Any, Any]", value)
        if _is_by_key(by_key, sd):
            return _by_name(sensor, by_key, sd, random)
        return {key: _noisy(sensor, item, sd, random) for key, item in by_key.items()}
    if is_dataclass(value) and not isinstance(value, type):
        return type(value)(**_by_name(sensor, {field.name: getattr(value, field.name) for field in fields(value)}, sd, random))
    if value is None or isinstance(value, (str, bytes, Integral)):
        return value
    what = f"{type(value).__name__} (got {value!r:.60})"
    raise WorldError(f"noise of {sensor}: is not added to a {what}; a reading has numbers, tuples, dictionaries and dataclasses")


def _by_name(sensor: str, old: dict[Any, Any], sd: float | dict[str, float], random: Generator) -> dict[Any, Any]:
    if not isinstance(sd, dict):
        return {name: _noisy(sensor, item, sd, random) for name, item in old.items()}
    for name in sd:
        if name not in old:
            raise WorldError(f"noise of {sensor}: its readings have no '{name}'{alternatives(name, old, 'they have')}")
    return {name: _noisy(sensor, item, sd[name], random) if name in sd else item for name, item in old.items()}


def _is_by_key(reading: dict[Any, Any], sd: float | dict[str, float]) -> bool:
    """Returns whether standard deviations are by the keys of a reading, and not by the fields of what it holds."""
    return isinstance(sd, dict) and (bool(sd.keys() & reading.keys()) or any(isinstance(item, float) for item in reading.values()))
