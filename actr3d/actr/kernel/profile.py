"""Profiles: the defaults and equations of Python ACT-R, and those of ACT-R 7."""

from __future__ import annotations

import math
from dataclasses import dataclass

from actr3d.errors import ParameterError, did_you_mean


@dataclass(frozen=True, kw_only=True)
class Profile:
    """The differences between Python ACT-R and ACT-R 7.

    Source: python_actr 1.9.5, and ACT-R 7.27.7 as described in its reference manual.
    """

    name: str
    youngest_age: float
    """The minimum age of a reference in base-level learning [s]."""
    optimized_learning: bool
    """Whether the optimized form is the default of base-level learning."""
    spread_by_slots: bool
    """Whether each buffer's weight is divided among its chunk-valued slots, and the fan is (1 + slots_j) / slots_ji."""
    latency: float
    """The default latency factor F [s]."""
    maximum_time: float
    """The default maximum duration of a retrieval [s]."""
    whole_milliseconds: bool
    """Whether times are whole milliseconds."""
    negations_cost: bool
    """Whether a negative test that fails costs activation in partial matching instead of excluding the chunk."""
    blend_every_slot: bool
    """Whether blending works as in ACT-R 7's blending module: every slot of the result is a compromise of all matching chunks, the
    temperature is sqrt(2) times the noise, and the time comes from ln sum exp A."""
    clear_at_request: bool
    """Whether a request clears the retrieval buffer immediately."""
    harvest: bool
    """Whether a chunk that leaves a buffer is added to declarative memory."""
    learn_compiled: bool
    """Whether a compiled rule's utility moves towards its first parent's, U += alpha (U_parent - U), each time it is compiled again."""
    total_utility: bool
    """Whether utility learning changes the whole utility, including the production's own base."""
    awaits_expiry: bool
    """Whether a run without a limit also waits for events without effect: the expiry of marks of retrieved chunks, the answers
    to requests that were replaced, and alternatives that came too late. ACT-R 7 looks up marks by their age, and deletes such
    events."""


PYTHON_ACTR = Profile(
    name="python-actr",
    youngest_age=0.005,
    optimized_learning=False,
    spread_by_slots=False,
    latency=0.05,
    maximum_time=10.0,
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
    maximum_time=math.inf,
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
