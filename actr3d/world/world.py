"""A compiled scene and its state, stepped in whole microseconds."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel
from numpy.typing import NDArray

from actr3d.clock import seconds
from actr3d.errors import WorldError, did_you_mean
from actr3d.world.anatomy import Embodied
from actr3d.world.body import Body, BodyState
from actr3d.world.compiled import Changes, Compiled
from actr3d.world.pace import Pace
from actr3d.world.parts import Aperture
from actr3d.world.running import Running
from actr3d.world.scene import Scene
from actr3d.world.sensors.touch import step_and_feel
from actr3d.world.servo import fit_servos

_DIVERGED = slice(int(mujoco.mjtWarning.mjWARN_BADQPOS), int(mujoco.mjtWarning.mjWARN_BADQACC) + 1)
"""MuJoCo's warnings of NaN or huge positions, velocities, accelerations: it resets the state then."""

PRESSED = 0.01
"""How deep the walls of an aperture may come into something when its width is set [m]: contacts as stiff as theirs push that out
at less than 3 m/s, but fling away, or crush without bounds, what is deeper. Ours."""

_INTEGRATION = int(mujoco.mjtState.mjSTATE_INTEGRATION)


@dataclass(frozen=True, kw_only=True)
class WorldState:
    """All that a world needs to go on exactly from a moment."""

    steps: int
    """Physics steps since the start."""

    scene: str
    """The fingerprint of the compiled scene that it is of."""

    mj_state: NDArray[np.float64]
    """`mjSTATE_INTEGRATION` of the data; less than that drifts (platform-facts)."""

    bodies: tuple[tuple[str, BodyState], ...] = ()
    """Of each body, what the physics does not hold: commands on their way, noise, what hands hold."""

    compiled: Changes = ()
    """What is not as it was compiled; see `Compiled`."""


