"""How models join a tree, and leave it."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, cast

from actr3d.actr.scheduler import Scheduler
from actr3d.actr.traced import TracedPart
from actr3d.errors import SchedulerError

if TYPE_CHECKING:
    from actr3d.actr.model import Model


class Joining(TracedPart):
    """A part that others can join, and that can join others."""

    random: random.Random
    _converted: bool

    def _leave(self, parent: Model) -> None:
        """Takes the model out of its parent's children; a trace knows it by its old path for as long as it has no new one."""
        self._keep_path()
        siblings = parent.__dict__.get("_children", {})
        if parent.__dict__.get("_overlooked") is self:
            del parent.__dict__["_overlooked"]
        for name in [name for name, part in siblings.items() if part is self]:
            del siblings[name]
            if parent._converted:
                parent._trace_member("removed", name, self)

    def _take_in(self, key: str, value: Model, *, overlooked: bool = False) -> bool:
        """Makes a model that was set as an attribute a child, unless it has a parent or is an ancestor; tells whether it did.

        Args:
            key: The attribute's name.
            value: The model.
            overlooked: Whether `get_children` is to leave it out, and chunks made of it the name it is set under.
        """
        if value.__dict__.get("parent") is not None or any(above is value for above in self._line()):
            return False
        apart = value._converted and value.sch is not self.sch
        run = {"was": value._path} if apart and value.sch.trace is self.sch.trace else {}
        replaced = self.__dict__.get("_children", {}).get(key)
        value._note_move(self.sch)
        value.parent = cast("Model", self)
        if not overlooked:
            value._call_joined(key)
        elif "name" not in value.__dict__:
            value._call(key)
        self._adopted(key, value)
        if overlooked:
            self.__dict__["_overlooked"] = value
        value._forget_place()
        if replaced is not None:
            self._trace_member("removed", key, replaced)
        self._trace_member("added", key, value, **run)
        if not value._converted:
            value._convert(cast("Model", self))
        else:
            if apart:
                value._join(self.sch, self.random)
            for part in value._tree():
                part._follow(part.parent._profile if part.parent is not None else None)
        return True

    def _join(self, sch: Scheduler, numbers: random.Random) -> None:
        """Moves a tree that came to life by itself (a model that builds its parts in `__init__`) to another clock."""
        if self.sch.now_us != 0:
            raise SchedulerError(f"'{self.name}' has run by itself until {self.sch.time:g} s; put it into its environment before that")
        sch.take_over(self.sch)
        trace = self.sch.trace
        for part in self._tree():
            part.__dict__["sch"], part.__dict__["random"] = sch, numbers
        if trace is not None and sch.trace is None:
            *_, top = self._line()
            top._attach_trace(trace)
