"""SOSVision: vision as a search among the objects of the environment."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from actr3d.actr.chunks.pattern import Pattern
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.noise import duration
from actr3d.actr.kernel.parameters import NotNegative, WithParameters, named_parameters
from actr3d.actr.kernel.read_attributes import reads
from actr3d.actr.kernel.tree import environment_of
from actr3d.actr.modules.registry import module


@module
@reads("salience", "value", "visible")
class SOSVision(WithParameters, Model):
    """Searches for objects that match a pattern, and puts one of those that it notices into a buffer.

    Each object of the environment (the agent's parent) that has a `salience` is noticed with that probability; one that
    has only `visible` always. Objects with `visible` False or `value` None are not found. If nothing is found, the buffer is
    cleared and `error` set.

    Args:
        buffer: The buffer for what is seen.
        delay: The duration of a search [s].
        log: Ignored; kept for existing models.
        delay_sd: The standard deviation of the duration [s]; None for no noise.

    Source: SOS Vision (West & Emond 2002).
    """

    @named_parameters
    def __init__(self, buffer: Buffer, delay: NotNegative = 0.0, log: Any = None, delay_sd: NotNegative | None = None) -> None:
        self._buffer = buffer
        self.delay = delay
        self.delay_sd = delay_sd
        self.error = False
        self.busy = False

    def request(self, pattern: Any = "") -> Iterator[float]:
        """Searches for a match, unless a search is in progress; `?name` matches anything, as in python_actr 1.9.5."""
        if self.busy:
            return
        matcher = Pattern(pattern)
        self.error = False
        noticed = [obj for obj in self._objects() if matcher.match(obj) is not None and self._notices(obj)]
        self._trace_request("request", pattern=pattern, noticed=noticed)
        self.busy = True
        yield duration(self, self.delay, self.delay_sd)
        self.busy = False
        seen = self.random.choice(noticed) if noticed else None
        if seen is None or not any(obj is seen for obj in self._objects()) or getattr(seen, "visible", True) == False:  # noqa: E712
            self._buffer.clear()
            self.error = True
        else:
            self._buffer.set(seen)

    def _objects(self) -> list[Any]:
        environment = environment_of(self)
        return list(environment.get_children()) if environment is not None else []

    def _notices(self, obj: Any) -> bool:
        if not hasattr(obj, "salience") and not hasattr(obj, "visible"):
            return False
        if hasattr(obj, "salience") and self.random.random() > obj.salience:
            return False
        if hasattr(obj, "visible") and obj.visible == False:  # noqa: E712 - 0 is not visible either
            return False
        return not hasattr(obj, "value") or obj.value is not None
