"""Grid worlds: rectangular maps of cells, and the agents' bodies that turn and move in them."""

from __future__ import annotations

import operator
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

from actr3d.actr.kernel.model import Model, ensure_converted, is_converted
from actr3d.actr.kernel.read_attributes import reads
from actr3d.actr.kernel.tracing import traceable
from actr3d.actr.kernel.tree import children_of, path_within
from actr3d.errors import GridError, did_you_mean
from actr3d.warnings import warn_modeller

COMPASS = ((0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1))
"""The steps (x, y) to the eight neighbours, clockwise from north; y grows downwards, as the lines of a map do."""

NO_WORLD = "this cell is part of no world; a world makes its cells itself"


class Cell:
    """One cell of a grid world; models derive their own class, with attributes that productions match and actions change.

    Setting a public attribute wakes every production system of the world.
    """

    wall = False
    """Whether the cell cannot be entered."""

    x: int
    """The column, from 0 at the left."""
    y: int
    """The row, from 0 at the top."""
    agents: list[Any]
    """The agents whose bodies are here, in the order in which they arrived."""
    _world: World | None = None
    _find: Callable[[Cell, int], Cell] | None = None
    """Finds a neighbouring cell in the world; None before the cell is in one."""
    _report: Callable[[Cell, str, Any], None] | None = None
    """Reports a change to the world; None before the cell is in one."""

    def load(self, char: str) -> None:
        """Initializes the cell from its character of the map; for subclasses. A `#` is a wall."""
        self.wall = char == "#"

    @property
    def world(self) -> World:
        """The world of the cell.

        Raises:
            GridError: If it has none.
        """
        if self._world is None:
            raise GridError(NO_WORLD)
        return self._world

    @property
    def neighbour(self) -> list[Cell]:
        """The neighbouring cell in each of the world's directions; a wall beyond the edge of the map."""
        directions = self.world.directions
        return [self.neighbour_at(8 * i // directions) for i in range(directions)]

    neighbours = neighbour

    def neighbour_at(self, eighths: int) -> Cell:
        """Returns the neighbouring cell in a direction, given in eighths of a turn clockwise from north; a wall beyond the edge.

        Raises:
            GridError: If the cell is in no world.
        """
        if self._find is None:
            raise GridError(NO_WORLD)
        return self._find(self, eighths)

    def __setattr__(self, key: str, value: Any) -> None:
        object.__setattr__(self, key, value)
        if key[0] != "_" and self._report is not None:
            self._report(self, key, value)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.x},{self.y}>" if self._world is not None else f"<{type(self).__name__}>"


class NotPlacedError(GridError, AttributeError):
    """A body is in no world yet; patterns that test its place do not match."""


@reads("body", "x", "y")
class Body(Model):
    """An agent's body in a grid world; `World.add` gives it its place.

    Directions are whole numbers from 0 (north, up) clockwise; with 8 directions 1 is north-east, with 4 it is east.
    Every movement returns whether it was complete: a wall, or the edge of the map, stops it.

    Models of Python ACT-R import it as `ccm.lib.grid.Body`; it has nothing to do with `actr3d.world.Body`, a body in the physical world.
    """

    color: str | None = None
    """The colour in which it is drawn; None for the viewer's default."""
    x: int
    """The column, from 0 at the left."""
    y: int
    """The row, from 0 at the top."""
    dir: int
    """The direction that it faces."""
    _cell: Cell | None = None
    _agent: Any = None

    def __setattr__(self, key: str, value: Any) -> None:
        if key in ("x", "y") and self._cell is not None:
            x, y = (value, self.y) if key == "x" else (self.x, value)
            self._place(self.world.get_cell(x, y))
        elif key == "dir" and self._cell is not None:
            value = _whole(value, "dir") % self.world.directions
            if value != self.__dict__.get("dir"):
                super().__setattr__(key, value)
        else:
            super().__setattr__(key, value)

    def _place(self, cell: Cell) -> None:
        """Moves the body to a cell."""
        before = self._cell
        if before is not None:
            before.agents.remove(self._agent)
        self._cell = cell
        cell.agents.append(self._agent)
        if before is None or before.x != cell.x:
            super().__setattr__("x", cell.x)
        if before is None or before.y != cell.y:
            super().__setattr__("y", cell.y)

    # -- the place and the cells around

    @property
    def cell(self) -> Cell:
        """The cell of the body.

        Raises:
            GridError: If it is in no world.
        """
        if self._cell is None:
            raise NotPlacedError("this body is in no world; put its agent into one with world.add(agent)")
        return self._cell

    @property
    def world(self) -> World:
        """The world of the body.

        Raises:
            GridError: If it is in no world.
        """
        return self.cell.world

    def _seen(self, eighths: int) -> Cell:
        """Returns the neighbouring cell in a direction, given in eighths of a turn to the right of ahead."""
        return self.cell.neighbour_at(8 * self.dir // self.world.directions + eighths)

    @property
    def ahead_cell(self) -> Cell:
        """The cell in front of it."""
        return self._seen(0)

    @property
    def left_cell(self) -> Cell:
        """The cell it would face after one turn to the left."""
        return self._seen(-8 // self.world.directions)

    @property
    def right_cell(self) -> Cell:
        """The cell it would face after one turn to the right."""
        return self._seen(8 // self.world.directions)

    @property
    def left45_cell(self) -> Cell:
        """The cell diagonally in front of it, on the left."""
        return self._seen(-1)

    @property
    def right45_cell(self) -> Cell:
        """The cell diagonally in front of it, on the right."""
        return self._seen(1)

    @property
    def left90_cell(self) -> Cell:
        """The cell to its left."""
        return self._seen(-2)

    @property
    def right90_cell(self) -> Cell:
        """The cell to its right."""
        return self._seen(2)

    @property
    def back_cell(self) -> Cell:
        """The cell behind it."""
        return self._seen(4)

    # -- moving

    def turn(self, amount: int) -> None:
        """Turns clockwise by a number of directions; counter-clockwise if it is negative.

        Raises:
            GridError: If it is in no world.
        """
        directions = self.world.directions
        self.dir = (self.dir + _whole(amount, "turn")) % directions

    def turn_left(self, amount: int = 1) -> None:
        """Turns counter-clockwise by a number of directions."""
        self.turn(-amount)

    def turn_right(self, amount: int = 1) -> None:
        """Turns clockwise by a number of directions."""
        self.turn(amount)

    def turn_around(self) -> None:
        """Turns around."""
        self.turn(self.world.directions // 2)

    def go_in_direction(self, dir: int) -> bool:
        """Moves one cell in a direction, without turning; returns whether it moved.

        Raises:
            GridError: If it is in no world.
        """
        ahead = self.cell.neighbour_at(8 * _whole(dir, "dir") // self.world.directions)
        if ahead.wall:
            return False
        self._place(ahead)
        return True

    def go_forward(self, dist: int = 1) -> bool:
        """Moves a number of cells ahead, or up to a wall; returns whether it moved all the way.

        Raises:
            GridError: If it is in no world.
        """
        directions = self.world.directions
        return all(self.go_in_direction(self.dir % directions) for _ in range(_whole(dist, "dist")))

    def go_backward(self, dist: int = 1) -> bool:
        """Moves a number of cells backwards, or up to a wall, without turning; returns whether it moved all the way.

        Raises:
            GridError: If it is in no world.
        """
        back = self.world.directions // 2
        return all(self.go_in_direction(self.dir + back) for _ in range(_whole(dist, "dist")))

    def go_towards(self, target: Any, y: int | None = None) -> bool:
        """Turns to the free neighbouring cell that is nearest to a target, and enters it; of equally near ones the first clockwise.

        It plans only one step, so a wall in between may make it move back and forth.

        Args:
            target: A column, with the row in `y`; or a cell, a body, an agent with a body, or a pair (column, row).
            y: The row.

        Returns:
            Whether it moved: False if it is there already, or surrounded by walls.

        Raises:
            GridError: If it is in no world, or the target has no place.
        """
        goal = self._target(target, y)
        here = self.cell
        if here is goal:
            return False
        free = [(dir, cell) for dir, cell in enumerate(here.neighbour) if not cell.wall]
        if not free:
            return False
        dir, _ = min(free, key=lambda choice: (choice[1].x - goal.x) ** 2 + (choice[1].y - goal.y) ** 2)
        self.dir = dir
        return self.go_in_direction(dir)

    def _target(self, target: Any, y: int | None) -> Cell:
        if y is not None:
            return self.world.get_cell(target, y)
        thing: Any = target
        if type(thing) in (tuple, list) and len(thing) == 2:
            return self.world.get_cell(*thing)
        if not hasattr(thing, "x") and hasattr(thing, "body"):
            thing = thing.body
        if hasattr(thing, "x") and hasattr(thing, "y"):
            return self.world.get_cell(thing.x, thing.y)
        raise GridError(f"go_towards: give a column and a row, or something that has a place in the world (got {target!r})")

    # -- the spelling of older models

    aheadCell = ahead_cell  # noqa: N815
    leftCell = left_cell  # noqa: N815
    rightCell = right_cell  # noqa: N815
    left45Cell = left45_cell  # noqa: N815
    right45Cell = right45_cell  # noqa: N815
    left90Cell = left90_cell  # noqa: N815
    right90Cell = right90_cell  # noqa: N815
    backCell = back_cell  # noqa: N815
    turnLeft = turn_left  # noqa: N815
    turnRight = turn_right  # noqa: N815
    turnAround = turn_around  # noqa: N815
    goForward = go_forward  # noqa: N815
    goBackward = go_backward  # noqa: N815
    goTowards = go_towards  # noqa: N815
    goInDirection = go_in_direction  # noqa: N815


class World(Model):
    """A map of cells, and the agents in it.

    Models of Python ACT-R import it as `ccm.lib.grid.World`; it has nothing to do with `actr3d.world.World`, the physical world.

    Args:
        cell: The class of its cells.
        width: The number of columns; by default that of the map.
        height: The number of rows; by default that of the map.
        directions: The number of directions: 4, or 8 with the diagonals.
        filename: A text file with the map.
        map: The map: one character per cell, one line per row. Empty lines before and after it are ignored, and short lines are
            filled with spaces.
        log: As in every model.
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
        cell.__dict__.update(x=x, y=y, agents=[], _world=self, _find=self._neighbour, _report=self._cell_changed)
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
        """Returns the neighbouring cell in a direction, given in eighths of a turn; a wall beyond the edge."""
        dx, dy = COMPASS[eighth % 8]
        x, y = cell.x + dx, cell.y + dy
        if 0 <= x < self.width and 0 <= y < self.height:
            return self.grid[y][x]
        if (x, y) not in self._outside:
            beyond = self._outside[x, y] = self._make(x, y)
            beyond.__dict__["wall"] = True
        return self._outside[x, y]

    def _cell_changed(self, cell: Cell, key: str, value: Any) -> None:
        """Wakes everything that may depend on a cell that has changed."""
        if not self._converted:
            return
        for model in (self, *self._bodies):
            above: Model | None = model
            while above is not None and is_converted(above):
                above.sch.trigger(above.changes, priority=-1)
                above = above.parent
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, path_within(self, f"cell({cell.x},{cell.y})"), "state", {key: traceable(value)})

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
            agent: The agent; if it has no body, it gets one. Several may be in one cell.
            x: The column; without any place, a cell without walls and agents is chosen at random.
            y: The row.
            dir: The direction that it faces: 0 is north (up), then clockwise.
            color: The colour in which it is drawn.
            cell: The cell, instead of `x` and `y`.

        Raises:
            GridError: If there is no such place, no free cell, or the agent is in a world already.
        """
        if not isinstance(agent, Model):
            raise GridError(f"World.add: an agent must be a model (got {agent!r})")
        ensure_converted(self)
        if agent.__dict__.get("parent") is None:
            setattr(self, self._free_name(), agent)
        ensure_converted(agent)
        body = _body_of(agent)
        place = getattr(body, "cell", None)
        if place is not None:
            raise GridError(f"this agent is in a world already, at {place!r}")
        cell = self._cell_for(x, y, cell)
        if cell.wall:
            warn_modeller(f"an agent is put into a wall, at ({cell.x}, {cell.y})")
        self.agents.append(agent)
        self._bodies.append(body)
        if color is not None:
            body.color = color
        body.__dict__["_agent"] = agent
        body._place(cell)  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model
        body.dir = dir

    def _free_name(self) -> str:
        """Returns the name of the next agent: agent, agent2, agent3."""
        number = 1
        while (name := "agent" if number == 1 else f"agent{number}") in self.__dict__:
            number += 1
        return name

    def _cell_for(self, x: int | None, y: int | None, cell: Cell | None) -> Cell:
        """Returns the cell given by the arguments of `add`, or a free one."""
        if (x is None) != (y is None):
            raise GridError(f"World.add: give both x and y, or neither (got x={x!r}, y={y!r})")
        if x is not None and y is not None:
            return self.get_cell(x, y)
        if cell is None:
            return self._free_cell()
        if cell.world is not self:
            raise GridError(f"World.add: {cell!r} is not a cell of this world")
        return cell

    def _free_cell(self) -> Cell:
        free = [cell for cell in self.cells if not cell.wall and not cell.agents]
        if not free:
            raise GridError("World.add: every cell is a wall or has an agent in it")
        return self.random.choice(free)


def _body_of(agent: Model) -> Body:
    """Returns the agent's body: itself, its attribute `body`, or another attribute that is one; otherwise a new one."""
    if isinstance(agent, Body):
        return agent
    given = agent.__dict__.get("body")
    for part in (given, *children_of(agent)):
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
    """Returns the map's lines, padded to equal length; lines of spaces if only a size is given."""
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
            raise GridError(f"World.{name}: must be >= {max(least, 1)} (got {wanted})")
    columns = columns if width is None else width
    lines += [""] * ((height or 0) - len(lines))
    return [line[:columns].ljust(columns) for line in lines]


def _read_map(filename: str | Path) -> str:
    """Reads a map from a file in the current folder, or from one beside the model file."""
    path = Path(filename)
    program = getattr(sys.modules.get("__main__"), "__file__", None)
    places = [path] if program is None else [path, Path(program).parent / path]
    for place in places:
        if place.is_file():
            try:
                return place.read_text(encoding="utf-8-sig")
            except UnicodeDecodeError as error:
                raise GridError(f"the map file '{place}' is not text: {error}") from None
    folder = places[-1].parent
    near = [p.name for p in folder.iterdir()] if folder.is_dir() else []
    raise GridError(f"no map file '{filename}'{did_you_mean(path.name, near)}")


__all__ = ["Body", "Cell", "World"]
