"""The motor module: presses keys."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from actr3d.actr.kernel.log import log_line
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.parameters import ELSEWHERE, WithParameters, named_parameters
from actr3d.actr.kernel.read_attributes import reads
from actr3d.actr.kernel.tree import environment_of
from actr3d.actr.modules.registry import module


@module
@reads("key_pressed")
class Motor(WithParameters, Model):
    """Presses keys; the environment's `key_pressed(key)` is called when the finger comes down. One press at a time.

    This is the module of Python ACT-R, for agents without a body. `from actr3d.motor import Motor` after `from actr3d.actr import *`
    replaces it with the module that moves a body in a physical world.

    Source: ACT-R's times: 0.25 s preparation, 0.05 s initiation, 0.1 s until the key is struck, 0.15 s to finish.
    """

    @named_parameters
    def __init__(self) -> None:
        self.busy = False

    def press(self, key: Any) -> Iterator[float]:
        """Presses a key, unless another press is in progress."""
        if self.busy:
            return
        self._trace_request("press", key=key)
        self.busy = True
        log_line(self.log, "Pressing key preparation")
        yield 0.25
        log_line(self.log, "Pressing key preparation complete")
        yield 0.05
        log_line(self.log, "Pressing key initiation complete")
        yield 0.1
        log_line(self.log, "Actually pressing the key")
        self._environment().key_pressed(key)
        log_line(self.log, "Finishing movement")
        yield 0.15
        log_line(self.log, "Finished movement")
        self.busy = False

    def _environment(self) -> Any:
        """Returns the model that contains the agent.

        Raises:
            AttributeError: If there is none, or it has no `key_pressed`.
        """
        environment = environment_of(self)
        if not hasattr(environment, "key_pressed"):
            where = "the agent is in no environment" if environment is None else f"the environment '{environment.name}' has none"
            raise AttributeError(f"Motor '{self.name}' calls key_pressed(key) of the environment, but {where}")
        return environment


ELSEWHERE[Motor] = "for an agent with a body: from actr3d.motor import Motor, after from actr3d.actr import *"
