"""Grid worlds: rectangular maps of cells in which agents with bodies stand, turn and move."""

from __future__ import annotations

import operator
import sys
from pathlib import Path
from typing import Any, cast

from actr3d.actr.grid_body import Body
from actr3d.actr.model import Model, traceable
from actr3d.errors import GridError, did_you_mean
from actr3d.saying import warn_modeller

COMPASS = ((0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1))
"""The steps (x, y) to the eight neighbours, clockwise from north; y grows downwards, as the lines of a map do."""


class Cell:
    """One place of a grid world; a model derives its own kind, with attributes that productions match and actions change.

    Setting a public attribute wakes every production system of the world.
    """

    wall = False
    """Whether nobody can move in here."""

    x: int
    """The column, from 0 at the left."""
    y: int
    """The row, from 0 at the top."""
    agents: list[Any]
    """The agents whose bodies stand here, in the order they came."""
    _world: World | None = None

    def load(self, char: str) -> None:
        """Sets the cell up as its character of the map says; for subclasses. A `#` is a wall."""
        self.wall = char == "#"

    @property
    def world(self) -> World:
        """The world that the cell is part of.

        Raises:
            GridError: If it is part of none.
        """
        if self._world is None:
            raise GridError("this cell is part of no world; a world makes its cells itself")
        return self._world

    @property
    def neighbour(self) -> list[Cell]:
        """The cell in each of the world's directions; beyond the edge of the map there is wall."""
        world = self.world
        return [world._neighbour(self, 8 * i // world.directions) for i in range(world.directions)]

    neighbours = neighbour

    def __setattr__(self, key: str, value: Any) -> None:
        object.__setattr__(self, key, value)
        if key[0] != "_" and self._world is not None:
            self._world._cell_changed(self, key, value)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.x},{self.y}>" if self._world is not None else f"<{type(self).__name__}>"


class World(Model):
    """A map of cells, and the agents in it.

    Args:
        cell: The class of its cells.
        width: How many columns; as many as the map has unless given.
        height: How many rows; as many as the map has unless given.
        directions: How many ways there are to face and to go: 4, or 8 with the diagonals.
        filename: A text file with the map.
        map: The map: one character a cell, one line a row. Empty lines before and after it do not count, and lines
            that are shorter than others are filled up with spaces.
        log: As for every model.
        attrs: Become attributes.

    Raises:
        GridError: If there is neither a map nor a size, or they contradict each other.
    """

    def __init__(
        self,
        cell: type[Cell] | None = None,
        width: int | None = None,
        height: int | None = None,
        directions: int = 8,
        filename: str | Path | None = None,
        map: str | None = None,
        log: Any = None,
        **attrs: Any,
    ) -> None:
        kind: Any = Cell if cell is None else cell
        if not (isinstance(kind, type) and issubclass(kind, Cell)):
            raise GridError(f"World.cell: must be a class derived from grid.Cell (got {kind!r})")
        if directions not in (4, 8):
            raise GridError(f"World.directions: must be 4 or 8 (got {directions!r})")
        if map is not None and filename is not None:
            raise GridError("World: give a map or a filename, not both")
        if filename is not None:
            map = _read_map(filename)
        rows = _rows(map, width, height)
        self.directions = directions
        self.width = len(rows[0])
        self.height = len(rows)
        self.agents: list[Any] = []
        self._bodies: list[Body] = []
        self._kind: type[Cell] = kind
        self._outside: dict[tuple[int, int], Cell] = {}
        self.grid = [[self._make(x, y) for x in range(self.width)] for y in range(self.height)]
        if map is not None:
            for place in self.cells:
                place.load(rows[place.y][place.x])
        super().__init__(log, **attrs)

    def _make(self, x: int, y: int) -> Cell:
        cell = self._kind()
        cell.__dict__.update(x=x, y=y, agents=[], _world=self)
        return cell

    # -- cells

    @property
    def cells(self) -> list[Cell]:
        """Every cell, row by row."""
        return [cell for row in self.grid for cell in row]

    def get_cell(self, x: int, y: int) -> Cell:
        """Returns the cell in column `x` of row `y`.

        Raises:
            GridError: If there is no such cell.
        """
        x, y = _whole(x, "x"), _whole(y, "y")
        if 0 <= x < self.width and 0 <= y < self.height:
            return self.grid[y][x]
        raise GridError(f"no cell ({x}, {y}): the world has x from 0 to {self.width - 1} and y from 0 to {self.height - 1}")

    getCell = get_cell  # noqa: N815

    def _neighbour(self, cell: Cell, eighth: int) -> Cell:
        """Returns the next cell in a direction counted in eighths of a turn; one of wall beyond the edge."""
        dx, dy = COMPASS[eighth % 8]
        x, y = cell.x + dx, cell.y + dy
        if 0 <= x < self.width and 0 <= y < self.height:
            return self.grid[y][x]
        if (x, y) not in self._outside:
            beyond = self._outside[x, y] = self._make(x, y)
            beyond.__dict__["wall"] = True
        return self._outside[x, y]

    def _cell_changed(self, cell: Cell, key: str, value: Any) -> None:
        """Wakes whoever may look at a cell that has changed."""
        if not self._converted:
            return
        for model in (self, *self._bodies):
            above: Model | None = model
            while above is not None and above._converted:
                above.sch.trigger(above.changes, priority=-1)
                above = above.parent
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, self._path_of(f"cell({cell.x},{cell.y})"), "state", {key: traceable(value)})

    # -- agents

    def add(
        self,
        agent: object,
        x: int | None = None,
        y: int | None = None,
        dir: int = 0,
        color: str | None = None,
        cell: Cell | None = None,
    ) -> None:
        """Puts an agent's body into a cell, and the agent into the world unless it is part of another model.

        Args:
            agent: The agent; one without a body is given one. Several may stand in one cell.
            x: The column; with no place given a cell without walls and agents is chosen at random.
            y: The row.
            dir: Where it faces: 0 is north (up), then clockwise.
            color: The colour it is drawn in.
            cell: The cell, instead of `x` and `y`.

        Raises:
            GridError: If there is no such place, no free cell, or the agent is in a world already.
        """
        if not isinstance(agent, Model):
            raise GridError(f"World.add: an agent must be a model (got {agent!r})")
        self._ensure_converted()
        if agent.__dict__.get("parent") is None:
            setattr(self, self._free_name(), agent)
        agent._ensure_converted()
        body = _body_of(agent)
        if body._cell is not None:
            raise GridError(f"this agent stands in a world already, at {body._cell!r}")
        cell = self._cell_for(x, y, cell)
        if cell.wall:
            warn_modeller(f"an agent is put into a wall, at ({cell.x}, {cell.y})")
        self.agents.append(agent)
        self._bodies.append(body)
        if color is not None:
            body.color = color
        body.__dict__["_agent"] = agent
        body._place(cell)
        body.dir = dir

    def _free_name(self) -> str:
        """Returns the attribute that the next agent gets: agent, agent2, agent3."""
        number = 1
        while (name := "agent" if number == 1 else f"agent{number}") in self.__dict__:
            number += 1
        return name

    def _cell_for(self, x: int | None, y: int | None, cell: Cell | None) -> Cell:
        """Returns the cell that `add` was given a place for, or a free one."""
        if (x is None) != (y is None):
            raise GridError(f"World.add: give both x and y, or neither (got x={x!r}, y={y!r})")
        if x is not None and y is not None:
            return self.get_cell(x, y)
        if cell is None:
            return self._free_cell()
        if cell._world is not self:
            raise GridError(f"World.add: {cell!r} is no cell of this world")
        return cell

    def _free_cell(self) -> Cell:
        free = [cell for cell in self.cells if not cell.wall and not cell.agents]
        if not free:
            raise GridError("World.add: every cell is a wall or has an agent in it")
        return self.random.choice(free)


