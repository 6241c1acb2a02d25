"""One run from its start on: the minds and the world, a tick and a tock at a time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from actr3d.actr.kernel.tree import path_of
from actr3d.actr.modules.port import Request
from actr3d.clock import seconds
from actr3d.errors import Actr3dError, SimulationError
from actr3d.simulation.commands import Command
from actr3d.simulation.journal import Journal
from actr3d.simulation.minds import Factory, Minds
from actr3d.world import World


class Lockstep:
    """Minds that begin at time 0, and the world beside them.

    Args:
        world: The world; at its start, too.
        factories: By name, what makes each mind.
        bodies: The names of those minds that have bodies.
        seed: What all random choices come from.
        steps: How many physics steps a tick is.
        period: How long a tick is [us].
        journal: Who is told of everything.

    Raises:
        SimulationError: If a mind cannot be made.
    """

    def __init__(
        self,
        world: World,
        factories: Mapping[str, Factory],
        bodies: frozenset[str],
        seed: int | str,
        steps: int,
        period: int,
        journal: Journal,
    ) -> None:
        self._world = world
        self._journal = journal
        self._steps = steps
        self._period_us = period
        self._period = seconds(period)
        self.trace = journal.begin()
        """Its trace; None where nothing is traced."""
        self._voice = journal.voice
        with self._voice:
            self.minds = Minds(factories, bodies, seed, self.trace)
        self.ticks = 0
        """How many whole ticks it has gone."""
        self.commands = 0
        """How many commands have been carried out."""
        self._phase = "ready"

    @property
    def broken(self) -> bool:
        """Whether it cannot go on from here: it stands in the midst of a tick."""
        return self._phase != "ready"

    # -- one tick

    def may_tick(self) -> bool:
        """Returns whether the limits of the program leave time for another tick.

        Raises:
            EndOfRun: If an earlier run was cut short by them.
        """
        return self.minds.may_run((self.ticks + 1) * self._period_us)

    def cut(self) -> None:
        """Notes that the limits of the program have cut the run short, for lack of time for another tick."""
        self.minds.cut((self.ticks + 1) * self._period_us)

    def tick(self) -> None:
        """Runs the agents for one period.

        Raises:
            SimulationError: If the last tick has had no tock, or has failed.
            EndOfRun: If the limits of the program leave no time for a whole tick; then nothing has happened.
            Exception: What an agent raises.
        """
        self._expect("ready", "tick")
        self.minds.claim((self.ticks + 1) * self._period_us)
        self._phase = "failed"
        with self._voice:
            self.minds.run(self._period, (self.ticks + 1) * self._period_us)
        self._phase = "ticked"

    def tock(self) -> tuple[Any, ...]:
        """Carries out what the minds want, simulates the physics, and lets the bodies answer.

        Returns:
            The answers, in the order of the questions.

        Raises:
            SimulationError: If there has been no tick before, or something has failed.
            Exception: What a body raises; it names the modeller's line.
        """
        self._expect("ticked", "tock")
        self._phase = "failed"
        world, outbox = self._world, self.minds.outbox
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
        self.ticks += 1
        self._phase = "ready"
        return answers

    def remember(self, answers: tuple[Any, ...]) -> None:
        """Goes through a tick that is known already, without its physics.

        Raises:
            SimulationError: If the minds ask other questions than the first time: they use more than the seed.
        """
        self.tick()
        questions = [request for request in self.minds.outbox if request.reading is not None]
        self.minds.outbox.clear()
        if len(questions) != len(answers):
            raise SimulationError(
                f"the minds asked {len(questions)} questions where they had asked {len(answers)} the first time, in the tick from "
                f"{seconds(self.ticks * self._period_us):g} s on: they use something that does not come from the seed"
            )
        self._answer(questions, answers)
        self.ticks += 1
        self._phase = "ready"

    def _answer(self, questions: Sequence[Request], answers: Sequence[Any]) -> None:
        for request, answer in zip(questions, answers, strict=True):
            self.minds.take(request, answer)
        self._journal.answers(self.ticks + 1, questions, answers)

    def _expect(self, phase: str, what: str) -> None:
        if self._phase == phase:
            return
        if self._phase == "failed":
            raise SimulationError(f"{what}: the run has failed at {seconds(self.minds.time):g} s and cannot go on; seek an earlier time")
        raise SimulationError("a tick waits for its tock" if phase == "ready" else "tock: there is a tick to be made first")

    # -- commands

    def command(self, command: Command) -> None:
        """Carries out something new that a user does.

        Raises:
            SimulationError: If a tick waits for its tock, or there is nothing of that name.
            Exception: What a body raises.
        """
        self._expect("ready", f"command '{command.word}'")
        command.carry_out(self._world, self.minds)
        self.commands += 1

    def tell(self, command: Command) -> None:
        """Lets the trace know of a command that has been carried out."""
        if self.trace is not None:
            self.minds.tell(self.trace, "command", command.to_data())

    def repeat_commands(self, known: Sequence[Command], *, only_minds: bool = False) -> None:
        """Carries out what users did the first time, after as many ticks."""
        while self.commands < len(known) and known[self.commands].tick == self.ticks:
            command = known[self.commands]
            command.carry_out(self._world, self.minds, only_minds=only_minds)
            self.commands += 1
            self.tell(command)


def _ask(request: Request, word: Callable[..., Any]) -> Any:
    """Hands a request to its body; an error is told with the line that asked."""
    try:
        return word(request.word, *request.values, **request.named)
    except Actr3dError as error:
        error.add_note(f"  asked for by '{path_of(request.port)}' in {request.place}")
        raise
