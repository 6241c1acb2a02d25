"""Bodies in grid worlds: where an agent stands and faces, what is around it, and how it moves."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any, cast

from actr3d.actr.model import Model
from actr3d.errors import GridError

if TYPE_CHECKING:
    from actr3d.actr.grid import Cell, World


class NotPlacedError(GridError, AttributeError):
    """A body stands in no world yet; patterns that look at its place do not match."""


class Body(Model):
    """An agent's body in a grid world; it is given its place by `World.add`.

    Directions are whole numbers from 0 (north, up) clockwise; with 8 directions 1 is north-east, with 4 it is east.
    Every way of moving returns whether it moved as far as asked: a wall, or the edge of the map, stops it.
    """

    color: str | None = None
    """The colour it is drawn in; None for the viewer's own choice."""
    x: int
    """The column it stands in, from 0 at the left."""
    y: int
    """The row it stands in, from 0 at the top."""
    dir: int
    """Where it faces."""
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
        """Puts the body into a cell, wherever it was before."""
        before = self._cell
        if before is not None:
            before.agents.remove(self._agent)
        self._cell = cell
        cell.agents.append(self._agent)
        if before is None or before.x != cell.x:
            super().__setattr__("x", cell.x)
        if before is None or before.y != cell.y:
            super().__setattr__("y", cell.y)

    # -- where it is and what is around it

    @property
    def cell(self) -> Cell:
        """The cell it stands in.

        Raises:
            GridError: If it stands in no world.
        """
        if self._cell is None:
            raise NotPlacedError("this body stands in no world; put its agent into one with world.add(agent)")
        return self._cell

    @property
    def world(self) -> World:
        """The world it stands in.

        Raises:
            GridError: If it stands in no world.
        """
        return self.cell.world

    def _seen(self, eighths: int) -> Cell:
        """Returns the next cell, so many eighths of a turn to the right of ahead."""
        world = self.world
        return world._neighbour(self.cell, 8 * self.dir // world.directions + eighths)  # pyright: ignore[reportPrivateUsage]

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
        """Turns clockwise by so many directions; counter-clockwise where negative.

        Raises:
            GridError: If it stands in no world.
        """
        directions = self.world.directions
        self.dir = (self.dir + _whole(amount, "turn")) % directions

    def turn_left(self, amount: int = 1) -> None:
        """Turns counter-clockwise by so many directions."""
        self.turn(-amount)

    def turn_right(self, amount: int = 1) -> None:
        """Turns clockwise by so many directions."""
        self.turn(amount)

    def turn_around(self) -> None:
        """Turns to face the other way."""
        self.turn(self.world.directions // 2)

    def go_in_direction(self, dir: int) -> bool:
        """Moves one cell in a direction, without turning; returns whether it moved.

        Raises:
            GridError: If it stands in no world.
        """
        world = self.world
        ahead = world._neighbour(self.cell, 8 * _whole(dir, "dir") // world.directions)  # pyright: ignore[reportPrivateUsage]
        if ahead.wall:
            return False
        self._place(ahead)
        return True

    def go_forward(self, dist: int = 1) -> bool:
        """Moves so many cells ahead, or up to a wall; returns whether it moved all the way.

        Raises:
            GridError: If it stands in no world.
        """
        directions = self.world.directions
        return all(self.go_in_direction(self.dir % directions) for _ in range(_whole(dist, "dist")))

    def go_backward(self, dist: int = 1) -> bool:
        """Moves so many cells backwards, or up to a wall, without turning; returns whether it moved all the way.

        Raises:
            GridError: If it stands in no world.
        """
        back = self.world.directions // 2
        return all(self.go_in_direction(self.dir + back) for _ in range(_whole(dist, "dist")))

    def go_towards(self, target: Any, y: int | None = None) -> bool:
        """Turns to, and moves into, the free neighbouring cell that is nearest to a target; of equally near ones the first clockwise.

        It sees one step ahead only, so a wall between may keep it going to and fro.

        Args:
            target: A column, with the row in `y`; or a cell, a body, an agent with a body, or a pair (column, row).
            y: The row.

        Returns:
            Whether it moved: not where it is there already, or walled in.

        Raises:
            GridError: If it stands in no world, or the target has no place.
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

    # -- as older models spell them

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


def _whole(value: object, what: str) -> int:
    try:
        return operator.index(cast("int", value))
    except TypeError:
        raise GridError(f"{what} must be a whole number (got {value!r})") from None
