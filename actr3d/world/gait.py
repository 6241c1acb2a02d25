"""Gait: how legs, arms and trunk of a walking body move, from the speed of its base alone.

It is kinematic: no balance is kept and no force drives the body forward. The base moves as commanded; sway, rotation and
steps are movements of the joints that it carries, held by their servos, so that obstacles stop them too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Annotated, Any

import numpy as np
from annotated_types import Ge, Gt, Le
from numpy.random import PCG64, Generator, SeedSequence
from numpy.typing import NDArray

from actr3d.configuration import Configuration
from actr3d.world.kernel import ROLES, stride_changes

Row = NDArray[np.float64]

SIDES = ("left", "right")
STANCE = "stance_yaw"
"""The joint that turns the hips against the walking direction."""
SWAY, BOB = "stance_sway", "stance_bob"
"""The joints of the whole upper body relative to the walking direction: to the left, and up [m]."""
LEG = ("thigh_yaw", "thigh_pitch", "thigh_roll", "shank_pitch", "foot_pitch")
"""The joints of a leg."""
ASIDE = math.radians(45)
"""Greatest turn of a thigh against the hips, which keeps the feet along the way while the body turns [rad]. Source: rotation of the hip,
American Academy of Orthopaedic Surgeons; beyond it, the leg swings sideways."""
OWN = (SWAY, BOB, *(f"{side}_{joint}" for side in SIDES for joint in LEG))
"""The joints that only gait moves."""
SHARED = ("pelvis_yaw", "torso_yaw", "head_yaw", "left_upper_arm_pitch", "right_upper_arm_pitch")
"""The joints that the agent moves, too: gait moves them around the positions at which they were commanded to stop."""

TINY = 1e-12
"""Deviation below which a joint counts as being at its position [rad] [m]. Source: chosen; it is numerical."""
STILL = 0.05
"""Speed below which a body does not step [m/s]. Source: chosen for this library."""
PHASES = 100
"""Number of phases of a stride in the stored pattern. Source: chosen; it is numerical."""
_ROLES = np.array([ROLES.get(name.removeprefix("left_").removeprefix("right_"), 0) for name in (*OWN, *SHARED)])
_STANDING = np.zeros((PHASES, len(_ROLES)))
FASTEST = {SWAY: 1.0, BOB: 1.0}
"""Greatest speed of gait's slides [m/s]. Source: chosen, faster than any gait."""
FASTEST_HINGE = 12.0
"""Greatest speed of gait's hinges [rad/s], reached only when a joint returns to gait after another command. Source: chosen, faster than any
gait."""
HALT = 0.5
"""Time from the stop of the base to the end of the movements [s]. Source: chosen for this library, about one step."""

HIP = (19, 18, 16, 14, 10, 7, 3, -1, -5, -8, -10, -10, -6, 1, 9, 15, 19, 22, 22, 20)
KNEE = (4, 10, 16, 18, 17, 13, 10, 7, 6, 8, 13, 23, 38, 53, 61, 62, 54, 39, 20, 6)
ANKLE = (0, -4, -3, 1, 4, 6, 7, 8, 9, 9, 8, 2, -9, -18, -15, -8, -3, 0, 1, 1)
"""Flexion of a leg's joints in normal walking, at twenty phases of its stride from heel strike on [degrees]. Source: approximates the
curves of natural cadence in Winter (2009) to a few degrees; recalled, not measured in the figure."""
NORMAL_STEP = 0.41
"""Step length of those curves as a fraction of the height. Source: chosen; about 0.72 m at 1.75 m, normal walking of adults. For other
step lengths all angles are scaled."""
LARGEST_SCALE = 1.3
"""The greatest factor of these angles. Source: chosen, so that the legs of a very fast walker do not cross."""
SWAYS = ((0.7, 1.6), (0.07, 0.04))
"""Speeds [m/s], and the lateral excursion at each, from side to side [m]; it is linear between them, and constant beyond. Source:
Orendurff et al. (2004), J Rehabil Res Dev 41."""
SWAYS_AT = 0.3
"""The phase of the stride at which the body is farthest over the left leg. Source: chosen, the middle of that leg's stance."""
PELVIS_AT = ((0.5, 1.5), (0.15, 0.4))
"""Speeds [m/s], and the phase of the stride at which the pelvis is turned farthest to the left at each; the thorax is at 0. Source: chosen;
that the pelvis changes from turning with the thorax to turning against it is from Huang et al. (2010), Gait Posture 31."""