def _body_of(agent: Model) -> Body:
    """Returns the agent's body: itself, its attribute `body`, or another attribute that is one; a new one where it has none."""
    if isinstance(agent, Body):
        return agent
    given = agent.__dict__.get("body")
    for part in (given, *agent._members()):
        if isinstance(part, Body):
            return part
    if given is not None:
        raise GridError(f"World.add: the agent's 'body' must be a grid.Body() (got {given!r})")
    body = Body()
    setattr(agent, "body", body)  # noqa: B010 - an attribute that models of this kind do not declare
    return body


def _whole(value: object, what: str) -> int:
    try:
        return operator.index(cast("int", value))
    except TypeError:
        raise GridError(f"{what} must be a whole number (got {value!r})") from None


def _rows(map: str | None, width: int | None, height: int | None) -> list[str]:
    """Returns the map's lines, all of one length; of spaces where there is only a size."""
    if map is None and (width is None or height is None):
        raise GridError("World: give a map, or a width and a height")
    lines = [] if map is None else map.splitlines()
    while lines and not lines[0].strip():
        del lines[0]
    while lines and not lines[-1].strip():
        del lines[-1]
    if map is not None and not lines:
        raise GridError("World: the map is empty")
    columns = max(map_width := max((len(line.rstrip()) for line in lines), default=0), 1)
    for name, wanted, least in (("width", width, map_width), ("height", height, len(lines))):
        if wanted is not None and _whole(wanted, f"World.{name}") < max(least, 1):
            raise GridError(f"World.{name}: must be at least {max(least, 1)} (got {wanted})")
    columns = columns if width is None else width
    lines += [""] * ((height or 0) - len(lines))
    return [line[:columns].ljust(columns) for line in lines]


def _read_map(filename: str | Path) -> str:
    """Reads a map from a file of the present folder, or from one beside the model file."""
    path = Path(filename)
    program = getattr(sys.modules.get("__main__"), "__file__", None)
    places = [path] if program is None else [path, Path(program).parent / path]
    for place in places:
        if place.is_file():
            try:
                return place.read_text(encoding="utf-8-sig")
            except UnicodeDecodeError as error:
                raise GridError(f"the map file '{place}' is no text: {error}") from None
    folder = places[-1].parent
    near = [p.name for p in folder.iterdir()] if folder.is_dir() else []
    raise GridError(f"no map file '{filename}'{did_you_mean(path.name, near)}")


__all__ = ["Body", "Cell", "World"]
