"""The experiment of Friedman et al. (1964) on probability learning."""

from types import ModuleType
from typing import Any

from actr3d.experiment.design import Design, Group, Measured, design


@design
def utility_learning() -> Design:
    """Probability learning: 48 guesses of an event that happens in 10, 30, 50, 70 or 90 % of the cases (Friedman et al. 1964).

    A row is one session: its guesses follow from one another, and each session begins without experience. The number of participants
    is not the original's, which is not known here. Human data: the means of the four blocks for 90 %, as the ACT-R tutorial (unit 6)
    quotes them; it quotes no standard deviations. For the other probabilities only a line is quoted (see the model), and no means.
    """
    return Design(
        model="utility_learning.py",
        factors={"heads_probability": (0.1, 0.3, 0.5, 0.7, 0.9)},
        groups={"all": Group(participants=100)},
        results=_shares,
        measures=[
            Measured(name="heads", meaning="The share of guesses of heads, in blocks of 12.", over="block"),
            Measured(name="late", meaning="The share of guesses of heads in the second half."),
        ],
        until=1000.0,
        human="utility_learning",
    )


def _shares(program: ModuleType) -> dict[str, Any]:
    """Returns the share of guesses of heads in each block, and in the second half."""
    late = program.heads[len(program.heads) // 2 :]
    return {"heads": program.heads, "late": sum(late) / len(late)}