@dataclass(frozen=True, kw_only=True)
class Gait(Configuration):
    """How a person walks. With the default values it is the gait of healthy adults."""

    walk_ratio: Annotated[float, Gt(0), Le(0.02)] = 0.0065
    """Step length divided by step frequency [m per (steps/min)]: constant above about 1 m/s, so that both grow with the root of the speed.
    Source: Sekiya et al. (1996); Murakami & Otaka (2017), J Phys Ther Sci 29."""

    sway: Annotated[float, Ge(0), Le(3)] = 1.0
    """Factor of the lateral excursion of the body, which is 7 cm from side to side at 0.7 m/s and falls to 4 cm at 1.6 m/s.
    Source: Orendurff et al. (2004), J Rehabil Res Dev 41, of the centre of mass; that shoulders move as it does was assumed."""

    wander: Annotated[float, Ge(0), Le(0.1)] = 0.011
    """The standard deviation of the body's lateral position from step to step [m]. Source: steps vary in width by 2.2 cm (at a given speed,
    the step length varies by 1.5 %, and the variance of the width is 4.3 times that of the length; Collins & Kuo 2013, PLoS ONE 8), so a
    foot by 1.5 cm, and the middle between two feet by 1.1 cm."""

    timing: Annotated[float, Ge(0), Le(0.2)] = 0.015
    """The standard deviation of the duration of a step, as a fraction of it. Source: that of the step length at a given speed (Collins &
    Kuo 2013, PLoS ONE 8), as the speed of the base is constant."""

    pelvis: Annotated[float, Ge(0), Le(0.3)] = math.radians(4)
    """Rotation of the pelvis to each side [rad]. Source: chosen; people's is a few degrees (docs/human-data.md)."""

    thorax: Annotated[float, Ge(0), Le(0.3)] = math.radians(4)
    """Rotation of the thorax to each side, against the leg of that side [rad]. Source: chosen, as that of the pelvis."""

    arms: Annotated[float, Ge(0), Le(1)] = math.radians(15)
    """Swing of each arm, forward and back, against the leg of its side [rad]. Source: an arc of about 30 degrees (Perry 1992). That it
    falls with the square of the cosine of the shoulders' turn was assumed: a walker turned sideways does not swing its arms aside."""

    def steps_per_second(self, speed: float) -> float:
        """Returns the step frequency at a speed [m/s]."""
        return math.sqrt(60 * speed / self.walk_ratio) / 60

    def step_length(self, speed: float) -> float:
        """Returns the step length at a speed [m/s], in [m]."""
        return speed / self.steps_per_second(speed)

    def excursion(self, speed: float) -> float:
        """Returns the lateral excursion at a speed [m/s], from side to side [m]."""
        return self.sway * float(np.interp(speed, *SWAYS))


@dataclass(frozen=True, kw_only=True)
class LegPlan:
    """Sizes of a leg [m]."""

    thigh: float
    shank: float
    ankle: float
    """Height of the ankle above the middle line of the foot, whose ends are rounded."""
    heel: float
    toe: float
    """Distance from the ankle to the rear and the front end of that line."""
    height: float
    """Of the whole body."""


