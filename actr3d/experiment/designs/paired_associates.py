"""The experiment of Anderson (1981) on learning pairs of a noun and a digit."""

from actr3d.experiment.design import Design, Group, Measured, design


@design
def paired_associates() -> Design:
    """Practice and forgetting: 20 pairs of noun and digit, tested and studied in each of 8 blocks (Anderson 1981).

    A row is one session of a participant: its trials follow from one another. A block without right answers has no latency. The number
    of participants is not the original's, which is not known here. Human data: the means of each block, as the ACT-R tutorial (unit 4)
    quotes them; it quotes no standard deviations.
    """
    return Design(
        model="paired_associates.py",
        groups={"all": Group(participants=100)},
        measures=[
            Measured(name="accuracy", meaning="The share of right answers.", over="block"),
            Measured(name="latency", unit="s", meaning="The mean latency of right answers.", over="block"),
        ],
        until=10_000.0,
        human="paired_associates",
    )
