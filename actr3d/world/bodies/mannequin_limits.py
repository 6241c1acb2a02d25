"""Ranges, strengths and greatest speeds of the mannequin's joints."""

from __future__ import annotations

import math

Range = tuple[float, float]


def _degrees(lower: float, upper: float) -> Range:
    return (math.radians(lower), math.radians(upper))


LIMITS: dict[str, dict[str, Range]] = {
    "stance": {"yaw": _degrees(-90, 90), "sway": (-0.3, 0.3), "bob": (-0.3, 0.1)},
    "pelvis": {"yaw": _degrees(-45, 45), "pitch": _degrees(-20, 120), "roll": _degrees(-30, 30)},
    "torso": {"yaw": _degrees(-90, 90), "pitch": _degrees(-25, 80), "roll": _degrees(-35, 35)},
    "head": {"yaw": _degrees(-60, 60), "pitch": _degrees(-45, 45), "roll": _degrees(-45, 45)},
    "eye": {"yaw": _degrees(-55, 55), "pitch": _degrees(-45, 45), "roll": _degrees(-10, 10)},
    "shoulder": {"yaw": _degrees(-20, 20), "pitch": _degrees(-30, 30), "roll": _degrees(-10, 45)},
    "upper_arm": {"yaw": _degrees(-90, 70), "pitch": _degrees(-180, 60), "roll": _degrees(-30, 180)},
    "thigh": {"yaw": _degrees(-50, 50), "pitch": _degrees(-120, 45), "roll": _degrees(-60, 60)},
    "shank": {"pitch": _degrees(-5, 150)},
    "foot": {"pitch": _degrees(-45, 60)},
}
"""By segment, the left one of a pair: the range of each joint relative to the segment that carries it [rad] [m], 0 standing upright with
hanging arms.

All axes are right-handed about the carrying segment's x (roll), y (pitch) and z (yaw): a positive yaw turns to the left, a positive pitch
bends forward, a positive roll leans to the right; an arm or a leg is lifted forward by a negative pitch, the left one sideways by a
positive roll. Source: ranges of motion of the American Academy of Orthopaedic Surgeons (hips, thoracolumbar and cervical spine, shoulder);
clavicle elevation and depression from the same, its yaw of 20 degrees and the torso's of 90 from the original (docs/human-data.md);
eye: Guitton & Volle (1987), about 55 degrees to each side. The clavicle's pitch and the eye's roll were chosen for this library; so were
the ranges of the stance, the legs relative to the walking direction (people can walk sideways), and of the legs, which are wider than gait
needs.
"""

STRENGTH = {
    "stance": 100.0,
    "pelvis": 200.0,
    "torso": 150.0,
    "head": 25.0,
    "eye": 1.0,
    "shoulder": 80.0,
    "upper_arm": 60.0,
    "thigh": 200.0,
    "shank": 150.0,
    "foot": 100.0,
}
"""Greatest torque of a joint, by the kind of segment [N m]. Source: chosen, of the order of maximal voluntary torques of adults
(hip 200, knee 150, ankle 100, trunk rotation 100 to 150, neck 20 to 30, shoulder 50 to 80); the stance less than the torque that holds
the feet."""


FASTEST_WALK, FASTEST_TURN, FASTEST_JOINT = 12.5, 12.5, 16.0
"""The fastest that a person can walk or run [m/s], turn [rad/s] and turn a joint [rad/s].
Source: the fastest sprint, 12.4 m/s (Bolt, 2009); pirouettes of two turns a second; saccades of the eye up to 900 degrees a second
(Bahill, Clark & Stark, 1975), which the fastest trunks of golfers and pitchers hardly exceed."""


def limits_of(segment: str, joint: str) -> Range:
    """Returns the range of one of a segment's joints [rad] [m]; yaw and roll of the right side mirror those of the left."""
    lower, upper = LIMITS[_kind(segment)][joint]
    return (-upper, -lower) if segment.startswith("right_") and joint != "pitch" else (lower, upper)


def strength_of(segment: str) -> float:
    """Returns the greatest torque of each joint of a segment [N m]."""
    return STRENGTH[_kind(segment)]


def _kind(segment: str) -> str:
    return segment.removeprefix("left_").removeprefix("right_")