class World:
    """Holds the compiled scene (`mj_model`) and its state (`mj_data`), and steps them.

    Args:
        scene: What is in it.
        seed: Where the noise of sensors comes from.

    Raises:
        WorldError: If MuJoCo cannot compile the scene, and says what MuJoCo said; if it is none; or if the seed is
            not a whole number from 0 on.
    """

    def __init__(self, scene: Scene, seed: int = 0) -> None:
        if not isinstance(seed, int) or seed < 0:  # pyright: ignore[reportUnnecessaryIsInstance] # it may come from a file
            raise WorldError(f"the seed of a world must be a whole number from 0 on (got {seed!r})")
        if not isinstance(scene, Scene):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise WorldError(f"a world is made of a Scene (got {scene!r})")
        self.scene = scene
        self.seed = seed
        try:
            self.mj_model: MjModel = scene.specification().compile()
        except ValueError as error:
            raise WorldError(f"the scene cannot be compiled: {error}") from error
        self.mj_data = MjData(self.mj_model)
        self._steps = 0
        self.moment = 0
        """Counts the states it comes through: what was read of an earlier one is stale."""
        self._refreshed = False
        self._solved = False
        self._scratch: MjData | None = None
        self._state_size: int = mujoco.mj_stateSize(self.mj_model, mujoco.mjtState.mjSTATE_INTEGRATION)
        self._apertures = {part.name: part for part in scene.parts if isinstance(part, Aperture)}
        self._state_numbers = np.empty(self._state_size)
        self._warnings: NDArray[np.int32] = self.mj_data.warning.number[_DIVERGED]
        mujoco.mj_forward(self.mj_model, self.mj_data)
        self.owners: tuple[str, ...] = tuple(self._owner(geom) for geom in range(self.mj_model.ngeom))
        """By geom: what the object is called that it belongs to; a geom that lies in the world itself has its own name."""
        self.soft: NDArray[np.intp] = self.mj_model.flex_vertbodyid[self.mj_model.flex_vertadr].astype(np.intp)
        """By flex, MuJoCo's soft thing: the MuJoCo body of its first vertex; its contacts have no geom."""
        described = [part for part in scene.parts if isinstance(part, Embodied)]
        for part in described:
            fit_servos(self.mj_model, self.mj_data, part.anatomy().servos)
        self.bodies: dict[str, Body] = {part.name: Body(self, part) for part in described}
        self._compiled = Compiled(self.mj_model)
        self._pace = Pace(self, list(self.bodies.values()))
        self.watchers: list[Callable[[], None]] = []
        """Who looks at every physics step, or part of one, and changes nothing: called after each. The geometry, contacts and forces
        of `mj_data` are those of its beginning then, `time` and `opt.timestep` tell when it ended and how long it was."""
        self.drawing: Any = None
        """What draws pictures, once one has been asked for."""

    @property
    def fingerprint(self) -> str:
        """Two worlds have the same one where their scenes are compiled to the same bytes."""
        return self._compiled.fingerprint

    @property
    def time(self) -> int:
        """Time since the start [us], counted in whole steps: it cannot drift."""
        return self._steps * self.scene.timestep_us

    def step(self, steps: int = 1) -> None:
        """Advances the physics by a number of steps: one tick, whose touches the skin remembers. Commands that are on their way
        choose their speeds before it, and in a long one every 10 ms.

        Raises:
            WorldError: If the physics diverges (MuJoCo finds NaN or huge values and would reset), or the number is not one.
        """
        if not isinstance(steps, int) or steps < 0:  # pyright: ignore[reportUnnecessaryIsInstance]
            raise WorldError(f"the physics goes on by a whole number of steps (got {steps!r})")
        running = [body.running for body in self.bodies.values() if body.running]
        feeling = [body for body in self.bodies.values() if body.touched is not None]
        taken = self._stepped(steps, running) if running else self._pace.steps(steps)
        taken = self._watched(taken) if self.watchers else taken
        if feeling:
            step_and_feel(taken, feeling)
        else:
            for _ in taken:
                pass
        self._steps += steps
        self.changed()
        if np.count_nonzero(self._warnings):
            raise WorldError(f"the physics diverged near {seconds(self.time)} s{self._culprit()}: forces or speeds without bounds")

    def _stepped(self, steps: int, running: list[Running]) -> Iterator[None]:
        """Takes steps while commands are on their way, which look every 10 ms how far they are: a brake must not go on backwards."""
        for count in self._pace.stretches(steps):
            for commands in running:
                commands.before_step(count * self.scene.timestep)
            yield from self._pace.steps(count)
            for commands in running:
                commands.after_step()
                self.changed()

    def _watched(self, taken: Iterator[None]) -> Iterator[None]:
        for _ in taken:
            for watcher in self.watchers:
                watcher()
            yield

    def changed(self) -> None:
        """Notes that positions, speeds or commands are not those that were last computed with."""
        self._refreshed = self._solved = False
        self.moment += 1

    def refresh(self) -> None:
        """Brings positions, contacts and rays up to date with the state, once a state.

        After a step, MuJoCo's geometry (`xpos`, contacts) is that of the positions before it.
        """
        if not self._refreshed:
            mujoco.mj_fwdPosition(self.mj_model, self.mj_data)
            self._refreshed = True

    def solve(self) -> None:
        """Brings forces and accelerations up to date with the state too, once a state; what follows is not changed by it."""
        self.refresh()
        if not self._solved:
            start = self.mj_data.qacc_warmstart.copy()  # part of the state, from which the next step's solver starts
            mujoco.mj_forwardSkip(self.mj_model, self.mj_data, mujoco.mjtStage.mjSTAGE_POS, 1)
            self.mj_data.qacc_warmstart[:] = start
            self._solved = True

    def accelerations(self) -> NDArray[np.float64]:
        """Returns the accelerations (nv,) with which the coming physics step changes the speeds [m/s^2, rad/s^2].

        MuJoCo's `qacc` leaves out that the integrator is implicit: with stiff servos it is not what happens.
        """
        if self._scratch is None:
            self._scratch = MjData(self.mj_model)
        mujoco.mj_setState(self.mj_model, self._scratch, self._integration(), mujoco.mjtState.mjSTATE_INTEGRATION)
        mujoco.mj_step(self.mj_model, self._scratch)
        return (self._scratch.qvel - self.mj_data.qvel) / self.mj_model.opt.timestep

    def state(self) -> WorldState:
        """Returns the present state, apart from the world: later steps do not change it."""
        bodies = tuple((name, body.state()) for name, body in self.bodies.items())
        compiled = self._compiled.changes()
        return WorldState(steps=self._steps, scene=self.fingerprint, mj_state=self._integration(), bodies=bodies, compiled=compiled)

    def _integration(self) -> NDArray[np.float64]:
        numbers = np.empty(self._state_size)
        mujoco.mj_getState(self.mj_model, self.mj_data, numbers, mujoco.mjtState.mjSTATE_INTEGRATION)
        return numbers

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
        if state.scene != self.fingerprint:
            raise WorldError(f"the state is of another scene: that one compiles to {state.scene}, this one to {self.fingerprint}")
        self._compiled.restore(state.compiled)
        mujoco.mj_setState(self.mj_model, self.mj_data, state.mj_state, mujoco.mjtState.mjSTATE_INTEGRATION)
        self._warnings[:] = 0
        self._steps = state.steps
        for name, body_state in state.bodies:
            self.bodies[name].restore(body_state)
        self.changed()

    def aperture_width(self, name: str = "aperture") -> float:
        """Returns the free width of an aperture [m].

        Raises:
            WorldError: If there is no such aperture.
        """
        aperture = self._aperture(name)
        return aperture.width_of(tuple(self.mj_data.mocap_pos[self._mocap(f"{name}_left")]))

    def set_aperture_width(self, width: float, name: str = "aperture") -> None:
        """Sets the free width of an aperture [m], at once; no closer than what stands in it lets it.

        Raises:
            WorldError: If there is no such aperture, or something that can move is in the way of its segments; they stay then.
            ConfigurationError: If the width is not a number of at least 0.
        """
        aperture = replace(self._aperture(name), width=width)
        sides = [self._mocap(f"{name}_{side}") for side in ("left", "right")]
        before, depths = self.mj_data.mocap_pos[sides].copy(), self._pressed_by(sides)
        self.mj_data.mocap_pos[sides] = list(aperture.segment_positions(aperture.width).values())
        self.changed()
        deep = {other: depth for other, depth in self._pressed_by(sides).items() if depth > max(PRESSED, depths.get(other, 0))}
        if deep:
            self.mj_data.mocap_pos[sides] = before
            self.changed()
            raise WorldError(f"aperture '{name}' cannot be {aperture.width:g} m wide now: {', '.join(deep)} would be inside its walls")

    def _pressed_by(self, mocaps: list[int]) -> dict[str, float]:
        """Returns how deep some mocap bodies are in each object that can move [m], by its name."""
        self.refresh()
        model, contacts = self.mj_model, self.mj_data.contact
        depths: dict[str, float] = {}
        pairs: list[list[int]] = contacts.geom.tolist()
        for pair, distance in zip(pairs, contacts.dist.tolist(), strict=True):
            bodies = [int(model.geom_bodyid[geom]) if geom >= 0 else 0 for geom in pair]
            for one, other in ((0, 1), (1, 0)):
                if int(model.body_mocapid[bodies[one]]) in mocaps and model.body_treeid[bodies[other]] >= 0:
                    name = self.owners[pair[other]]
                    depths[name] = max(depths.get(name, 0.0), -distance)
        return depths

    def loose(self, name: str) -> int:
        """Returns the MuJoCo body of an object that lies loose.

        Raises:
            WorldError: If there is no such object, or it is fixed.
        """
        model = self.mj_model
        free = {
            str(model.body(int(model.jnt_bodyid[n])).name): int(model.jnt_bodyid[n]) for n in range(model.njnt) if model.jnt_type[n] == 0
        }
        if str(name) not in free:
            raise WorldError(f"no loose object '{name}' in this scene{did_you_mean(str(name), free)}")
        return free[name]

    def other_side(self, contact: int, side: int) -> str:
        """Returns what the object is called that is on one side (0 or 1) of a contact."""
        geom = int(self.mj_data.contact.geom[contact, side])
        return self.owners[geom] if geom >= 0 else self._root_name(int(self.soft[self.mj_data.contact.flex[contact, side]]))

    def _root_name(self, body: int) -> str:
        return str(self.mj_model.body(int(self.mj_model.body_rootid[body])).name)

    def _owner(self, geom: int) -> str:
        body = int(self.mj_model.geom_bodyid[geom])
        return self._root_name(body) if body else str(self.mj_model.geom(geom).name)

    def _aperture(self, name: str) -> Aperture:
        if not isinstance(name, str) or name not in self._apertures:  # pyright: ignore[reportUnnecessaryIsInstance]
            raise WorldError(f"no aperture '{name}' in this scene{did_you_mean(str(name), self._apertures)}")
        return self._apertures[name]

    def _culprit(self) -> str:
        """Returns which object has the number that MuJoCo found to be no good."""
        model: Any = self.mj_model
        kind = int(np.argmax(self._warnings))
        number = int(self.mj_data.warning.lastinfo[_DIVERGED][kind])
        # MuJoCo counts the first kind, bad positions, by position, the others by degree of freedom.
        joint = int(np.searchsorted(model.jnt_qposadr, number, side="right")) - 1 if kind == 0 else int(model.dof_jntid[number])
        return f", at '{self._root_name(int(model.jnt_bodyid[joint]))}'"

    def _mocap(self, name: str) -> int:
        body: Any = self.mj_model.body(name)
        return int(self.mj_model.body_mocapid[body.id])
