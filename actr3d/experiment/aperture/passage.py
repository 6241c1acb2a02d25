"""Measures a body's passage through an aperture, from the state of the world."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from actr3d.errors import WorldError
from actr3d.experiment.aperture.clearance import Clearance
from actr3d.experiment.aperture.kernel import posture
from actr3d.simulation.measure import measure
from actr3d.world import World
from actr3d.world.scene_objects import Aperture

SET_OUT = 0.05
"""Distance from the start after which a body has set out [m]. Source: chosen for this library."""
STANDS = 0.01
"""Speed below which a body stands [m/s]. Source: chosen for this library; less than any walk."""
FASTEST = 20.0
"""No part of a body moves faster than this [m/s]. Source: chosen; a swinging arm reaches a few metres a second."""
TINY = 1e-9
"""Less than any physics step [s]."""
TURNED = math.radians(1)
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


class _Sample(NamedTuple):
    """The beginning of a physics step on the way."""

    end: float
    """The end of the physics step [s]."""
    time: float
    """Its beginning [s]."""
    before: float
    """Distance of the axis before the wall [m]."""
    angle: float
    """Between shoulder line and wall [rad]."""
    logged: float
    """Torso plus clavicle, and the stance [rad]."""
    turned: float
    """The same without the part that gait adds [rad]."""
    room: tuple[float, float] | None
    """To the left and right segment [m], while a part of the body is between the faces of the wall."""
    entered: bool
    """Whether a part of the body has been in the doorway; one that leans against the wall beside it is pressed between the faces, too."""
    duration: float
    """Of the physics step [s]."""
    forces: Forces
    """Of its contacts."""


@measure
class Passage:
    """Measures one body at one aperture, at every physics step.

    Args:
        body: The name of the body; it has shoulders.
        aperture: The name of the aperture.
    """

    def __init__(self, body: str, aperture: str = "aperture") -> None:
        self._names = body, aperture
        self._samples: list[_Sample] = []

    def begin(self, world: World) -> None:
        """Finds body and aperture.

        Raises:
            WorldError: If they do not exist, or the body has no shoulders.
        """
        body, aperture = self._names
        self._world, self._body = world, world.bodies[body]
        data = world.mj_data
        self._data, self._options, self._contacts = data, world.mj_model.opt, self._body.contacts
        self._axis, self._qvel = data.xpos[self._body.root], data.qvel
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
        self._read = self._axis, *shoulders, data.qpos, data.qvel, *rows, *middle
        """What `posture` reads."""
        self._stepping = [(name, share) for name, share in hinges.items() if self._body.hold.gait_moves(name)]
        self._mass = float(model.body_subtreemass[self._body.root])
        x, y, _ = self._axis.tolist()
        self._start = x, y
        self._slide = self._body.base.v
        self._reach = 2.0 + wall.thickness
        self._away = math.inf, math.inf

    def look(self) -> None:
        """Stores a sample of a physics step, once the body has set out; it replaces earlier samples of that time."""
        end, ago, samples = self._data.time, self._options.timestep, self._samples
        x, y, _ = self._axis.tolist()
        number = len(samples)
        if number and end <= samples[-1].end + TINY:  # the run has gone back
            number = self._number_until(end - ago)
            del samples[number : self._number_until(end)]
        if math.dist((x, y), self._start) < SET_OUT:
            return
        if not number and math.hypot(self._qvel[self._slide], self._qvel[self._slide + 1]) < STANDS:
            self._start = x, y  # it was put elsewhere before it set out
        else:
            samples.insert(number, self._sample(end, ago, number > 0 and samples[number - 1].entered))

    def _number_until(self, time: float) -> int:
        """Returns the number of samples up to a time [s]."""
        return bisect_right(self._samples, time + TINY, key=lambda sample: sample.end)

    def _sample(self, end: float, ago: float, entered: bool) -> _Sample:
        """Returns the sample of a physics step.

        Args:
            end: The time of the joints [s].
            ago: By how much they are ahead of the geometry [s].
            entered: Whether a part of the body has been in the doorway before.
        """
        time = end - ago
        before, angle, logged = posture()(*self._read, ago)
        turned = logged
        for name, share in self._stepping:
            turned -= share * self._body.hold.added_by_gait(name)
        left, back = self._away
        room = self._room(time) if abs(before) < self._reach and not left <= time < back else None
        if room is not None and not entered:
            entered = self._clearance.is_inside(room, self._contacts.held())
        touches = self._contacts.touches() if self._data.ncon else ()
        forces = {(touch.part, touch.other): touch.force for touch in touches} if touches else _NONE
        return _Sample(end, time, before, angle, logged, turned, room, entered, ago, forces)

    def _room(self, time: float) -> tuple[float, float] | None:
        """Returns the distances to the wall on both sides [m]; None if no part of the body is between its faces: then it notes until when
        none can be there."""
        held = self._contacts.held()
        distance = self._clearance.distance_to_wall(held)
        if distance <= 0:
            return self._clearance.to_segments(held)
        self._away = time, time + distance / FASTEST
        return None

    def result(self, *, over: bool) -> PassageResult:
        """Returns the result up to now."""
        now = float(self._world.mj_data.time)
        samples = self._samples[: self._number_until(now)]
        at_wall = next((sample for sample in samples if sample.before <= 0), None)
        onset = _onset(samples)
        rooms = [sample.room for sample in samples if sample.room is not None] if samples and samples[-1].entered else []
        impulses = _impulses(samples)
        last = at_wall or (samples[-1] if samples else None)
        way = samples[0].before - last.before if last is not None else 0.0
        walked = last.time - samples[0].time if last is not None else 0.0
        return PassageResult(
            outcome=_outcome(samples[-1] if samples else None, over),
            peak_angle_deg=_degrees(max(sample.angle for sample in samples)) if samples else None,
            wall_angle_deg=_degrees(at_wall.angle) if at_wall else None,
            logged_angle_deg=_degrees(abs(at_wall.logged)) if at_wall else None,
            onset_distance_m=round(onset.before, 4) if onset else None,
            onset_time_s=round(onset.time, 3) if onset else None,
            contacts=len(impulses),
            max_force_n=round(max((force for sample in samples for force in sample.forces.values()), default=0.0), 1),
            impulse_n_s=round(math.fsum(impulses), 2),
            impact_j=round(math.fsum(impulse**2 for impulse in impulses) / (2 * self._mass), 3),
            clearance_left_m=round(min(left for left, _ in rooms), 4) if rooms else None,
            clearance_right_m=round(min(right for _, right in rooms), 4) if rooms else None,
            speed_m_s=round(way / walked, 3) if walked else None,
            time_s=round(now, 3),
        )


def _onset(samples: list[_Sample]) -> _Sample | None:
    """Returns the first sample of the turn that leads to the greatest angle; None if the shoulders never turn."""
    angles = [abs(sample.turned) for sample in samples]
    number = angles.index(max(angles)) if angles else -1
    if number < 0 or angles[number] < TURNED:
        return None
    while number and angles[number - 1] >= TURNED:
        number -= 1
    return samples[number]


def _impulses(samples: list[_Sample]) -> list[float]:
    """Returns the impulse of each contact, from its start to its end [N s]."""
    ended: list[float] = []
    present: dict[tuple[str, str], float] = {}
    for sample in samples:
        if sample.forces or present:
            ended += [impulse for pair, impulse in present.items() if pair not in sample.forces]
            present = {pair: present.get(pair, 0.0) + force * sample.duration for pair, force in sample.forces.items()}
    return [*ended, *present.values()]


def _outcome(last: _Sample | None, over: bool) -> Literal["passed", "declined", "stopped"]:
    if last is None:
        return "declined" if over else "stopped"
    return "passed" if last.before < 0 and last.room is None else "stopped"


def _degrees(angle: float) -> float:
    return round(math.degrees(angle), 2)
