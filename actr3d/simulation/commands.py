"""Commands of a user to a running simulation, between two ticks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any, cast

from actr3d.actr.chunks.chunk import LASTING_TYPES
from actr3d.errors import SimulationError, did_you_mean
from actr3d.simulation.agents import Agents
from actr3d.world.world import WORLD_COMMANDS, World

Carry = Callable[..., None]


@dataclass(frozen=True, slots=True)
class Command:
    """One command of a user."""

    tick: int
    """Number of ticks before it."""
    word: str
    """A command to the world (`WORLD_COMMANDS`), to the agents (`ON_AGENTS`), or to a body."""
    values: tuple[Any, ...]
    """Its positional arguments."""
    named: Mapping[str, Any]
    """Its keyword arguments."""
    body: str | None = None
    """The body that receives it; None for the world or the agents."""

    def to_data(self) -> dict[str, Any]:
        """Returns the command as plain values."""
        return {"command": self.word, "data": {"values": list(self.values), "named": dict(self.named), "body": self.body}}

    @classmethod
    def from_data(cls, tick: int, data: Mapping[str, Any]) -> Command:
        """Returns the command that `to_data` described."""
        given = data["data"]
        named = {name: _fixed(value) for name, value in given["named"].items()}
        return cls(tick, data["command"], tuple(map(_fixed, given["values"])), named, given["body"])

    def carry_out(self, world: World, agents: Agents, *, only_agents: bool = False) -> None:
        """Carries it out.

        Args:
            world: The world.
            agents: The agents.
            only_agents: Whether to leave out commands to the world, because its state is restored later.

        Raises:
            SimulationError: If there is no such command, or a value is wrong.
            Exception: What a body raises.
        """
        if self.body is None and self.word in ON_AGENTS:
            self._call(ON_AGENTS[self.word], agents)
        elif not only_agents:
            if self.body is None:
                self._call(WORLD_COMMANDS[self.word], world)
            else:
                world.bodies[self.body].set(self.word, *self.values, **self.named)

    def _call(self, carry: Carry, on: World | Agents) -> None:
        try:
            carry(on, *self.values, **self.named)
        except TypeError as error:
            raise SimulationError(f"command '{self.word}': {error}") from error


def _parameter(agents: Agents, path: str, value: Any) -> None:
    agents.set_parameter(path, value)


ON_AGENTS: dict[str, Carry] = {"parameter": _parameter}
"""Commands to the agents by name."""


def command_of(tick: int, word: str, values: tuple[Any, ...], named: Mapping[str, Any], body: str | None, world: World) -> Command:
    """Returns a command, with the body that receives it.

    Raises:
        SimulationError: If there is no such body, or more than one, or a value is not plain.
    """
    bodies: Mapping[str, Any] = world.bodies
    given: tuple[Any, Any] = (word, "" if body is None else body)
    for text in given:
        if not isinstance(text, str):
            raise SimulationError(f"command and body must be text (got {text!r})")
    if body is None and word not in WORLD_COMMANDS and word not in ON_AGENTS:
        if len(bodies) != 1:
            known = [*WORLD_COMMANDS, *ON_AGENTS]
            say = f"name its body: {', '.join(bodies)}" if bodies else f"there are: {', '.join(known)}"
            raise SimulationError(f"no command '{word}'{did_you_mean(word, known)}; {say}")
        (body,) = bodies
    if body is not None and body not in bodies:
        raise SimulationError(f"command '{word}': no body '{body}'{did_you_mean(body, bodies)}; there are: {', '.join(bodies) or 'none'}")
    return Command(tick, word, tuple(map(_fixed, values)), {name: _fixed(value) for name, value in named.items()}, body)


def _fixed(value: Any) -> Any:
    """Returns an immutable value that can be recorded."""
    if type(value) in LASTING_TYPES:
        return value
    if isinstance(value, Real):  # of numpy, for instance
        return int(value) if isinstance(value, Integral) else float(value)
    if isinstance(value, (list, tuple)):
        return tuple(map(_fixed, cast("list[Any]", value)))
    if isinstance(value, dict) and all(isinstance(key, str) for key in cast("dict[Any, Any]", value)):
        return {key: _fixed(item) for key, item in cast("dict[str, Any]", value).items()}
    raise SimulationError(f"a command takes numbers, texts, and tuples and dicts of these, which can be recorded (got {value!r})")
