"""The base of all changes of agents, and what they find in an agent."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from inspect import signature
from typing import Any, TypeVar

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tree import path_of, subtree
from actr3d.actr.procedural.production import Production
from actr3d.actr.procedural.production_system import ProductionSystem, procedural_state_of
from actr3d.change import Change
from actr3d.errors import ChunkError, SimulationError, alternatives

P = TypeVar("P", bound=Model)


class Parts:
    """The parts of agents by their paths, such as `walker.goal`.

    Args:
        tops: The top models.
    """

    def __init__(self, tops: Iterable[Model]) -> None:
        self._tops = tuple(tops)

    def __iter__(self) -> Iterator[Model]:
        for top in self._tops:
            yield from subtree(top)

    def part(self, kind: type[P], path: str, what: str) -> P:
        """Returns a part.

        Args:
            kind: Its class.
            path: Its path.
            what: What it is, for the error.

        Raises:
            SimulationError: If there is none of that kind at that path; with those that there are.
        """
        known = {path_of(part): part for part in self if isinstance(part, kind)}
        if path not in known:
            raise SimulationError(f"no {what} '{path}'{alternatives(path, known)}")
        return known[path]

    def production(self, path: str, name: str) -> tuple[ProductionSystem, Production]:
        """Returns a production, and its system.

        Raises:
            SimulationError: If there is no such system or production; with those that there are.
        """
        system = self.part(ProductionSystem, path, "production system")
        known = {production.name: production for production in procedural_state_of(system).productions}
        if name not in known:
            raise SimulationError(f"no production '{name}' in '{path}'{alternatives(name, known)}")
        return system, known[name]


class AgentChange(Change):
    """A change of a part of an agent. Its first field is the path of this part; `carry_out` gets the parts of all agents."""

    @classmethod
    def renamed(cls, values: Sequence[Any], named: Mapping[str, Any], name: Callable[[str], str]) -> tuple[list[Any], dict[str, Any]]:
        """Returns the arguments of a command, in which the part has another path.

        Args:
            values: The positional arguments of a valid command.
            named: Its keyword arguments.
            name: Returns the other path of a part.
        """
        path = next(iter(signature(cls).parameters))
        return [*map(name, values[:1]), *values[1:]], {key: name(value) if key == path else value for key, value in named.items()}


def chunk_of(text: str, where: str) -> Chunk:
    """Returns a chunk from a user's text.

    Raises:
        ChunkError: If the text has no slot, or a variable: no production is firing that could bind it.
    """
    try:
        chunk = Chunk(text)
    except ChunkError as error:
        raise ChunkError(f"'{where}': {error}; write a value") from None
    if not chunk:
        raise ChunkError(f"'{where}': a chunk has at least one slot, such as 'count 3' or 'item:cup' (got {text!r})")
    return chunk