class GaitCycle:
    """The gait of one body at run time: the phase of its stride, and what this adds to the positions of joints.

    Args:
        gait: How it walks.
        legs: The sizes of its legs.
        rows: The rows of the joints `OWN` and `SHARED` in the body's `ActuatedDofs`, by name; those it does not have are left out.
        seed: The seeds of its variability.
    """

    def __init__(self, gait: Gait, legs: LegPlan, rows: Mapping[str, int], seed: tuple[int, ...]) -> None:
        names = [name for name in (*OWN, *SHARED) if name in rows]
        self.rows: NDArray[np.intp] = np.array([rows[name] for name in names], dtype=np.intp)
        """The rows that it moves."""
        self.joints: Sequence[str] = tuple(names)
        """The same by name."""
        self._gait = gait
        self._legs = legs
        self._seed = seed
        self._columns = np.array([(*OWN, *SHARED).index(name) for name in names], dtype=np.intp)
        self._fastest = np.array([FASTEST.get(name, FASTEST_HINGE) for name in names])
        self._pattern: tuple[float, Row] | None = None
        self._drawn: dict[int, tuple[float, float, float]] = {}
        self.added = np.zeros(len(names))
        """What it has added to each joint's place [rad] [m]."""
        self._changes = np.zeros(len(names))
        """What it adds in this tick [rad] [m]."""
        self._phase = 0.0
        """Of the stride: 0 at the left heel's strike, 0.5 at the right one's."""
        self._steps = 0
        """Number of steps made: the random numbers of a step follow from it."""
        self._size = 0.0
        """Of the movements: 0 standing, 1 walking; it changes during the first and last step."""

    def advance(self, forward: float, left: float, stance: float, torso: float, held: Row, duration: float) -> Row | None:
        """Returns what the coming tick adds to the places of its joints (n,); None if the body stands.

        Args:
            forward: The commanded speed of the base [m/s].
            left: The same, to the left [m/s].
            stance: The angle of the hips to the direction in which the base faces [rad].
            torso: The angle of the torso to the hips [rad].
            held: The places that joints hold, by row; NaN where another command moves them.
            duration: The length of the tick [s].
        """
        speed = math.hypot(forward, left)
        walks, wander = speed >= STILL, 0.0
        if walks or self._size:
            wander = self._stride(speed, duration)
        direction = (math.atan2(left, forward) if walks else 0.0) - stance
        turn = feet_along_the_way(direction)
        arms = max(0.0, math.cos(stance + torso)) ** 2
        pattern = _STANDING if self._pattern is None else self._pattern[1]
        size = self._size * self._size * (3 - 2 * self._size)
        stride = (pattern, self._phase, wander, size, turn, direction - turn, arms)
        greatest = stride_changes()(*stride, self._columns, _ROLES, self.rows, held, self._fastest, duration, self.added, self._changes)
        if not walks and self._size == 0 and greatest < TINY:
            return None
        self.added += self._changes
        return self._changes

    def _stride(self, speed: float, duration: float) -> float:
        """Advances the stride; returns the lateral deviation of the body that comes from the variability of its steps [m, left is
        positive]."""
        gait = self._gait
        if speed >= STILL:
            if self._size == 0:
                self._start()
            rate = gait.steps_per_second(speed) / (1 + gait.timing * self._random(self._steps)[0])
            self._phase += rate / 2 * duration
            if self._phase * 2 >= (self._steps % 2) + 1:
                self._steps += 1
                self._phase -= math.floor(self._phase)
            if self._pattern is None or self._pattern[0] != speed:
                self._pattern = speed, _pattern(gait, self._legs, speed)
            self._size = min(1.0, self._size + rate * duration)
        else:
            self._size = max(0.0, self._size - duration / HALT)
        into = 2 * self._phase - self._steps % 2
        ease = into * into * (3 - 2 * into)
        return gait.wander * ((1 - ease) * self._random(self._steps)[1] + ease * self._random(self._steps + 1)[1])

    def _start(self) -> None:
        """Begins to walk at a random phase of the stride.

        People differ in step length, so after some metres they are in different phases of the stride. All bodies here have the same walk
        ratio; with a fixed phase at the start, all walks would reach a place in the same phase.
        """
        self._steps += self._steps % 2
        self._phase = NormalDist().cdf(self._random(self._steps)[2])
        self._steps += int(self._phase >= 0.5)

    def _random(self, step: int) -> tuple[float, float, float]:
        """Returns the three standard normal numbers of a step: of its duration, its place, and the phase if a walk begins with it."""
        if step not in self._drawn:
            duration, place, phase = Generator(PCG64(SeedSequence([*self._seed, step]))).standard_normal(3).tolist()
            kept = {number: self._drawn[number] for number in self._drawn if abs(number - step) == 1}
            self._drawn = kept | {step: (duration, place, phase)}
        return self._drawn[step]

    def state(self) -> tuple[Any, ...]:
        """Returns the stride as plain values."""
        pattern = None if self._pattern is None else self._pattern[0]
        return (self._phase, self._steps, self._size, tuple(self.added.tolist()), pattern)

    def restore(self, state: tuple[Any, ...]) -> None:
        """Restores what `state` returned."""
        self._phase, self._steps, self._size, added, speed = state
        self.added[:] = added
        self._pattern = None if speed is None else (speed, _pattern(self._gait, self._legs, speed))


