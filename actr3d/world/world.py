"""A compiled scene and its state, stepped in whole microseconds."""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from numbers import Integral
from typing import Any

import numpy as np
from mujoco import MjData, MjModel
from numpy.typing import NDArray

from actr3d.clock import seconds
from actr3d.errors import WorldError, alternatives, did_you_mean
from actr3d.world.anatomy import Embodied
from actr3d.world.body import Body, BodyState
from actr3d.world.model_changes import Changes, ModelChanges
from actr3d.world.objects import Objects, Pushes, too_deep
from actr3d.world.physics import Physics
from actr3d.world.scene import Scene
from actr3d.world.scene_objects import Aperture
from actr3d.world.sensors.touch import feel_steps
from actr3d.world.substepping import Substepping
from actr3d.world.velocity_servo import fit_servos


@dataclass(frozen=True, kw_only=True, eq=False)
class WorldState:
    """All that a world needs to continue exactly from a moment. It is equal only to itself: compare its fields."""

    steps: int
    """Physics steps since the start."""

    scene: str
    """The fingerprint of the compiled scene."""

    mj_state: NDArray[np.float64]
    """`mjSTATE_INTEGRATION` of the data, see `INTEGRATION`."""

    bodies: tuple[tuple[str, BodyState], ...] = ()
    """Of each body, what is not in the physics state: unfinished commands, noise, held objects."""

    compiled: Changes = ()
    """Changes of the compiled model since the start; see `ModelChanges`."""

    pushes: tuple[tuple[int, float, float, int], ...] = ()
    """What is left of pushes by hand, from `Pushes.state`."""


class Bodies(dict[str, Body]):
    """The bodies of a world by name, in the order of the scene; a name that does not exist raises a `WorldError`."""

    def __missing__(self, name: object) -> Body:
        raise WorldError(f"no body '{name}'{alternatives(name, self)}")


