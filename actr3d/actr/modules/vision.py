"""Vision: finds locations and objects; attention is drawn to new objects."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.chunks.pattern import Pattern
from actr3d.actr.declarative.finst import Finst
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.hooks import hook
from actr3d.actr.kernel.log import log_line
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.parameters import ELSEWHERE, WithParameters, named_parameters
from actr3d.actr.kernel.read_attributes import reads
from actr3d.actr.kernel.tree import environment_of
from actr3d.actr.modules.registry import module


@module
@reads("visible", "x", "y")
class Vision(WithParameters, Model):
    """Sees the objects of the environment that have `x` and `y`, unless their `visible` is False.

    A new object's place is put into the location buffer automatically while that is empty.

    This is the module of Python ACT-R, for agents without a body. `from actr3d.vision import Vision` after
    `from actr3d.actr import *` replaces it with the module that sees with the eye of a body in a physical world.

    Args:
        visual: The buffer for what is seen.
        location: The buffer for where it is, as `'x y'`.

    Source: ACT-R's onset span of 0.5 s, and 0.085 s for an attention shift.
    """

    @named_parameters
    def __init__(self, visual: Buffer, location: Buffer) -> None:
        self._visual = visual
        self._location = location
        self.busy = False
        self.lastLocationPattern = Pattern("")
        self.tracking: Any = None
        self.timeAppeared: dict[Any, float] = {}
        self.visualOnsetSpan = 0.5
        self.finst = Finst(self)

    def start(self) -> None:
        """Starts watching the environment."""
        self.environmentUpdate()

    def isNew(self, obj: Any) -> bool:  # noqa: N802 - Python ACT-R's names, here and below
        """Returns whether an object appeared within the onset span; records the time of a new one."""
        if not getattr(obj, "visible", True):
            return False
        appeared = self.timeAppeared.get(obj)
        if appeared is None:
            self.timeAppeared[obj] = self.now()
            return True
        return self.now() < appeared + self.visualOnsetSpan

    @hook
    def environmentUpdate(self) -> Iterator[Any]:  # noqa: N802
        """Puts a new object's place into the empty location buffer, at every change of the environment."""
        environment = environment_of(self)
        if environment is None:
            return
        while True:
            if self._location.isEmpty():
                new = [obj for obj in environment.get_children() if self._appears(obj)]
                if new:
                    obj: Any = self.random.choice(new)
                    log_line(self.log, f"Vision stuffed obj at ({obj.x:g},{obj.y:g})")
                    self._location.set(f"{obj.x:g} {obj.y:g}")
            for obj in environment.get_children():
                self.isNew(obj)
            yield environment.changes, self.lostTrack

    def _appears(self, obj: Any) -> bool:
        if not getattr(obj, "visible", True):
            self.timeAppeared.pop(obj, None)
            return False
        return obj not in self.timeAppeared and hasattr(obj, "x") and hasattr(obj, "y")

    @hook
    def lostTrack(self) -> None:  # noqa: N802
        """Ends the tracking of an object that is gone."""
        if self.tracking is not None:
            self.tracking = None
            log_line(self.log, "Object disappeared")
            self._visual.clear()

    def attendToUnattended(self, pattern: Any = "") -> None:  # noqa: N802
        """Finds the place of an object that was not examined recently."""
        self.attendTo(pattern, unattended=True)

    def attendToNew(self, pattern: Any = "") -> None:  # noqa: N802
        """Finds the place of an object that has just appeared."""
        self.attendTo(pattern, new=True)

    def attendTo(self, pattern: Any, unattended: bool = False, new: bool = False) -> None:  # noqa: N802
        """Puts the place of a matching object into the location buffer, if there is one."""
        # Setting this attribute is a change, like any other, that wakes everything that waits for one.
        matcher = self.lastLocationPattern = self._pattern(pattern)
        self._trace_request("attendTo", pattern=pattern, unattended=unattended, new=new)
        found: list[Any] = []
        for obj in self._visible():
            if new and not self.isNew(obj):
                continue
            if unattended and self.finst.contains(obj):
                continue
            if matcher.match(obj) is not None:
                found.append(obj)
        if found:
            obj = self.random.choice(found)
            log_line(self.log, f"Vision found obj at ({obj.x:g},{obj.y:g})")
            self._location.set(f"{obj.x:g} {obj.y:g}")

    def examine(self, pat: Any) -> Iterator[float]:
        """Puts the first matching object into the visual buffer, after 0.085 s; `'x y'` names a place."""
        matcher = self.lastExamine = self._pattern(pat)
        self._trace_request("examine", pattern=pat)
        for obj in self._visible():
            if matcher.match(obj) is None:
                continue
            self.busy = True
            yield 0.085
            self.busy = False
            if any(child is obj for child in self._children_of_environment()):
                self.tracking = obj
                log_line(self.log, f"Vision sees {Chunk(obj)}")
                self._visual.set(obj)
                self.finst.add(obj)
            else:
                self.tracking = None
                log_line(self.log, "Vision sees nothing")
                self._visual.clear()
            break

    def _pattern(self, pattern: Any) -> Pattern:
        if isinstance(pattern, str) and ":" not in pattern and pattern.count(" ") == 1:
            pattern = "x:{} y:{}".format(*pattern.split(" "))
        return Pattern(pattern, self.sch.bound)

    def _children_of_environment(self) -> list[Model]:
        environment = environment_of(self)
        return environment.get_children() if environment is not None else []

    def _visible(self) -> list[Any]:
        return [o for o in self._children_of_environment() if hasattr(o, "x") and hasattr(o, "y") and getattr(o, "visible", True)]


ELSEWHERE[Vision] = "for an agent with a body: from actr3d.vision import Vision, after from actr3d.actr import *"
