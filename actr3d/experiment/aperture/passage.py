"""Measures a body's passage through an aperture, from the state of the world."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from actr3d.errors import WorldError
from actr3d.experiment.aperture.clearance import Clearance
from actr3d.experiment.aperture.kernel import (
    AGAIN,
    ANGLE,
    BEFORE,
    COLUMNS,
    DURATION,
    END,
    ENTERED,
    FAR,
    LEFT,
    LOGGED,
    NEAR,
    RIGHT,
    TINY,
    TURNED,
    take_sample,
)
from actr3d.simulation.measure import measure
from actr3d.world import World
from actr3d.world.scene_objects import Aperture

FASTEST = 20.0
"""No part of a body moves faster than this [m/s]. Source: chosen; a swinging arm reaches a few metres a second."""
ROWS = 4096
"""Samples for which there is room at first: those of a walk of 8 s, in steps of 2 ms."""
LEAST_TURN = math.radians(1)
"""Turn of the shoulders at which a turn begins [rad]. Source: chosen for this library."""


@dataclass(frozen=True, kw_only=True)
class PassageResult:
    """The result of a walk to an aperture. Distances are those of the body's axis from the middle plane of the wall, positive in front."""

    outcome: Literal["passed", "declined", "stopped"]
    """`passed`: the whole body is behind the wall; `declined`: the agents ended the run before the body set out; `stopped`: neither."""
    peak_angle_deg: float | None
    """The greatest angle between the shoulder line and the wall while walking [degrees], from 0 to 90; None if it did not set out."""
    wall_angle_deg: float | None
    """The angle between the shoulder line and the wall when the axis reached the wall [degrees]; None if it did not."""
    logged_angle_deg: float | None
    """The sum of the joint angles of torso and clavicle when the axis reached the wall [degrees], logged by the original model
    (docs/human-data.md); plus that of the stance, if the body has one."""
    onset_distance_m: float | None
    """Distance from the wall at which the shoulders began to turn to their greatest angle [m]; None if they did not. Turns to
    and fro with each step do not count."""
    onset_time_s: float | None
    """The time at which the shoulders began to turn [s]; None if they did not."""
    contacts: int
    """Number of contacts of a part of the body with an object."""
    max_force_n: float
    """Greatest force of a contact in one step of the physics [N]. It depends on the length of the step and on how stiff contacts are;
    the impulse and the energy below depend on them much less."""
    impulse_n_s: float
    """The forces of all contacts, summed over time [N s]."""
    impact_j: float
    """How hard the contacts were [J]: the sum of J² / 2m, for the impulse J of each contact from its start to its end, and the mass m of
    the body. Each is the energy of the body at a speed that this impulse could stop."""
    clearance_left_m: float | None
    """Smallest distance between any part of the body and the left segment of the wall, while a part of the body was between its
    faces [m]; None if no part of it entered the doorway: a body that leans against the wall beside it did not."""
    clearance_right_m: float | None
    """Smallest distance between any part of the body and the right segment of the wall, while a part of the body was between its
    faces [m]; None if no part of it entered the doorway: a body that leans against the wall beside it did not."""
    speed_m_s: float | None
    """Mean walking speed [m/s], from setting out until it reached the wall, otherwise until the end."""
    time_s: float
    """Duration of the run [s]."""

    def __str__(self) -> str:
        lines = [f"{self.outcome} after {self.time_s:.2f} s"]
        if self.peak_angle_deg is not None:
            wall = "" if self.wall_angle_deg is None else f", {self.wall_angle_deg:.1f} at the wall"
            lines.append(f"  shoulders turned by {self.peak_angle_deg:.1f} degrees{wall}")
        if self.onset_distance_m is not None:
            lines.append(f"  the turn began {self.onset_distance_m:.2f} m before the wall, at {self.onset_time_s:.2f} s")
        if self.clearance_left_m is not None and self.clearance_right_m is not None:
            lines.append(f"  room on the left {100 * self.clearance_left_m:.1f} cm, on the right {100 * self.clearance_right_m:.1f} cm")
        if self.speed_m_s is not None:
            lines.append(f"  walked at {self.speed_m_s:.2f} m/s")
        if self.contacts:
            lines.append(f"  touched something {self.contacts} times, with up to {self.max_force_n:.0f} N, {self.impact_j:.1f} J in all")
        return "\n".join(lines)


