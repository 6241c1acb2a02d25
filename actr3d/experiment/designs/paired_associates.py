"""The experiment of Anderson (1981) on learning pairs of a noun and a digit."""

from types import ModuleType

from actr3d.experiment.design import Design, Group, design


@design
def paired_associates() -> Design:
    """Practice and forgetting: 20 pairs of noun and digit, tested and studied in each of 8 blocks (Anderson 1981).

    A row is one session of a participant: its trials follow from one another. `accuracy_1` to `accuracy_8` are the shares of right answers
    in each block, `latency_1` to `latency_8` their mean latencies in seconds; a block without right answers has no latency. The
    number of participants is not the original's, which is not known here. Human data: the means of each block, as the ACT-R tutorial
    (unit 4) quotes them; it quotes no standard deviations.
    """
    return Design(
        model="paired_associates.py",
        groups={"all": Group(participants=100)},
        results=_by_block,
        until=10_000.0,
        human="paired_associates",
    )


def _by_block(program: ModuleType) -> dict[str, float | None]:
    """Returns the accuracy and latency of each block."""
    blocks = range(1, program.blocks + 1)
    accuracy = {f"accuracy_{block}": program.accuracy[block - 1] for block in blocks}
    return {**accuracy, **{f"latency_{block}": program.latency[block - 1] for block in blocks}}
