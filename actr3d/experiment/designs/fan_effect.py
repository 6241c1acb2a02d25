"""The person-location experiment of Anderson (1974) on the fan effect."""

from actr3d.experiment.design import Design, Group, Measured, design


@design
def fan_effect() -> Design:
    """Recognising facts: person and location with one, two or three facts each, targets and foils (Anderson 1974, experiment 1).

    A row is one sentence. The numbers of participants and
    trials are not the original's, which are not known here. Human data: 18 mean reaction times, as the ACT-R tutorial (unit 5) quotes
    them; it quotes no error rates and no standard deviations.
    """
    factors = {"probe": ("target", "foil"), "location_fan": (1, 2, 3), "person_fan": (1, 2, 3)}
    return Design(
        model="fan_effect.py",
        factors=factors,
        groups={"all": Group(participants=20)},
        trials=10,
        measures=[Measured(name="reaction_time", unit="s"), Measured(name="correct", meaning="Whether the answer is right.")],
        human="fan_effect",
    )
