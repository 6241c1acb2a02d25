"""The agents of a simulation: in one environment, with one clock and one queue of events."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from actr3d.actr.changes import Parts
from actr3d.actr.kernel.model import Model, attach_trace, ensure_converted, is_converted
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading.global_seed import seed_shared
from actr3d.actr.modules.port import Embodiment, Request
from actr3d.errors import SimulationError
from actr3d.trace import Trace

Factory = Callable[[], Any]
"""Makes an agent: its class, or a function without arguments."""


_LATER = frozenset({"changes", "log", "parent", "random", "sch"})
"""Attributes that an environment gets when it starts to run; no agent can have one of these names."""


class Environment(Model):
    """The environment of all agents of a simulation."""


class Agents:
    """The agents of one simulation, made from their factories; their requests to bodies wait in `outbox`.

    All share one queue, so that simultaneous events of several agents have one order: by priority, then first come first
    served. An agent holds generators, which cannot be copied; to return to an earlier moment, the agents are made again.

    Args:
        factories: By name, the factory of each agent.
        bodies: The names of those agents that have bodies.
        seed: The seed of all random choices, those of `random` and `numpy.random` included.
        trace: Receives the events.
        tick: Length of a tick [us].

    Raises:
        SimulationError: If a factory makes no agent, or the same one twice, or a name is taken.
    """

    def __init__(self, factories: Mapping[str, Factory], bodies: frozenset[str], seed: int | str, trace: Trace | None, tick: int) -> None:
        self.outbox: list[Request] = []
        self.stopped = False
        """Whether an agent called `stop` in the last tick."""
        outer = RunLimits.current()
        seed_shared(seed)
        with RunLimits(seed=seed):
            self.environment = Environment()
            for name, factory in factories.items():
                agent = _made(name, factory)
                if hasattr(self.environment, name) or name in _LATER:
                    raise SimulationError(f"an agent cannot be named '{name}': every environment has something of that name")
                if name in bodies:
                    Embodiment(name, self.outbox, tick).join(agent)
                setattr(self.environment, name, agent)
            ensure_converted(self.environment)
        self._sch = self.environment.sch
        self._sch.limits = outer
        self._sch.in_lockstep = True
        if outer is not None:
            outer.clock = lambda: self._sch.now_us
        if trace is not None:
            attach_trace(self.environment, trace)

    @property
    def time(self) -> int:
        """The agents' time [us]."""
        return self._sch.now_us

    @property
    def done(self) -> bool:
        """Whether no agent has anything left to do, now or ever."""
        return not (self._sch.queue.heap or self._sch.incoming or self.outbox)

    def run(self, period: float) -> None:
        """Runs the agents for a period [s]; to its end even where one of them calls `stop`."""
        sch = self._sch
        sch.stop_wanted = False
        sch.run(period)
        self.stopped = sch.stop_wanted

    def take(self, request: Request, answer: Any) -> None:
        """Delivers an answer to an agent, available from the next tick on."""
        self._sch.call_after(0, request.port._take, (request, answer))  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model

    @property
    def parts(self) -> Parts:
        """The parts of all agents, which a user can change."""
        return Parts([self.environment])


def _made(name: str, factory: Factory) -> Model:
    if not callable(factory):
        raise SimulationError(f"agents['{name}']: must be an agent's class, or a function without arguments (got {factory!r})")
    agent = factory()
    if not isinstance(agent, Model):
        raise SimulationError(f"agents['{name}']: must make an agent (made {agent!r})")
    if agent.__dict__.get("parent") is not None or (is_converted(agent) and agent.sch.now_us > 0):
        raise SimulationError(f"agents['{name}']: must make a new agent each time it is called, because the run may go back to its start")
    return agent
