"""Commands of a user to a running simulation, between two ticks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any, cast

from actr3d.actr.changes import AgentChange
from actr3d.actr.chunks.chunk import IMMUTABLE_TYPES
from actr3d.change import CHANGES
from actr3d.errors import SimulationError, alternatives, did_you_mean, followed
from actr3d.simulation.agents import Agents
from actr3d.world import World


@dataclass(frozen=True, slots=True)
class Command:
    """One command of a user."""

    tick: int
    """Number of ticks before it."""
    word: str
    """A change of the world or of an agent (`CHANGES`), or a command of a body."""
    values: tuple[Any, ...]
    """Its positional arguments."""
    named: Mapping[str, Any]
    """Its keyword arguments."""
    body: str | None = None
    """The body that receives it; None for the world or the agents."""
    by: str | None = None
    """In a program: `user` if its user gives it, None if the program gives it itself."""

    def to_data(self) -> dict[str, Any]:
        """Returns the command as plain values."""
        data = {"command": self.word, "data": {"values": list(self.values), "named": dict(self.named), "body": self.body}}
        return data if self.by is None else {**data, "by": self.by}

    @classmethod
    def from_data(cls, tick: int, data: Mapping[str, Any]) -> Command:
        """Returns the command that `to_data` described."""
        given = data["data"]
        named = {name: _fixed(value) for name, value in given["named"].items()}
        return cls(tick, data["command"], tuple(map(_fixed, given["values"])), named, given["body"], data.get("by"))

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
        if self.body is not None:
            if not only_agents:
                world.bodies[self.body].set(self.word, *self.values, **self.named)
            return
        change = CHANGES[self.word].of_arguments(self.values, self.named)
        if isinstance(change, AgentChange):
            change.carry_out(agents.parts)
        elif not only_agents:
            change.carry_out(world)


def command_of(
    tick: int, word: str, values: Sequence[Any], named: Mapping[str, Any], body: str | None, by: str | None, world: World
) -> Command:
    """Returns a command, with the body that receives it.

    Raises:
        SimulationError: If there is no such body, or more than one, or a value is not plain.
    """
    bodies: Mapping[str, Any] = world.bodies
    given: tuple[Any, Any] = (word, "" if body is None else body)
    for text in given:
        if not isinstance(text, str):
            raise SimulationError(f"command and body must be text (got {text!r})")
    if body is None and word not in CHANGES:
        if len(bodies) != 1:
            say = f"name its body: {', '.join(bodies)}" if bodies else f"there are: {', '.join(CHANGES)}"
            raise SimulationError(f"no command '{word}'{followed(did_you_mean(word, CHANGES), say)}")
        (body,) = bodies
    if body is not None and body not in bodies:
        raise SimulationError(f"command '{word}': no body '{body}'{alternatives(body, bodies)}")
    return Command(tick, word, tuple(map(_fixed, values)), {name: _fixed(value) for name, value in named.items()}, body, by)


def _fixed(value: Any) -> Any:
    """Returns an immutable value that can be recorded."""
    if type(value) in IMMUTABLE_TYPES:
        return value
    if isinstance(value, Real):  # of numpy, for instance
        return int(value) if isinstance(value, Integral) else float(value)
    if isinstance(value, (list, tuple)):
        return tuple(map(_fixed, cast("list[Any]", value)))
    if isinstance(value, dict) and all(isinstance(key, str) for key in cast("dict[Any, Any]", value)):
        return {key: _fixed(item) for key, item in cast("dict[str, Any]", value).items()}
    raise SimulationError(f"a command takes numbers, texts, and tuples and dicts of these, which can be recorded (got {value!r})")
