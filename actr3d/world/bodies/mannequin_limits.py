"""Ranges, strengths and greatest speeds of the mannequin's joints."""

from __future__ import annotations

import math

Range = tuple[float, float]


def _degrees(lower: float, upper: float) -> Range:
    return (math.radians(lower), math.radians(upper))


LIMITS: dict[str, tuple[Range, ...]] = {
    "stance": (_degrees(-90, 90),),
    "pelvis": (_degrees(-45, 45), _degrees(-20, 120), _degrees(-30, 30)),
    "torso": (_degrees(-90, 90), _degrees(-25, 80), _degrees(-35, 35)),
    "head": (_degrees(-60, 60), _degrees(-45, 45), _degrees(-45, 45)),
    "eye": (_degrees(-55, 55), _degrees(-45, 45), _degrees(-10, 10)),
    "left_shoulder": (_degrees(-20, 20), _degrees(-30, 30), _degrees(-10, 45)),
    "left_upper_arm": (_degrees(-90, 70), _degrees(-180, 60), _degrees(-30, 180)),
}
"""By segment: the ranges of yaw, pitch and roll relative to the segment that carries it [rad], 0 standing upright with hanging arms.

All axes are right-handed about the carrying segment's x (roll), y (pitch) and z (yaw): a positive yaw turns to the left, a positive
pitch bows, a positive roll leans to the right; an arm is lifted forward by a negative pitch, the left one sideways by a positive roll.
Source: ranges of motion of the American Academy of Orthopaedic Surgeons (hips, thoracolumbar and cervical spine, shoulder);
clavicle elevation and depression from the same, its yaw of 20 degrees and the torso's of 90 from the original (docs/human-data.md);
eye: Guitton & Volle (1987), about 55 degrees to each side. The clavicle's pitch and the eye's roll were chosen
for this library; so was the stance, the legs relative to the walking direction: people can walk sideways.
"""

STRENGTH = {"stance": 100.0, "pelvis": 200.0, "torso": 150.0, "head": 25.0, "eye": 1.0, "shoulder": 80.0, "upper_arm": 60.0}
"""Greatest torque of a joint, by the kind of segment [N m]. Source: chosen, of the order of maximal voluntary torques of adults
(hip 200, trunk rotation 100 to 150, neck 20 to 30, shoulder 50 to 80); the stance less than the torque that holds the feet."""


FASTEST_WALK, FASTEST_TURN, FASTEST_JOINT = 12.5, 12.5, 16.0
"""The fastest that a person can walk or run [m/s], turn [rad/s] and turn a joint [rad/s].
Source: the fastest sprint, 12.4 m/s (Bolt, 2009); pirouettes of two turns a second; saccades of the eye up to 900 degrees a second
(Bahill, Clark & Stark, 1975), which the fastest trunks of golfers and pitchers hardly exceed."""


def limits_of(segment: str) -> tuple[Range, ...]:
    """Returns the ranges of yaw, pitch and roll of a segment's hinges [rad]; the right side mirrors the left."""
    if not segment.startswith("right_"):
        return LIMITS[segment]
    yaw, pitch, roll = LIMITS["left_" + segment.removeprefix("right_")]
    return ((-yaw[1], -yaw[0]), pitch, (-roll[1], -roll[0]))


def strength_of(segment: str) -> float:
    """Returns the greatest torque of each joint of a segment [N m]."""
    return STRENGTH[segment.removeprefix("left_").removeprefix("right_")]
