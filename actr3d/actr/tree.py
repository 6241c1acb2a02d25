"""The tree that the parts of a simulation form, and the names by which it is walked."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from sys import maxsize
from typing import TYPE_CHECKING, Any, NamedTuple

from actr3d.trace import Trace

if TYPE_CHECKING:
    from actr3d.actr.events import Trigger
    from actr3d.actr.model import Model
    from actr3d.actr.scheduler import Scheduler


class Move(NamedTuple):
    """A part came into a tree that was being traced, or to another place in it."""

    trace: Trace
    number: int
    """How many events the trace held then."""
    time: int
    """When [us]."""
    path: str | None
    """What its path was before; None where it was not there yet."""


class Place(NamedTuple):
    """Where a part was, while a trace was kept."""

    path: str | None
    """Its path; None where it was not there yet."""
    time: int
    """Since when [us]; -1 for since the trace began."""
    begin: int
    """The number of the first event from there."""
    end: int
    """The number of the first event after that."""


class Part:
    """A part of a tree: it has at most one parent, and children in the order they came."""

    name: str
    parent: Model | None
    _children: dict[str, Model]

    def get_children(self) -> list[Model]:
        """Returns the models that are this one's parts, in the order they came.

        For models written for python_actr, without the one that brought this one to life by joining it: python_actr 1.9.5
        overlooks it, so its visions do too.
        """
        overlooked = self.__dict__.get("_overlooked")
        return [part for part in self._members() if part is not overlooked]

    def _members(self) -> list[Model]:
        """Returns all models that are this one's parts, in the order they came."""
        return list(self.__dict__.get("_children", {}).values())

    def _adopted(self, name: str, child: Model) -> None:
        self.__dict__.setdefault("_children", {})[name] = child

    def _line(self) -> Iterator[Any]:
        """Yields the model and its ancestors."""
        part: Any = self
        while part is not None:
            yield part
            part = part.__dict__.get("parent")
            if part is self:
                break

    def _tree(self) -> Iterator[Any]:
        """Yields the model and everything below it."""
        yield self
        for child in self._members():
            yield from child._tree()

    @cached_property
    def _path(self) -> str:
        """The dotted names from below the top model down to this one; «top» for that model itself.

        Below the top model of a trace's second run they begin with `top#2`. A part that has left the tree keeps its path.
        """
        names: list[str] = []
        part: Any = self
        while (above := part.__dict__.get("parent")) is not None and len(names) < 64:
            names.append(part.name)
            part = above
        top = part.__dict__.get("_top_path", "top")
        if top != "top" or not names:
            names.append(top)
        return ".".join(reversed(names))

    def _path_of(self, name: str) -> str:
        """Returns the path of something below this part that is no part itself."""
        return name if self._path == "top" else f"{self._path}.{name}"

    def _line_changes(self) -> tuple[Trigger, ...]:
        """Returns what wakes those who wait for a change of this model or of an ancestor, whose part it is."""
        known = self.__dict__.get("_known_line_changes")
        if known is None:
            known = self.__dict__["_known_line_changes"] = tuple([part.changes for part in self._line()])
        return known

    def _keep_path(self) -> None:
        """Lets this part, and all below it, keep their paths when they leave the tree."""
        for part in self._tree():
            part.__dict__["_path"] = part._path

    def _forget_place(self, *, keep_path: bool = False) -> None:
        """Forgets what was made of the model's place in the tree, and so of that of everything below it."""
        for part in self._tree():
            part.__dict__.pop("_known_line_changes", None)
            if not keep_path:
                part.__dict__.pop("_path", None)

    # -- where it was before

    def _note_move(self, sch: Scheduler) -> None:
        """Keeps what paths are, before the part gets another place in a traced run, so that its past can be told."""
        trace = sch.trace
        if trace is not None and trace.keep:
            for part in self._tree():
                part.__dict__.setdefault("_moves", []).append(Move(trace, len(trace), sch.now_us, part.__dict__.get("_path")))

    def _places_in(self, trace: Trace) -> list[Place]:
        """Returns where a part has been while a trace was kept, in order."""
        places: list[Place] = []
        time, begin = -1, 0
        for move in self._moves_in(trace):
            places.append(Place(move.path, time, begin, move.number))
            time, begin = move.time, move.number
        return [*places, Place(self._path, time, begin, maxsize)]

    def _moves_in(self, trace: Trace) -> list[Move]:
        for part in self._line():
            moves = [move for move in part.__dict__.get("_moves", ()) if move.trace is trace]
            if moves:
                # What has no moves of its own came with its parent, and had no place before.
                return moves if part is self else moves[:1] if moves[0].path is None else []
        return []
