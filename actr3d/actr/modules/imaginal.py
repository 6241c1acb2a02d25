"""The imaginal module: builds and changes a mental image, which takes time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, cast

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.hooks import hook
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.noise import duration
from actr3d.actr.kernel.parameters import NotNegative, WithParameters, named_parameters
from actr3d.actr.modules.registry import module


@module
class ImaginalModule(WithParameters, Model):
    """Sets, changes and clears a buffer, each after a delay; calls are ignored while it is busy.

    Args:
        buffer: The buffer that it changes.
        delay: The duration of a change [s]; a number, or a function without arguments.
        delay_sd: The standard deviation of the duration [s]; None for no noise.

    Source: 0.2 s, ACT-R's imaginal delay.
    """

    @named_parameters
    def __init__(self, buffer: Buffer, delay: NotNegative | Callable[[], float] = 0.2, delay_sd: NotNegative | None = None) -> None:
        self._buffer = buffer
        self.busy = False
        self.delay = delay
        self.delay_sd = delay_sd

    @hook
    def delay_time(self) -> float:
        """Returns the duration of the next change [s]."""
        time: float = cast("Any", self.delay)() if callable(self.delay) else self.delay
        return duration(self, time, self.delay_sd)

    def set(self, chunk: Any) -> Iterator[float]:
        """Puts a new chunk into the buffer; its variables have the values that are bound now."""
        if self.busy:
            return
        new = Chunk(chunk, self.sch.bound)
        self._trace_request("set", chunk=new)
        self.busy = True
        yield self.delay_time()
        self._finish(self._buffer.set, new)

    def modify(self, **args: Any) -> Iterator[float]:
        """Changes slots of the buffer's chunk."""
        if self.busy:
            return
        self._trace_request("modify", slots=Chunk(args))
        self.busy = True
        yield self.delay_time()
        self._finish(self._buffer.modify, **args)

    def clear(self, **args: Any) -> Iterator[float]:
        """Clears the buffer."""
        if self.busy:
            return
        self._trace_request("clear")
        self.busy = True
        yield self.delay_time()
        self._finish(self._buffer.clear)

    def _finish(self, change: Callable[..., None], *args: Any, **keys: Any) -> None:
        """Changes the buffer; the module is free afterwards, even if that fails."""
        try:
            change(*args, **keys)
        finally:
            self.busy = False
