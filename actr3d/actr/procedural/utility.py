"""Utility modules: compute the utilities of productions, and learn them.

Each is an attribute of an agent: `pm = PMNew(alpha=0.1)`. A production's utility is the sum of the parts of all modules.
"""

from __future__ import annotations

from typing import Any, ClassVar, cast

from actr3d.actr.kernel.hooks import hook
from actr3d.actr.kernel.model import Model, profile_of
from actr3d.actr.kernel.noise import logistic_noise
from actr3d.actr.kernel.parameters import NotNegative, WithParameters, named_parameters
from actr3d.actr.kernel.tree import path_of
from actr3d.actr.procedural.production import Production
from actr3d.errors import alternatives
from actr3d.trace import Trace


class ProceduralSubModule(WithParameters, Model):
    """The base of all utility modules; each method may be overridden."""

    def start(self) -> None:
        """Registers the module with the agent."""
        self.parent.add_adaptor(self)  # type: ignore[union-attr]

    @hook
    def create(self, prod: Any, parents: list[Production] | None = None) -> None:
        """Is called for each new production.

        Args:
            prod: The production.
            parents: The two productions that it was compiled from; None for any other.
        """

    @hook
    def selecting(self, prod: Any) -> None:
        """Is called when a production has been chosen."""

    @hook
    def withdrawn(self, prod: Any) -> None:
        """Is called when a user withdraws the chosen production before it fires."""

    @hook
    def firing(self, prod: Any) -> None:
        """Is called when a production fires."""

    @hook
    def reward(self, value: float) -> None:
        """Is called with each reward."""

    @hook
    def utility(self, prod: Any) -> float:
        """Returns this module's part of a production's utility."""
        return 0

    @hook
    def below_threshold(self) -> None:
        """Is called when no production's utility has reached the threshold."""

    @property
    def names_in_productions(self) -> list[tuple[str, str]]:
        """The names in productions that the module was given, each after the name of its parameter."""
        return []

    _decisive: ClassVar[frozenset[str]] = frozenset()
    """The attributes of the module that the utilities of all productions depend on."""

    def _trace_change(self, trace: Trace, key: str, value: Any) -> None:
        super()._trace_change(trace, key, value)
        if key in self._decisive and trace.all and self.parent is not None:
            for production in _productions_of(self.parent):
                trace_part(trace, self.parent, production, self.name, known_part(self, production))

    def _learned(self, prod: Any) -> None:
        """Records a production's utility after learning."""
        trace_learned(self, prod)


def utility_modules(agent: Model | None) -> list[ProceduralSubModule]:
    """Returns the utility modules of an agent."""
    return [] if agent is None else agent.__dict__.get("_adaptors", [])


def _productions_of(agent: Model | None) -> list[Production]:
    """Returns the productions of an agent."""
    return [] if agent is None else agent.__dict__.get("_productions", [])


def known_part(module: ProceduralSubModule, prod: Any) -> float | None:
    """Returns what a module adds to a production's utility, without drawing a random number; None if a choice must be made first.

    A modeller's own module is called only when a choice is made.
    """
    if type(module).utility.__module__ != __name__:
        return None
    if isinstance(module, PMNoise):
        return prod.baseNoise if module.noise == 0 else None
    try:
        return module.utility(prod)
    except ZeroDivisionError:  # a history without tries has no utility yet
        return None


def trace_learned(module: ProceduralSubModule, prod: Any) -> None:
    """Records what a module adds to a production's utility after learning."""
    trace = module.sch.trace
    if trace is not None and trace.all and module.parent is not None:
        part = known_part(module, prod)
        if part is not None:
            trace_part(trace, module.parent, prod, module.name, part)


def trace_part(trace: Trace, system: Model, prod: Any, part: str, value: float | None) -> None:
    """Records a part of the utility of a system's production."""
    trace.emit(system.sch.now_us, path_of(system), "utility", {"production": prod.name, "part": part, "value": value})


class PMNoise(ProceduralSubModule):
    """Adds logistic noise to utilities.

    Args:
        noise: The scale s of the logistic noise drawn at each choice.
        baseNoise: The scale s of the logistic noise drawn once for each production.
    """

    _decisive = frozenset({"noise"})

    @named_parameters
    def __init__(self, noise: NotNegative = 0, baseNoise: NotNegative = 0.0) -> None:  # noqa: N803 - Python ACT-R's name
        self.noise = noise
        self.baseNoise = baseNoise

    def create(self, prod: Any, parents: list[Production] | None = None) -> None:
        prod.baseNoise = self.logisticNoise(self.baseNoise)

    def utility(self, prod: Any) -> float:
        return prod.baseNoise + self.logisticNoise(self.noise)

    def logisticNoise(self, s: float) -> float:  # noqa: N802 - Python ACT-R's name
        """Draws logistic noise of scale `s`."""
        return logistic_noise(self.random, s)


class RewardLearning(ProceduralSubModule):
    """Learns utilities from rewards, each of which counts for the productions chosen since the last one."""

    history: list[tuple[Any, float]]
    """These productions, each with the time of its choice [s]."""

    def withdrawn(self, prod: Any) -> None:
        """Forgets the latest choice."""
        if self.history and self.history[-1][0] is prod:
            self.history.pop()


