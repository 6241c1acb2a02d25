"""The two sets of numbers a model can be run with."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.errors import ParameterError, did_you_mean


@dataclass(frozen=True, kw_only=True)
class Profile:
    """Where Python ACT-R and ACT-R 7 differ.

    Source: python_actr 1.9.5, and ACT-R 7.27.7 as described in its reference manual.
    """

    name: str
    youngest_age: float
    """The least age that a reference counts with in base-level learning [s]."""
    optimized_learning: bool
    """Whether base-level learning is the optimized form unless a limit is given."""
    spread_by_slots: bool
    """Whether each buffer's weight is divided among its chunk-valued slots, and the fan is (1 + slots_j) / slots_ji."""
    latency: float
    """The latency factor F [s], unless given."""
    whole_milliseconds: bool
    """Whether times are whole milliseconds."""
    negations_cost: bool
    """Whether a negative test that fails costs activation in partial matching, instead of ruling the chunk out."""
    blend_every_slot: bool
    """Whether blending is that of ACT-R 7's blending module: every slot of the result is a compromise of all matching chunks, the
    temperature is sqrt(2) times the noise, and the time comes from ln sum exp A."""
    clear_at_request: bool
    """Whether a request empties the retrieval buffer at once."""
    harvest: bool
    """Whether a chunk that leaves a buffer goes to declarative memory."""
    learn_compiled: bool
    """Whether a compiled rule's utility moves to its first parent's each time it is compiled again."""
    total_utility: bool
    """Whether utility learning moves the whole utility, the production's own base included."""
    awaits_expiry: bool
    """Whether a run without a limit also waits for what has no effect any more: for marks of retrieved chunks to expire, for
    the answers to requests that others have replaced, and for times that something else came before. In ACT-R 7 marks are
    looked up by their age, and such events are deleted."""


PYTHON_ACTR = Profile(
    name="python-actr",
    youngest_age=0.005,
    optimized_learning=False,
    spread_by_slots=False,
    latency=0.05,
    whole_milliseconds=False,
    negations_cost=False,
    blend_every_slot=False,
    clear_at_request=False,
    harvest=False,
    learn_compiled=False,
    total_utility=False,
    awaits_expiry=True,
)

ACT_R_7 = Profile(
    name="act-r-7",
    youngest_age=0.05,
    optimized_learning=True,
    spread_by_slots=True,
    latency=1.0,
    whole_milliseconds=True,
    negations_cost=True,
    blend_every_slot=True,
    clear_at_request=True,
    harvest=True,
    learn_compiled=True,
    total_utility=True,
    awaits_expiry=False,
)

PROFILES = {profile.name: profile for profile in (PYTHON_ACTR, ACT_R_7)}


def find_profile(name: str | Profile, where: str) -> Profile:
    """Returns the profile of that name.

    Raises:
        ParameterError: If there is none.
    """
    if isinstance(name, Profile):
        return name
    if name not in PROFILES:
        raise ParameterError(f"{where}: no profile {name!r}; use {' or '.join(map(repr, PROFILES))}{did_you_mean(str(name), PROFILES)}")
    return PROFILES[name]
