"""One run from its start on: the agents and the world, a tick and a tock at a time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.modules.answers import copied_answer
from actr3d.actr.modules.port import Request, note_request
from actr3d.clock import seconds
from actr3d.errors import SimulationError
from actr3d.simulation.agents import Agents, Factory
from actr3d.simulation.commands import Command
from actr3d.simulation.event_log import EventLog
from actr3d.world import World


class Lockstep:
    """Runs agents and a world through the same time, from time 0.

    Args:
        world: The world, at its start.
        factories: By name, the factory of each agent.
        bodies: The names of those agents that have bodies.
        seed: The seed of all random choices.
        steps: Number of physics steps in a tick.
        period: Length of a tick [us].
        log: Receives everything that happens.

    Raises:
        SimulationError: If an agent cannot be made.
    """

    def __init__(
        self,
        world: World,
        factories: Mapping[str, Factory],
        bodies: frozenset[str],
        seed: int | str,
        steps: int,
        period: int,
        log: EventLog,
    ) -> None:
        self._world = world
        self._log = log
        self._steps = steps
        self._period_us = period
        self._period = seconds(period)
        self.trace = log.begin()
        """Its trace; None if nothing is traced."""
        self._limits = RunLimits.current()
        self._stdout = log.stdout
        with self._stdout:
            self.agents = Agents(factories, bodies, seed, self.trace, period)
        self.ticks = 0
        """Number of completed ticks."""
        self.commands = 0
        """Number of commands that have been carried out."""
        self._phase = "ready"

    @property
    def done(self) -> bool:
        """Whether no agent has anything left to do, now or ever, and no body is on its way to where a command sends it."""
        return self.agents.done and not any(body.motion.under_way for body in self._world.bodies.values())

    @property
    def broken(self) -> bool:
        """Whether it cannot continue from here: a tick is incomplete."""
        return self._phase != "ready"

    @property
    def running(self) -> bool:
        """Whether its agents or bodies are doing something at this moment."""
        return self._phase == "running"

    def fail(self) -> None:
        """Prevents the run from continuing from here, because the present is not what it should be."""
        self._phase = "failed"

    # -- one tick

    def may_tick(self) -> bool:
        """Returns whether the limits of the program leave time for another tick.

        Raises:
            EndOfRun: If an earlier run was cut short by them.
        """
        last = None if self._limits is None else self._limits.clip()
        return last is None or self._end <= last

    def cut(self) -> None:
        """Notes that the limits of the program have cut the run short."""
        if self._limits is not None:
            self._limits.cut(self._end)

    @property
    def _end(self) -> int:
        """The end of the next tick [us]."""
        return (self.ticks + 1) * self._period_us

    def tick(self) -> None:
        """Runs the agents for one period.

        Raises:
            SimulationError: If the last tick has had no tock, or has failed.
            EndOfRun: If the limits of the program leave no time for a whole tick; then nothing has happened.
            Exception: What an agent raises.
        """
        self._expect("ready", "tick")
        if self._limits is not None and not self.may_tick():
            self._limits.refuse(self._end)
        self._phase = "running"
        try:
            with self._stdout:
                self.agents.run(self._period)
        except BaseException:
            self.fail()
            raise
        self._phase = "ticked"

    def tock(self) -> tuple[Any, ...]:
        """Carries out the agents' requests to their bodies, simulates the physics, and collects the answers of the bodies.

        Returns:
            The answers, in the order of the questions.

        Raises:
            SimulationError: If there has been no tick before, or something has failed.
            Exception: What a body raises; a note names the modeller's line.
        """
        self._expect("ticked", "tock")
        self._phase = "running"
        try:
            answers = self._tock()
        except BaseException:
            self.fail()
            raise
        self.ticks += 1
        self._phase = "ready"
        return answers

    def _tock(self) -> tuple[Any, ...]:
        world, outbox = self._world, self.agents.outbox
        questions: list[Request] = []
        if outbox:
            for request in outbox:
                if request.reading is None:
                    _ask(request, world.bodies[request.body].set)
                else:
                    questions.append(request)
            outbox.clear()
        world.step(self._steps)
        answers: tuple[Any, ...] = ()
        if questions:
            answers = tuple(_ask(request, world.bodies[request.body].get) for request in questions)
            self._answer(questions, answers)
        return answers

    def repeat_tick(self, answers: tuple[Any, ...]) -> None:
        """Repeats a known tick with its answers, without its physics.

        Raises:
            SimulationError: If the agents ask other questions than the first time: their choices do not all come from the seed.
        """
        self.tick()
        questions = [request for request in self.agents.outbox if request.reading is not None]
        self.agents.outbox.clear()
        if len(questions) != len(answers):
            raise SimulationError(
                f"the agents asked {len(questions)} questions where they had asked {len(answers)} the first time, in the tick from "
                f"{seconds(self.ticks * self._period_us):g} s on: they use something that does not come from the seed"
            )
        self._answer(questions, answers)
        self.ticks += 1
        self._phase = "ready"

    def _answer(self, questions: Sequence[Request], answers: Sequence[Any]) -> None:
        for request, answer in zip(questions, answers, strict=True):
            self.agents.take(request, copied_answer(answer))
        self._log.answers(self.ticks + 1, questions, answers)

    def _expect(self, phase: str, what: str) -> None:
        if self._phase == phase:
            return
        if self._phase == "failed":
            raise SimulationError(f"{what}: the run has failed at {seconds(self.agents.time):g} s and cannot go on; seek an earlier time")
        raise SimulationError("call tock() first" if phase == "ready" else "tock: call tick() first")

    # -- commands

    def command(self, command: Command) -> None:
        """Carries out a new command of a user.

        Raises:
            SimulationError: If the last tick has had no tock, or there is no such command.
            Exception: What a body raises.
        """
        self._expect("ready", f"command '{command.word}'")
        command.carry_out(self._world, self.agents)
        self.commands += 1

    def trace_command(self, command: Command) -> None:
        """Traces a command that has been carried out."""
        if self.trace is not None and self.trace.production:
            self.trace.emit(self.agents.time, "top", "command", command.to_data())

    def repeat_commands(self, known: Sequence[Command], *, only_agents: bool = False) -> None:
        """Carries out the known commands of this tick again."""
        while self.commands < len(known) and known[self.commands].tick == self.ticks:
            command = known[self.commands]
            command.carry_out(self._world, self.agents, only_agents=only_agents)
            self.commands += 1
            self.trace_command(command)


def _ask(request: Request, word: Callable[..., Any]) -> Any:
    """Passes a request to its body; adds the modeller's line to an error."""
    try:
        return word(request.word, *request.values, **request.named)
    except Exception as error:
        note_request(error, request.port, request.site)
        raise