class PMPGC(RewardLearning):
    """Utility as expected gain, U = P G - C, learned from successes, failures and the time that was spent.

    Args:
        goal: G, the value of reaching the goal [s].

    Source: Anderson & Lebiere (1998), chapter 3.
    """

    _decisive = frozenset({"goal"})

    @named_parameters
    def __init__(self, goal: float = 20) -> None:
        self.history = []
        self.goal = goal
        self._rewarded = False

    def selecting(self, prod: Any) -> None:
        """Records a production with the time of its choice [s]; after a reward, clears the earlier ones first."""
        if self._rewarded:
            self.history.clear()
            self._rewarded = False
        self.history.append((prod, self.now()))

    def create(self, prod: Any, parents: list[Production] | None = None) -> None:
        prod.successes = 1
        prod.failures = 0
        time = cast("Any", self.parent).production_time
        prod.time = time() if callable(time) else time
        prod.lock_pgc = False

    def reward(self, value: float) -> None:
        """Counts a success for a reward of 0 or more, a failure for one below, weighted by its size."""
        now = self.now()
        for prod, chosen in self.history:
            if not prod.lock_pgc:
                prod.time += now - chosen
                if value >= 0:
                    prod.successes += value
                else:
                    prod.failures -= value
                self._learned(prod)
        self._rewarded = True

    def _learned(self, prod: Any) -> None:
        # All such modules of one agent share a production's history.
        for module in utility_modules(self.parent):
            if isinstance(module, PMPGC):
                trace_learned(module, prod)

    def utility(self, prod: Any) -> float:
        tries = prod.successes + prod.failures
        return prod.successes / tries * self.goal - prod.time / tries

    def set(
        self,
        prod: Any,
        successes: float | None = None,
        failures: float | None = None,
        time: float | None = None,
        lock: bool | None = None,
    ) -> None:
        """Sets a production's history; `lock` keeps rewards from changing it.

        Raises:
            KeyError: If the agent has no production of that name.
        """
        if isinstance(prod, str):
            known = {p.name: p for p in _productions_of(self.parent)}
            if prod not in known:
                raise KeyError(f"{type(self).__name__}.set: no production '{prod}'{alternatives(prod, known)}")
            prod = known[prod]
        if successes is not None:
            prod.successes = successes
        if failures is not None:
            prod.failures = failures
        if time is not None:
            prod.time = time
        if lock is not None:
            prod.lock_pgc = lock
        self._learned(prod)


class PMPGCSuccessWeighted(PMPGC):
    """PMPGC with P = 1 and the cost per success: U = G - time / successes."""

    def utility(self, prod: Any) -> float:
        return 1.0 * self.goal - prod.time / prod.successes


class PMPGCMixedWeighted(PMPGC):
    """PMPGC with the cost per success: U = P G - time / successes."""

    def utility(self, prod: Any) -> float:
        return prod.successes / (prod.successes + prod.failures) * self.goal - prod.time / prod.successes


class PMNew(RewardLearning):
    """Utility learning U += alpha (R - dt - U), where dt is the time from the choice to the reward [s].

    Args:
        alpha: The learning rate.

    Source: Anderson (2007), equation for utility learning; ACT-R 6 and 7.
    """

    @named_parameters
    def __init__(self, alpha: float = 0.2) -> None:
        self.history = []
        self.alpha = alpha
        self.clearFlag = False
        """Whether a reward has come since the latest choice; public, so that Python ACT-R's logs show it."""

    def selecting(self, prod: Any) -> None:
        """Records a production with the time of its choice [s]; after a reward, clears the earlier ones first."""
        if self.clearFlag:
            self.history.clear()
            self.clearFlag = False
        self.history.append((prod, self.now()))

    def create(self, prod: Any, parents: list[Production] | None = None) -> None:
        prod.util = 0

    def reward(self, value: float) -> None:
        """Moves the utility of each production since the latest reward towards the reward minus the time since its choice."""
        now = self.now()
        whole = profile_of(self).total_utility
        for prod, chosen in self.history:
            present = prod.util + prod.base_utility if whole else prod.util
            prod.util += self.alpha * (value - (now - chosen) - present)
            self._learned(prod)
        self.clearFlag = True

    def utility(self, prod: Any) -> float:
        """Returns a production's learned utility; 0 before its first reward."""
        return prod.util

    @hook
    def recreated(self, prod: Any, first: Any) -> None:
        """Moves a compiled rule's utility to its first parent's, U += alpha (U_parent - U), with its present one (ACT-R 7)."""
        whole = prod.base_utility + prod.util
        prod.util += self.alpha * (first.base_utility + first.util - whole)
        self._learned(prod)


class PMTD(ProceduralSubModule):
    """Temporal-difference learning: a production's utility is its reward plus the utility of the next one, discounted by time.

    Args:
        alpha: The learning rate.
        discount: k in the hyperbolic discount 1 / (1 + k t) [1/s].
        cost: The cost of firing.

    Source: Fu & Anderson (2004), Proceedings of the Cognitive Science Society.
    """

    @named_parameters
    def __init__(self, alpha: float = 0.1, discount: float = 1, cost: float = 0.05) -> None:
        self.alpha = alpha
        self.discount = discount
        self.last_prod: Any = None
        self.last_time: float | None = None
        self.this_reward: float = 0
        self.cost = cost

    def create(self, prod: Any, parents: list[Production] | None = None) -> None:
        prod.td_u = 0
        prod.cost = self.cost

    def firing(self, prod: Any) -> None:
        last = self.last_prod
        if last is not None and self.last_time is not None:
            passed = self.now() - self.last_time
            worth = self.this_reward - last.cost + prod.td_u / (1 + self.discount * passed)
            last.td_u += self.alpha * (worth - last.td_u)
            self._learned(last)
        self.last_prod = prod
        self.last_time = self.now()
        self.this_reward = 0

    def reward(self, value: float) -> None:
        self.this_reward += value

    def utility(self, prod: Any) -> float:
        return prod.td_u
