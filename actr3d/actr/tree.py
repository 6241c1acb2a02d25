"""The tree that the parts of a simulation form, and the names by which it is walked."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from actr3d.actr.events import Trigger
    from actr3d.actr.model import Model


class Part:
    """A part of a tree: it has at most one parent, and children in the order they came."""

    name: str
    parent: Model | None
    _children: dict[str, Model]

    def get_children(self) -> list[Model]:
        """Returns the models that are this one's parts, in the order they came."""
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
        for child in self.get_children():
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
