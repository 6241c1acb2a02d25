"""A compiled scene and its state, stepped in whole microseconds."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel
from numpy.typing import NDArray

from actr3d.clock import seconds
from actr3d.errors import WorldError, did_you_mean
from actr3d.world.parts import Aperture
from actr3d.world.scene import Scene

_DIVERGED = slice(int(mujoco.mjtWarning.mjWARN_BADQPOS), int(mujoco.mjtWarning.mjWARN_BADQACC) + 1)
"""MuJoCo's warnings of NaN or huge positions, velocities, accelerations: it resets the state then."""

_INTEGRATION = int(mujoco.mjtState.mjSTATE_INTEGRATION)


@dataclass(frozen=True, kw_only=True)
class WorldState:
    """All that a world needs to go on exactly from a moment."""

    steps: int
    """Physics steps since the start."""

    mj_state: NDArray[np.float64]
    """`mjSTATE_INTEGRATION` of the data; less than that drifts (platform-facts)."""


class World:
    """Holds the compiled scene (`mj_model`) and its state (`mj_data`), and steps them.

    Args:
        scene: What is in it.

    Raises:
        WorldError: If MuJoCo cannot compile the scene; says what MuJoCo said.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        try:
            self.mj_model: MjModel = scene.specification().compile()
        except ValueError as error:
            raise WorldError(f"the scene cannot be compiled: {error}") from error
        self.mj_data = MjData(self.mj_model)
        self._steps = 0
        self._refreshed = -1
        self._mocap_moved = False
        self._state_size: int = mujoco.mj_stateSize(self.mj_model, mujoco.mjtState.mjSTATE_INTEGRATION)
        self._apertures = {part.name: part for part in scene.parts if isinstance(part, Aperture)}
        self._state_numbers = np.empty(self._state_size)
        self._warnings: NDArray[np.int32] = self.mj_data.warning.number[_DIVERGED]
        self.bodies: dict[str, Any] = {}
        """The bodies by name."""
        mujoco.mj_forward(self.mj_model, self.mj_data)

    @property
    def time(self) -> int:
        """Time since the start [us], counted in whole steps: it cannot drift."""
        return self._steps * self.scene.timestep_us

    def step(self, steps: int = 1) -> None:
        """Advances the physics by a number of steps.

        Raises:
            WorldError: If the physics diverges (MuJoCo finds NaN or huge values and would reset).
        """
        mujoco.mj_step(self.mj_model, self.mj_data, nstep=steps)
        self._steps += steps
        if self._warnings.any():
            raise WorldError(f"the physics diverged near {seconds(self.time)} s: forces or speeds without bounds")

    def refresh(self) -> None:
        """Brings positions, contacts and rays up to date with the state, once a state.

        After a step, MuJoCo's geometry (`xpos`, contacts) is that of the positions before it.
        """
        if self._refreshed != self._steps or self._mocap_moved:
            mujoco.mj_fwdPosition(self.mj_model, self.mj_data)
            self._refreshed = self._steps
            self._mocap_moved = False

    def state(self) -> WorldState:
        """Returns the present state, apart from the world: later steps do not change it."""
        mj_state = np.empty(self._state_size)
        mujoco.mj_getState(self.mj_model, self.mj_data, mj_state, mujoco.mjtState.mjSTATE_INTEGRATION)
        return WorldState(steps=self._steps, mj_state=mj_state)

    def state_bytes(self) -> bytes:
        """Returns the numbers of the present state, which are all but how many steps it took, as a recording keeps them."""
        mujoco.mj_getState(self.mj_model, self.mj_data, self._state_numbers, _INTEGRATION)
        return self._state_numbers.tobytes()

    def restore(self, state: WorldState) -> None:
        """Brings the world to a state of its own; going on from there gives the same bytes as the first time.

        Raises:
            WorldError: If the state is of another scene.
        """
        if state.mj_state.shape != (self._state_size,):
            raise WorldError(f"a state of this world has {self._state_size} numbers (got {state.mj_state.size}): is it of another scene?")
        mujoco.mj_setState(self.mj_model, self.mj_data, state.mj_state, mujoco.mjtState.mjSTATE_INTEGRATION)
        self._steps = state.steps
        self._refreshed = -1

    def aperture_width(self, name: str = "aperture") -> float:
        """Returns the free width of an aperture [m].

        Raises:
            WorldError: If there is no such aperture.
        """
        aperture = self._aperture(name)
        return aperture.width_of(tuple(self.mj_data.mocap_pos[self._mocap(f"{name}_left")]))

    def set_aperture_width(self, width: float, name: str = "aperture") -> None:
        """Sets the free width of an aperture [m], at once.

        Raises:
            WorldError: If there is no such aperture.
            ConfigurationError: If the width is not a number of at least 0.
        """
        aperture = replace(self._aperture(name), width=width)
        for side, position in aperture.segment_positions(aperture.width).items():
            self.mj_data.mocap_pos[self._mocap(f"{name}_{side}")] = position
        self._mocap_moved = True

    def _aperture(self, name: str) -> Aperture:
        if name not in self._apertures:
            raise WorldError(f"no aperture '{name}' in this scene{did_you_mean(name, self._apertures)}")
        return self._apertures[name]

    def _mocap(self, name: str) -> int:
        body: Any = self.mj_model.body(name)
        return int(self.mj_model.body_mocapid[body.id])