Forces = Mapping[tuple[str, str], float]
"""By part of the body and touched object, the force between them [N]."""
_NONE: Forces = {}
"""No contacts."""


@measure
class Passage:
    """Measures one body at one aperture, at every physics step.

    Args:
        body: The name of the body; it has shoulders.
        aperture: The name of the aperture.
    """

    def __init__(self, body: str, aperture: str = "aperture") -> None:
        self._names = body, aperture
        self._table: NDArray[np.float64] = np.empty((ROWS, COLUMNS))
        """The beginnings of the physics steps on the way, in their order; only the first `_count` rows are in use. The columns:

        - `END`: the end of the physics step [s], `DURATION`: its duration [s].
        - `BEFORE`: the distance of the axis before the wall [m].
        - `ANGLE`: between shoulder line and wall [rad].
        - `LOGGED`: of torso plus clavicle, and the stance [rad]; `TURNED`: the same without the part that gait adds [rad].
        - `ENTERED`: 1 if a part of the body has been in the doorway. One that leans against the wall beside it is pressed between the
          faces, too.
        - `LEFT`, `RIGHT`: the room to the segments [m]; NaN while no part of the body is between the faces of the wall.
        """
        self._count = 0
        self._forces: dict[float, Forces] = {}
        """By the end of a physics step with contacts [s], their forces."""

    def begin(self, world: World) -> None:
        """Finds body and aperture.

        Raises:
            WorldError: If they do not exist, or the body has no shoulders.
        """
        body, aperture = self._names
        self._world, self._body = world, world.bodies[body]
        data = world.mj_data
        self._data, self._options, self._contacts = data, world.mj_model.opt, self._body.contacts
        axis = data.xpos[self._body.root]
        wall = next((part for part in world.scene.parts if isinstance(part, Aperture) and part.name == aperture), None)
        if wall is None:
            raise WorldError(f"no aperture '{aperture}' in this scene to measure a passage through")
        middle = *wall.position, math.cos(wall.heading), math.sin(wall.heading)
        model = world.mj_model
        joints = [f"{side}_shoulder_joint" for side in ("left", "right")]
        geoms = {self._body.geom_name(geom): geom for geom in self._body.geoms.tolist()}
        if not geoms.keys() >= {*joints}:
            raise WorldError(f"body '{body}' has no shoulders to measure")
        shoulders = [data.geom_xpos[geoms[name]] for name in joints]
        self._clearance = Clearance(model, data, self._body.geoms, wall.gap_in(model))
        hinges = {"stance_yaw": 1.0, "torso_yaw": 1.0, "left_shoulder_yaw": 0.5, "right_shoulder_yaw": 0.5}
        turning = [(joint.q, joint.v, hinges[name]) for name, joint in self._body.joints.items() if name in hinges]
        rows = np.array([row[:2] for row in turning], dtype=np.intp).reshape(-1, 2), np.array([row[2] for row in turning])
        stepping, added = self._body.hold.added_by_gait
        gait = added, np.array([hinges.get(name, 0.0) for name in stepping])
        start = axis[:2].copy(), self._body.base.v, 2.0 + wall.thickness
        self._read: tuple[Any, ...] = *start, axis, *shoulders, data.qpos, data.qvel, *rows, *gait, *middle
        """What `take_sample` reads."""
        self._mass = float(model.body_subtreemass[self._body.root])
        self._away = math.inf, math.inf

    def look(self) -> None:
        """Adds a sample of a physics step, once the body has set out; it replaces earlier samples of that time."""
        end, ago, number = self._data.time, self._options.timestep, self._count
        if number == len(self._table):
            self._table = np.resize(self._table, (2 * number + ROWS, COLUMNS))
        seen = take_sample()(self._table, number, end, ago, *self._read)
        if seen == AGAIN:
            number = self._number_until(end - ago)
            self._remove(number, self._number_until(end))
            table = np.insert(self._table, number, 0.0, axis=0)
            seen = take_sample()(table, number, end, ago, *self._read)
            if seen >= FAR:
                self._table = table
        if seen < FAR:
            return
        self._count += 1
        if seen == NEAR:
            self._measure_room(number, end - ago)
        if self._data.ncon and (touches := self._contacts.touches()):
            self._forces[end] = {(touch.part, touch.other): touch.force for touch in touches}

    def _remove(self, first: int, last: int) -> None:
        """Removes the samples from number `first` to before `last`."""
        for time in self._table[first:last, END].tolist():
            self._forces.pop(time, None)
        self._table = np.delete(self._table, slice(first, last), axis=0)
        self._count -= last - first

    def _number_until(self, time: float) -> int:
        """Returns the number of samples up to a time [s]."""
        return int(np.searchsorted(self._table[: self._count, END], time + TINY, side="right"))

    def _measure_room(self, number: int, time: float) -> None:
        """Adds to a sample of a time [s] the room on both sides, if a part of the body is between the faces of the wall; else notes until
        when none can be there."""
        left, back = self._away
        if left <= time < back:
            return
        held = self._contacts.held()
        distance = self._clearance.distance_to_wall(held)
        if distance > 0:
            self._away = time, time + distance / FASTEST
            return
        sample = self._table[number]
        sample[LEFT:] = room = self._clearance.to_segments(held)
        if not sample[ENTERED]:
            sample[ENTERED] = self._clearance.is_inside(room, held)

    def result(self, *, over: bool) -> PassageResult:
        """Returns the result up to now."""
        now = float(self._world.mj_data.time)
        samples = self._table[: self._number_until(now)]
        before, time = samples[:, BEFORE], samples[:, END] - samples[:, DURATION]
        behind = (before <= 0).nonzero()[0]
        reached = samples[behind[0]] if len(behind) else None
        last = int(behind[0]) if len(behind) else len(samples) - 1
        way, walked = (before.item(0) - before.item(last), time.item(last) - time.item(0)) if len(samples) else (0.0, 0.0)
        onset = _onset(np.abs(samples[:, TURNED]))
        between = samples[~np.isnan(samples[:, LEFT])] if len(samples) and samples[-1, ENTERED] else samples[:0]
        impulses = self._impulses(samples)
        forces = (max(forces.values()) for end, forces in self._forces.items() if end <= now + TINY)
        return PassageResult(
            outcome=_outcome(samples[-1] if len(samples) else None, over),
            peak_angle_deg=_degrees(samples[:, ANGLE].max()) if len(samples) else None,
            wall_angle_deg=_degrees(reached[ANGLE]) if reached is not None else None,
            logged_angle_deg=_degrees(abs(reached[LOGGED])) if reached is not None else None,
            onset_distance_m=round(before.item(onset), 4) if onset is not None else None,
            onset_time_s=round(time.item(onset), 3) if onset is not None else None,
            contacts=len(impulses),
            max_force_n=round(max(forces, default=0.0), 1),
            impulse_n_s=round(math.fsum(impulses), 2),
            impact_j=round(math.fsum(impulse**2 for impulse in impulses) / (2 * self._mass), 3),
            clearance_left_m=round(between[:, LEFT].min().item(), 4) if len(between) else None,
            clearance_right_m=round(between[:, RIGHT].min().item(), 4) if len(between) else None,
            speed_m_s=round(way / walked, 3) if walked else None,
            time_s=round(now, 3),
        )

    def _impulses(self, samples: NDArray[np.float64]) -> list[float]:
        """Returns the impulse of each contact in some samples, from its start to its end [N s]."""
        ended: list[float] = []
        present: dict[tuple[str, str], float] = {}
        if not self._forces:
            return ended
        for end, duration in samples[:, (END, DURATION)].tolist():
            forces = self._forces.get(end, _NONE)
            if forces or present:
                ended += [impulse for pair, impulse in present.items() if pair not in forces]
                present = {pair: present.get(pair, 0.0) + force * duration for pair, force in forces.items()}
        return [*ended, *present.values()]


def _onset(angles: NDArray[np.float64]) -> int | None:
    """Returns the number of the first sample of the turn that leads to the greatest angle; None if the shoulders never turn."""
    number = int(angles.argmax()) if len(angles) else 0
    if not len(angles) or angles[number] < LEAST_TURN:
        return None
    less = (angles[:number] < LEAST_TURN).nonzero()[0]
    return int(less[-1]) + 1 if len(less) else 0


def _outcome(last: NDArray[np.float64] | None, over: bool) -> Literal["passed", "declined", "stopped"]:
    if last is None:
        return "declined" if over else "stopped"
    return "passed" if last[BEFORE] < 0 and math.isnan(last[LEFT]) else "stopped"


def _degrees(angle: np.float64) -> float:
    return round(math.degrees(angle), 2)