def feet_along_the_way(direction: float) -> float:
    """Returns the turn of the thighs that keeps the feet along a direction [rad], given relative to the hips."""
    return max(-ASIDE, min(ASIDE, direction))


def standing(stance: float) -> dict[str, float]:
    """Returns the positions of the joints that only gait moves, of a body that stands with its hips turned by an angle [rad] [m]."""
    thighs = dict.fromkeys((f"{side}_thigh_yaw" for side in SIDES), feet_along_the_way(-stance))
    return dict.fromkeys(OWN, 0.0) | thighs


def _pattern(gait: Gait, legs: LegPlan, speed: float) -> Row:
    """Returns the offsets of all joints over a stride at a speed: (PHASES, joints) [rad] [m]."""
    phases = np.arange(PHASES) / PHASES
    scale = min(LARGEST_SCALE, gait.step_length(speed) / (NORMAL_STEP * legs.height))
    columns: dict[str, Row] = {}
    low = np.full(PHASES, math.inf)
    for side, start in zip(SIDES, (0.0, 0.5), strict=True):
        hip, knee, ankle = (scale * _curve(curve, phases - start) for curve in (HIP, KNEE, ANKLE))
        columns[f"{side}_thigh_pitch"] = hip
        columns[f"{side}_thigh_yaw"] = columns[f"{side}_thigh_roll"] = np.zeros(PHASES)
        columns[f"{side}_shank_pitch"], columns[f"{side}_foot_pitch"] = knee, -ankle
        low = np.minimum(low, _lowest(legs, hip, knee, ankle))
        columns[f"{side}_upper_arm_pitch"] = -gait.arms * min(1.0, scale) * np.cos(2 * np.pi * (phases - start - 0.5))
    columns[BOB] = -low  # the lower foot stays on the ground
    columns[SWAY] = gait.excursion(speed) / 2 * np.cos(2 * np.pi * (phases - SWAYS_AT))  # over the standing leg
    # The right shoulder is forward when the left heel strikes.
    thorax = gait.thorax * np.cos(2 * np.pi * phases)
    between = np.interp(speed, *PELVIS_AT)
    pelvis = gait.pelvis * np.cos(2 * np.pi * (phases - between))
    columns["pelvis_yaw"], columns["torso_yaw"], columns["head_yaw"] = pelvis, thorax - pelvis, -thorax
    return np.column_stack([columns[name] for name in (*OWN, *SHARED)])


def _curve(degrees: tuple[int, ...], phases: Row) -> Row:
    """Returns a smooth periodic curve through twenty angles: their first six harmonics [rad]."""
    waves = np.fft.rfft(np.radians(degrees)) / len(degrees)
    turns = 2 * np.pi * phases
    return waves[0].real + sum(2 * (waves[n].real * np.cos(n * turns) - waves[n].imag * np.sin(n * turns)) for n in range(1, 7))


def _lowest(legs: LegPlan, hip: Row, knee: Row, ankle: Row) -> Row:
    """Returns the height of the lowest point of a foot above that of a straight leg [m]."""
    shank, foot = hip - knee, hip - knee + ankle
    lift = legs.thigh * (1 - np.cos(hip)) + legs.shank * (1 - np.cos(shank))
    return lift + legs.ankle * (1 - np.cos(foot)) + np.minimum(legs.toe * np.sin(foot), -legs.heel * np.sin(foot))
