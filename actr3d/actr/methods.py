"""Methods of models: what happens when one is called, so that others can wait for it."""

from __future__ import annotations

from collections.abc import Callable, Generator
from types import MethodType
from typing import TYPE_CHECKING, Any

from actr3d.actr.events import Event, Trigger
from actr3d.actr.profile import Profile
from actr3d.clock import seconds
from actr3d.errors import hint_for

if TYPE_CHECKING:
    from actr3d.actr.model import Model
    from actr3d.actr.production import Production

Method = Callable[..., Any]


class MethodWrapper:
    """A method of one model; `yield model.method` waits for the end of its next call."""

    def __init__(self, obj: Model, func: Method, name: str) -> None:
        self.obj = obj
        self.func = func
        self._method = MethodType(func, obj)
        self.__name__ = name
        self.begins = Trigger(f"{name} begin")
        self.ends = Trigger(f"{name} end")

    @property
    def default_trigger(self) -> Trigger:
        """What `yield` on the method itself waits for."""
        return self.ends

    @property
    def _profile(self) -> Profile | None:
        return self.obj._profile

    def __call__(self, *args: Any, **keys: Any) -> Any:
        if self.begins.waiting:
            self.obj.sch.trigger(self.begins)
        value = self._method(*args, **keys)
        if self.ends.waiting:
            self.obj.sch.trigger(self.ends)
        return value

    def __repr__(self) -> str:
        return f"<method {self.func.__qualname__}>"


class GeneratorWrapper(MethodWrapper):
    """A generator method of one model: a call schedules it and returns the event, which can be waited for."""

    def __call__(self, *args: Any, **keys: Any) -> Event:
        sch = self.obj.sch
        return sch.begin(self._steps(args, keys, sch.firing, sch.now_us), self)

    def _steps(self, args: tuple[Any, ...], keys: dict[str, Any], caller: Production | None, called_us: int) -> Generator[Any, Any, None]:
        """Runs the method, waking whoever waits for its begin or end; an error in it names its caller and when that was [us]."""
        if self.begins.waiting:
            self.obj.sch.trigger(self.begins)
        try:
            yield from self.func(self.obj, *args, **keys)
        except Exception as error:
            if caller is not None:
                error.add_note(
                    f"in '{self.__name__}' at {self.obj.now():g} s, called by production '{caller.name}' ({caller.place}) "
                    f"at {seconds(called_us):g} s{hint_for(error, self.func.__globals__)}"
                )
            raise
        if self.ends.waiting:
            self.obj.sch.trigger(self.ends)