class World:
    """Holds the compiled scene (`mj_model`) and its state (`mj_data`), and steps them.

    A copy (shallow, deep or pickled) is a world of its own in the same state, without the watchers.

    This is the physical world. The `World` of Python ACT-R, a map of cells, is `ccm.lib.grid.World` in model files.

    Args:
        scene: What is in it.
        seed: The seed of sensor noise.

    Raises:
        WorldError: If MuJoCo cannot compile the scene (with MuJoCo's message), if it is not a `Scene`, if a body is inside a wall or
            something else that is fixed, or if the seed is not a whole number >= 0.
    """

    def __init__(self, scene: Scene, seed: int = 0) -> None:
        if not isinstance(seed, Integral) or seed < 0:  # it may come from a file
            raise WorldError(f"World.seed: must be a whole number >= 0 (got {seed!r})")
        if not isinstance(scene, Scene):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise WorldError(f"a world is made of a Scene (got {scene!r})")
        self.scene = scene
        self.seed = int(seed)
        self.physics = Physics(scene)
        self.mj_model: MjModel = self.physics.mj_model
        self.mj_data: MjData = self.physics.mj_data
        self.owners = self.physics.owners
        """By geom: the name of the object that it belongs to; a geom of the world itself has its own name."""
        self._apertures = {part.name: part for part in scene.parts if isinstance(part, Aperture)}
        self._closing = [part for part in self._apertures.values() if part.closing]
        described = [part for part in scene.parts if isinstance(part, Embodied)]
        for part in described:
            fit_servos(self.mj_model, self.mj_data, part.anatomy().servos)
        self.bodies = Bodies({part.name: Body(self.physics, part, self.seed) for part in described})
        segments = frozenset(f"{name}_{side}" for name in self._apertures for side in ("left", "right"))
        self.objects = Objects(self.physics, self.bodies, segments)
        """What can be moved by hand."""
        for name, body in self.bodies.items():
            if inside := too_deep({}, self.objects.depths({body.root}, others="fixed")):
                raise WorldError(f"'{name}' is inside {', '.join(map(repr, inside))} at the start; leave room")
        self._pushes = Pushes(self.physics, self.objects)
        self._changes = ModelChanges(self.mj_model)
        self._substepping = Substepping(self.physics, list(self.bodies.values()), self._pushes)
        self.watchers: list[Callable[[], None]] = []
        """Called after every physics step, or part of one; they change nothing. The geometry, contacts and forces of `mj_data` are
        those of the step's beginning then, `time` and `opt.timestep` are its end and its length."""

    @property
    def fingerprint(self) -> str:
        """A hash of the compiled scene: equal for two worlds whose scenes compile to the same bytes."""
        return self._changes.fingerprint

    @property
    def time(self) -> int:
        """Time since the start [us], counted in whole steps: it cannot drift."""
        return self.physics.time

    # -- stepping

    def step(self, steps: int = 1) -> None:
        """Advances the physics by a number of steps (one tick), and stores the contacts of this tick.

        Unfinished commands choose their speeds before it, and in a long one every 10 ms.

        Raises:
            WorldError: If the physics diverges (MuJoCo finds NaN or huge values and would reset), or `steps` is not a whole number >= 0.
        """
        try:
            count = operator.index(steps)
        except TypeError:
            count = -1
        if count < 0:
            raise WorldError(f"World.step: must be a whole number of steps, >= 0 (got {steps!r})")
        self._check_unobserved("step")
        if count == 0:
            return
        feeling = [body for body in self.bodies.values() if body.touched is not None]
        if feeling:
            with feel_steps(feeling) as feel:
                self._step(count, [feel, *self.watchers])
        else:
            self._step(count, self.watchers)
        self.physics.steps += count
        if self.physics.diverged:
            culprit = self.physics.diverged_object()
            raise WorldError(f"the physics diverged near {seconds(self.time)} s, at '{culprit}': forces or speeds without bounds")

    def _step(self, steps: int, watchers: Sequence[Callable[[], None]]) -> None:
        """Makes steps; between them, every 10 ms, closes apertures and corrects the speeds of unfinished commands.

        A brake is corrected so often because with a constant force it would drive the car backwards.

        Args:
            steps: Their number.
            watchers: Called after every physics step, or part of one, as observers.
        """
        commands = [body.motion for body in self.bodies.values() if body.motion]
        for count in self._substepping.stretches(steps):
            for aperture in self._closing:
                width = self.aperture_width(aperture.name)
                if width > 0:
                    self._slide(aperture.name, max(0.0, width - aperture.closing * count * self.scene.timestep))
            for motion in commands:
                motion.before_step(count * self.scene.timestep)
            self.physics.observed = True
            try:
                self._substepping.step(count, watchers)
            finally:
                self.physics.observed = False
            for motion in commands:
                motion.after_step()
                self.changed()

    def _check_unobserved(self, what: str) -> None:
        if self.physics.observed:
            raise WorldError(f"World.{what}: an observer cannot change the world; call simulation.command after the run")

    def changed(self) -> None:
        """Marks derived quantities and views as out of date.

        Call it after you have changed positions, speeds or commands in `mj_data`, or sizes, colours or other numbers in `mj_model`.
        """
        self.physics.changed()

    def refresh(self) -> None:
        """Updates positions, contacts and rays to the state; see `Physics.refresh`."""
        self.physics.refresh()

    def solve(self) -> None:
        """Updates forces and accelerations too; see `Physics.solve`."""
        self.physics.solve()

    # -- the state

    def state(self) -> WorldState:
        """Returns a copy of the present state; later steps do not change it."""
        bodies = tuple((name, body.state()) for name, body in self.bodies.items())
        numbers, changes = self.physics.integration_state(), self._changes.changes()
        return WorldState(
            steps=self.physics.steps,
            scene=self.fingerprint,
            mj_state=numbers,
            bodies=bodies,
            compiled=changes,
            pushes=self._pushes.state(),
        )

    def state_bytes(self) -> bytes:
        """Returns the numbers of the present state, without the count of steps, as a recording stores them."""
        return self.physics.state_bytes()

    def restore(self, state: WorldState) -> None:
        """Restores a state of this world; continuing from it gives the same bytes as the first time.

        Raises:
            WorldError: If it is not a state of this scene, or a number of it is not finite.
        """
        if not isinstance(state, WorldState):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise WorldError(f"World.restore: must be a WorldState, as state() returns it (got {state!r})")
        self._check_unobserved("restore")
        size = len(self.physics.integration_state())
        if state.mj_state.shape != (size,):
            raise WorldError(f"a state of this world has {size} numbers (got {state.mj_state.size}): is it of another scene?")
        if state.scene != self.fingerprint:
            raise WorldError(f"the state is of another scene: that one compiles to {state.scene}, this one to {self.fingerprint}")
        finite = np.isfinite(state.mj_state)
        if not finite.all():
            raise WorldError(f"World.restore: the numbers of the state must be finite (got {state.mj_state[~finite][0]:g})")
        self._changes.restore(state.compiled)
        self.physics.restore(state.mj_state)
        self.physics.steps = state.steps
        for name, body_state in state.bodies:
            self.bodies[name].restore(body_state)
        self._pushes.restore(state.pushes)
        self.changed()

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.scene, self.seed), self.state()  # the arrays of MuJoCo cannot be copied one by one

    def __setstate__(self, state: WorldState) -> None:
        self.restore(state)

    # -- objects moved by hand

    def move(self, name: str, x: float, y: float, heading: float | None = None) -> None:
        """Puts a body, a wall or another object at (x, y) [m], with a heading [rad] or its present one, at once.

        Raises:
            WorldError: If there is no such object, a value is wrong, a hand of another body holds it, or it, or an object that it holds,
                would be inside another object. Then nothing is moved.
        """
        self._check_unobserved("move")
        self.objects.move(name, x, y, heading)

    def push(self, name: str, x: float, y: float = 0.0, time: float = 0.1) -> None:
        """Pushes a body or a loose object with a force (x, y) [N] for a time [s], from the next physics step on.

        The force acts at the centre of the object, or of the base of a body; a body resists with the limited force of its servos.

        Raises:
            WorldError: If there is no such object, it cannot be pushed, or a value is wrong.
        """
        self._check_unobserved("push")
        self._pushes.add(name, x, y, time)

    # -- apertures

    def aperture_width(self, name: str = "aperture") -> float:
        """Returns the free width of an aperture [m].

        Raises:
            WorldError: If there is no such aperture.
        """
        aperture, left = self._aperture(name), int(self.mj_model.body(f"{name}_left").id)
        return aperture.width_of(tuple(self.mj_data.mocap_pos[self.mj_model.body_mocapid[left]]))

    def set_aperture_width(self, width: float, name: str = "aperture") -> None:
        """Sets the free width of an aperture [m] immediately, unless an object would be inside its walls.

        Raises:
            WorldError: If there is no such aperture, or an object that can move would be inside its walls. Then nothing is moved.
            ConfigurationError: If the width is not a number of at least 0.
        """
        self._check_unobserved("set_aperture_width")
        aperture = replace(self._aperture(name), width=width)
        inside = self._slide(name, aperture.width)
        if inside:
            raise WorldError(f"aperture '{name}' cannot be {aperture.width:g} m wide now: {', '.join(inside)} would be inside its walls")

    def _slide(self, name: str, width: float) -> list[str]:
        """Sets the free width of an aperture, unless objects would be inside its walls: then it returns their names."""
        roots = [int(self.mj_model.body(f"{name}_{side}").id) for side in ("left", "right")]
        sides = self.mj_model.body_mocapid[roots]
        before, depths = self.mj_data.mocap_pos[sides].copy(), self.objects.depths(roots, others="moving")
        self.mj_data.mocap_pos[sides] = list(self._aperture(name).segment_positions(width).values())
        self.changed()
        inside = too_deep(depths, self.objects.depths(roots, others="moving"))
        if inside:
            self.mj_data.mocap_pos[sides] = before
            self.changed()
        return inside

    def _aperture(self, name: str) -> Aperture:
        if not isinstance(name, str) or name not in self._apertures:  # pyright: ignore[reportUnnecessaryIsInstance]
            raise WorldError(f"no aperture '{name}' in this scene{did_you_mean(str(name), self._apertures)}")
        return self._apertures[name]
