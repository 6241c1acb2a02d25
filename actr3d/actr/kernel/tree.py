"""The tree that the parts of a model form: paths, ancestors, descendants, and where a part was earlier in a traced run.

These are functions, and their data private attributes, because productions see every public attribute of a model.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from sys import maxsize
from typing import Any, NamedTuple

from actr3d.trace import Trace


class TreeNode:
    """A node of the tree: it has at most one parent, and children in the order in which they were added."""

    name: str

    def get_children(self) -> list[Any]:
        """Returns the models directly below this one, in the order in which they were added.

        In models written for python_actr, the child whose attachment converted this model is left out: python_actr 1.9.5 does
        not list it, so its vision modules do not see it either.
        """
        overlooked = self.__dict__.get("_overlooked")
        return [part for part in children_of(self) if part is not overlooked]

    @cached_property
    def _path(self) -> str:
        names: list[str] = []
        part: Any = self
        while (above := part.__dict__.get("parent")) is not None and len(names) < 64:
            names.append(part.name)
            part = above
        top = part.__dict__.get("_top_path", "top")
        if top != "top" or not names:
            names.append(top)
        return ".".join(reversed(names))


class Move(NamedTuple):
    """A part entered a traced tree, or changed its place in it."""

    trace: Trace
    number: int
    """The number of events in the trace at that moment."""
    time: int
    """When [us]."""
    path: str | None
    """The path before the move; None if the part was not in the tree."""


class Place(NamedTuple):
    """A path that a part had for some time in a traced run."""

    path: str | None
    """The path; None while the part was not in the tree."""
    time: int
    """The start [us]; -1 for the start of the trace."""
    begin: int
    """The number of the first event from there."""
    end: int
    """The number of the first event after that."""


def children_of(part: TreeNode) -> list[Any]:
    """Returns the models directly below a part, in the order in which they were added."""
    return list(part.__dict__.get("_children", {}).values())


def lineage(part: TreeNode) -> Iterator[Any]:
    """Yields a part and its ancestors, up to the top model."""
    above: Any = part
    while above is not None:
        yield above
        below, above = above, above.__dict__.get("parent")
        if above is below:
            break


def environment_of(module: TreeNode) -> Any:
    """Returns the model that contains a module's agent; None if there is none."""
    agent: Any = module.__dict__.get("parent")
    return None if agent is None else agent.parent


def subtree(part: TreeNode) -> Iterator[Any]:
    """Yields a part and everything below it."""
    yield part
    for child in children_of(part):
        yield from subtree(child)


def top_of(part: TreeNode) -> Any:
    """Returns the top model of a part's tree."""
    *_, top = lineage(part)
    return top


def path_of(part: TreeNode) -> str:
    """Returns the dotted names from below the top model down to a part; «top» for the top model itself.

    Below the top model of a trace's second run they begin with `top#2`. A part that has left the tree keeps its path.
    """
    return part._path  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def path_within(part: TreeNode, name: str) -> str:
    """Returns the path of something below a part that is not a part itself."""
    path = path_of(part)
    return name if path == "top" else f"{path}.{name}"


def keep_path(part: TreeNode) -> None:
    """Fixes the paths of a part and of everything below it, before the part leaves the tree."""
    for below in subtree(part):
        path_of(below)  # from now on it is kept


def forget_place(part: TreeNode, *, keep_path: bool = False) -> None:
    """Discards what was computed from a part's place in the tree, for it and everything below it."""
    for below in subtree(part):
        below.__dict__.pop("_known_line_changes", None)
        below.__dict__.pop("_known_embodiment", None)
        if not keep_path:
            below.__dict__.pop("_path", None)


# -- earlier places


def note_move(part: TreeNode, traces: Sequence[Trace], now_us: int) -> None:
    """Records the paths of a part and of everything below it, before it gets another place in a traced run."""
    for trace in traces:
        if trace.keep:
            for below in subtree(part):
                below.__dict__.setdefault("_moves", []).append(Move(trace, len(trace), now_us, below.__dict__.get("_path")))


def places_in(part: TreeNode, trace: Trace) -> list[Place]:
    """Returns the places that a part has had since a trace began, in order."""
    places: list[Place] = []
    time, begin = -1, 0
    for move in _moves_in(part, trace):
        places.append(Place(move.path, time, begin, move.number))
        time, begin = move.time, move.number
    return [*places, Place(path_of(part), time, begin, maxsize)]


def _moves_in(part: TreeNode, trace: Trace) -> list[Move]:
    for above in lineage(part):
        moves = [move for move in above.__dict__.get("_moves", ()) if move.trace is trace]
        if moves:
            # A part without moves of its own came with its parent, and had no place before.
            return moves if above is part else moves[:1] if moves[0].path is None else []
    return []
