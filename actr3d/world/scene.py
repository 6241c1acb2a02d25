"""The description of a world, which a `World` compiles."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from typing import Annotated, Any, Protocol, runtime_checkable

from annotated_types import Gt, Le
from mujoco import MjModel, MjSpec, mjtIntegrator

from actr3d.clock import MICROSECONDS
from actr3d.configuration import Configuration
from actr3d.errors import WorldError


@runtime_checkable
class Part(Protocol):
    """One thing in a scene: it has a name and adds itself to a MuJoCo specification."""

    @property
    def name(self) -> str:
        """Its name, unique in the scene."""
        ...

    def add_to(self, mj_spec: MjSpec) -> None:
        """Adds it to the specification, all its elements named after it."""
        ...


@dataclass(frozen=True, kw_only=True)
class Scene(Configuration):
    """Describes a world: its parts (walls, an aperture, objects, bodies) and its physics.

    Lengths are metres in the world's frame: x forward, y to the left, z up, the floor at z = 0.
    """

    parts: tuple[Any, ...] = ()
    """The parts of the scene, in any order: each a `Part`, such as those in `scene_objects.py` and `bodies/`."""

    timestep: Annotated[float, Gt(0), Le(0.01)] = 0.002
    """Length of one physics step [s]; a whole number of microseconds. 2 ms keeps a limb at 3 m/s within 6 mm of contact."""

    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)
    """[m/s^2]; the default is the standard acceleration of free fall, rounded to two decimals."""

    def __post_init__(self) -> None:
        """Checks fields, parts and names.

        Raises:
            ConfigurationError: If a field is wrong.
            WorldError: If something is not a part, a name is used twice, or the step is not whole microseconds.
        """
        super().__post_init__()
        for part in self.parts:
            if isinstance(part, type):
                raise WorldError(f"Scene.parts: must be a part (got the class {part.__name__}; write {part.__name__}(…))")
            if not isinstance(part, Part):
                raise WorldError(f"Scene.parts: {part!r} is not a part: it has no name or no add_to(mj_spec)")
            if "\0" in part.name or part.name != part.name.encode(errors="replace").decode():
                raise WorldError(f"Scene.parts: {part.name!r} is no valid name: a character of it is NUL, or cannot be encoded in UTF-8")
        twice = [name for name, count in Counter(part.name for part in self.parts).items() if count > 1]
        if twice:
            raise WorldError(f"Scene.parts: two parts are named '{twice[0]}'; names must differ")
        if abs(self.timestep * MICROSECONDS - self.timestep_us) > 1e-6:
            raise WorldError(f"Scene.timestep: must be a whole number of microseconds (got {self.timestep!r} s)")

    @property
    def timestep_us(self) -> int:
        """The physics step [us]."""
        return round(self.timestep * MICROSECONDS)

    def compile(self) -> MjModel:
        """Compiles the whole scene.

        Raises:
            WorldError: If MuJoCo cannot compile it; with MuJoCo's message.
        """
        try:
            return self.specification().compile()
        except ValueError as error:
            repeated = re.search(r"repeated name '(.*)' in (\w+)", str(error))
            said, clash = on_one_line(str(error)), self._clash(*repeated.groups()) if repeated else ""
            raise WorldError(f"the scene cannot be compiled: {said}{clash}") from error

    def _clash(self, name: str, kind: str) -> str:
        """Returns which parts have elements of a kind with the same name, for a message."""
        parts: list[str] = []
        for part in self.parts:
            mj_spec = MjSpec()
            try:
                part.add_to(mj_spec)
            except ValueError:  # an empty scene has the name already
                return f": the part '{part.name}' has a {kind} of this name, which is reserved; rename it"
            elements = mj_spec.bodies if kind == "body" else getattr(mj_spec, f"{kind}s", [])
            if any(element.name == name for element in elements):
                parts.append(f"'{part.name}'")
        if len(parts) < 2:
            return ""
        return f": the parts {' and '.join(parts)} both have a {kind} of this name, derived from that of the part; rename one of them"

    def specification(self) -> MjSpec:
        """Builds the MuJoCo specification of the whole scene."""
        mj_spec = MjSpec()
        mj_spec.compiler.degree = False
        mj_spec.option.timestep = self.timestep
        mj_spec.option.gravity = self.gravity
        # Velocity servos with a high gain, which make joints turn at the commanded speed, are stable only implicitly.
        mj_spec.option.integrator = mjtIntegrator.mjINT_IMPLICITFAST
        # At MuJoCo's own tolerance, 1e-6, round shapes that hardly touch are now and then found 1 cm deep in each other, and flung away.
        mj_spec.option.ccd_tolerance = 1e-8
        for part in self.parts:
            part.add_to(mj_spec)
        return mj_spec


def on_one_line(text: str) -> str:
    """Returns a message of MuJoCo on one line."""
    return re.sub(r"\s*\n\s*", "; ", text.strip())
