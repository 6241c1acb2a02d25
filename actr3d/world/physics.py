"""The compiled scene, its state, and what follows from the state: computed once for each state."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Never

import mujoco
import numpy as np
from mujoco import MjData, MjModel, mjtState
from numpy.typing import NDArray

from actr3d.errors import WorldError, did_you_mean
from actr3d.world.frames import turn_to
from actr3d.world.scene import Scene

INTEGRATION = mjtState.mjSTATE_INTEGRATION
"""The part of MuJoCo's data from which a run continues exactly; from smaller parts, it continues differently."""

_DIVERGED = slice(int(mujoco.mjtWarning.mjWARN_BADQPOS), int(mujoco.mjtWarning.mjWARN_BADQACC) + 1)
"""MuJoCo's warnings of NaN or huge positions, velocities, accelerations: it resets the state then."""

_IN_FWD_POSITION = (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_flex, mujoco.mj_tendon, mujoco.mj_makeM, mujoco.mj_collision)
"""What `mj_fwdPosition` computes, too."""


class Physics:
    """Holds the compiled scene (`mj_model`) and its state (`mj_data`), and updates derived quantities at most once per state.

    Args:
        scene: What to compile.

    Raises:
        WorldError: If MuJoCo cannot compile the scene; with MuJoCo's message.
    """

    def __init__(self, scene: Scene) -> None:
        self.mj_model: MjModel = scene.compile()
        self.mj_data = MjData(self.mj_model)
        self.timestep = scene.timestep
        """The whole physics step [s]; `mj_model.opt.timestep` is shorter while a step is divided."""
        self.timestep_us = scene.timestep_us
        """The same [us]."""
        self.steps = 0
        """Physics steps since the start."""
        self.state_number = 0
        """Number of the current state, which grows with every change; a reading made at a smaller number is out of date."""
        self._updated: set[Callable[[MjModel, MjData], None]] = set()
        """What computed those parts of what follows from the state that are up to date."""
        self._scratch: MjData | None = None
        self._numbers = np.empty(mujoco.mj_stateSize(self.mj_model, INTEGRATION))
        self._warnings: NDArray[np.int32] = self.mj_data.warning.number[_DIVERGED]
        mujoco.mj_forward(self.mj_model, self.mj_data)
        self.owners: tuple[str, ...] = tuple(self._owner(geom) for geom in range(self.mj_model.ngeom))
        """By geom: the name of the object that it belongs to; a geom of the world itself, or of a body without a name, has its own name."""
        self.soft: NDArray[np.intp] = self.mj_model.flex_vertbodyid[self.mj_model.flex_vertadr].astype(np.intp)
        """By flex, MuJoCo's soft object: the MuJoCo body of its first vertex; its contacts have no geom."""
        model, free = self.mj_model, np.flatnonzero(self.mj_model.jnt_type == int(mujoco.mjtJoint.mjJNT_FREE)).tolist()
        self.free_joints = {int(model.jnt_bodyid[n]): (int(model.jnt_qposadr[n]), int(model.jnt_dofadr[n])) for n in free}
        """By MuJoCo body with a free joint: where its pose begins in `qpos`, and its speed in `qvel`."""
        self.grasped: dict[int, int] = {}
        """By weld of a hand: the MuJoCo body that the hand holds."""
        self.pushes: tuple[tuple[int, float, float], ...] = ()
        """Forces by hand that will act in the coming physics step: the MuJoCo body, and the force along x and y [N]."""
        self.observed = False
        """Whether an observer is being called now, who must leave the world unchanged."""
        self.renderer: Any = None
        """Draws pictures; None before the first picture."""

    def __reduce__(self) -> Never:
        raise TypeError("a body, or another part of a World, cannot be copied alone; copy the World")

    @property
    def time(self) -> int:
        """Time since the start [us], counted in whole steps: it cannot drift."""
        return self.steps * self.timestep_us

    def changed(self) -> None:
        """Marks derived quantities as out of date, after positions, speeds, commands or the compiled model have changed."""
        self._updated.clear()
        self.state_number += 1

    def refresh_positions(self) -> None:
        """Updates the positions of all parts to the state, once per state: a small part of the cost of `refresh`.

        After a step, MuJoCo's geometry (`xpos`, contacts) is that of the positions before it.
        """
        self._update(mujoco.mj_kinematics)
        if self.mj_model.nflex:  # the points of soft objects are not part of the state
            self._update(mujoco.mj_comPos, mujoco.mj_flex)

    def refresh_velocities(self) -> None:
        """Updates positions and the velocities of all parts to the state, once per state."""
        self._update(mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_comVel)

    def refresh_inertia(self) -> None:
        """Updates positions and inertia to the state, once per state."""
        self._update(mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_tendon, mujoco.mj_makeM)

    def refresh_contacts(self) -> None:
        """Updates positions and contacts to the state, once per state."""
        self.refresh_positions()
        self._update(mujoco.mj_collision)

    def refresh(self) -> None:
        """Updates all that follows from the positions, such as contacts, rays and sensors of the file, to the state, once per state."""
        self._update(mujoco.mj_fwdPosition, mujoco.mj_sensorPos)
        self._updated.update(_IN_FWD_POSITION)

    def solve(self) -> None:
        """Updates forces, accelerations and all sensors of the file to the state too, once per state, without an effect on later steps."""
        self.refresh()
        self._update(_solve)

    def _update(self, *parts: Callable[[MjModel, MjData], None]) -> None:
        """Computes parts of what follows from the state, those that are out of date."""
        for part in parts:
            if part not in self._updated:
                part(self.mj_model, self.mj_data)
                self._updated.add(part)

    def accelerations(self) -> NDArray[np.float64]:
        """Returns the accelerations (nv,) with which the coming physics step changes the speeds [m/s^2, rad/s^2].

        MuJoCo's `qacc` does not include the effect of the implicit integrator; with stiff servos it differs from the real acceleration.
        """
        if self._scratch is None:
            self._scratch = MjData(self.mj_model)
        mujoco.mj_setState(self.mj_model, self._scratch, self.integration_state(), INTEGRATION)
        for body, x, y in self.pushes:
            self._scratch.xfrc_applied[body, :2] += (x, y)
        mujoco.mj_step(self.mj_model, self._scratch)
        return (self._scratch.qvel - self.mj_data.qvel) / self.mj_model.opt.timestep

    # -- the state

    def integration_state(self) -> NDArray[np.float64]:
        """Returns a copy of the numbers from which the physics continues exactly."""
        numbers = np.empty_like(self._numbers)
        mujoco.mj_getState(self.mj_model, self.mj_data, numbers, INTEGRATION)
        return numbers

    def state_bytes(self) -> bytes:
        """Returns the same numbers as bytes."""
        mujoco.mj_getState(self.mj_model, self.mj_data, self._numbers, INTEGRATION)
        return self._numbers.tobytes()

    def restore(self, numbers: NDArray[np.float64]) -> None:
        """Sets the state to numbers of `integration_state`, and clears warnings of divergence."""
        mujoco.mj_setState(self.mj_model, self.mj_data, numbers, INTEGRATION)
        self._warnings[:] = 0

    @property
    def diverged(self) -> bool:
        """Whether MuJoCo has found NaN or huge values since the last `restore`."""
        return any(self._warnings.tolist())

    def diverged_object(self) -> str:
        """Returns the name of the object in which MuJoCo found NaN or a huge value."""
        model: Any = self.mj_model
        kind = int(np.argmax(self._warnings))
        number = int(self.mj_data.warning.lastinfo[_DIVERGED][kind])
        # MuJoCo counts the first kind, bad positions, by position, the others by degree of freedom.
        joint = int(np.searchsorted(model.jnt_qposadr, number, side="right")) - 1 if kind == 0 else int(model.dof_jntid[number])
        return self._root_name(int(model.jnt_bodyid[joint]))

    # -- objects

    @property
    def solid(self) -> NDArray[np.bool_]:
        """By geom (ngeom,): whether it has contacts."""
        return (self.mj_model.geom_contype | self.mj_model.geom_conaffinity) != 0

    def loose(self, name: str) -> int:
        """Returns the MuJoCo body of a loose object.

        Raises:
            WorldError: If there is no such object, or it is fixed.
        """
        free = {str(self.mj_model.body(body).name): body for body in self.free_joints}
        if str(name) not in free:
            raise WorldError(f"no loose object '{name}' in this scene{did_you_mean(str(name), free)}")
        return free[str(name)]

    def put_loose(self, body: int, x: float, y: float, heading: float | None) -> None:
        """Puts a MuJoCo body with a free joint at (x, y) [m], with a heading [rad] or its present one, at rest."""
        q, v = self.free_joints[body]
        self.mj_data.qpos[q : q + 2] = (x, y)
        self.mj_data.qvel[v : v + 6] = 0
        if heading is not None:
            turn_to(self.mj_data.qpos[q + 3 : q + 7], heading)

    def other_side(self, contact: int, side: int) -> str:
        """Returns the name of the object on one side (0 or 1) of a contact."""
        geom = int(self.mj_data.contact.geom[contact, side])
        return self.owners[geom] if geom >= 0 else self._root_name(int(self.soft[self.mj_data.contact.flex[contact, side]]))

    def _root_name(self, body: int) -> str:
        return str(self.mj_model.body(int(self.mj_model.body_rootid[body])).name)

    def _owner(self, geom: int) -> str:
        body = int(self.mj_model.geom_bodyid[geom])
        return (body and self._root_name(body)) or str(self.mj_model.geom(geom).name)


def _solve(model: MjModel, data: MjData) -> None:
    """Computes velocities, forces and accelerations, and the sensors of these, without an effect on later steps."""
    start = data.qacc_warmstart.copy()  # part of the state, from which the next step's solver starts
    mujoco.mj_forwardSkip(model, data, mujoco.mjtStage.mjSTAGE_POS, 0)
    data.qacc_warmstart[:] = start
