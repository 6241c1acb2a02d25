"""A body from an MJCF or URDF file."""

from __future__ import annotations

from dataclasses import dataclass

from mujoco import MjSpec

from actr3d.errors import WorldError
from actr3d.world.anatomy import Anatomy, NamedMovement, body_kind
from actr3d.world.imported import Imported

ALONG_X = (0, -1, 0, 0, 0, 1)
"""The axes of a camera that looks along x, with z up: its own x to the right and y up."""


@body_kind
@dataclass(frozen=True, kw_only=True)
class ImportedBody(Imported):
    """An imported file that is a body, for an agent to control. It has one root body, which carries the others.

    Joints, actuators (`control`), parts and geoms with contacts are found in the file. It sees along the x axis of the site
    that is named as its eye, with z up.
    """

    movements: tuple[NamedMovement, ...] = ()
    """Its named movements, for a motor module's `move`."""

    def __post_init__(self) -> None:
        """Checks the fields and reads the files, as `Imported` does.

        Raises:
            ConfigurationError: If a field is wrong.
            WorldError: If the file cannot be read or compiled, or does not have exactly one root body, with a name.
        """
        super().__post_init__()
        self._root()

    def anatomy(self) -> Anatomy:
        """Returns its description for a `Body`."""
        eye = None if self.eye is None else self.prefix + self.eye
        return Anatomy(root=self.prefix + self._root(), prefix=self.prefix, eye=eye, movements=self.movements)

    def add_to(self, mj_spec: MjSpec) -> None:
        """Attaches it, and adds a camera at its eye."""
        super().add_to(mj_spec)
        if self.eye is not None:
            name = self.prefix + self.eye
            site = mj_spec.site(name)
            if mj_spec.camera(name) is None:
                inner = site.parent.add_frame(pos=site.pos, quat=site.quat)
                site.parent.add_camera(name=name, xyaxes=ALONG_X, fovy=60).set_frame(inner)

    def _root(self) -> str:
        roots = self.roots()
        if len(roots) != 1 or not roots[0]:
            found = ", ".join(f"'{name}'" if name else "one without a name" for name in roots) or "none"
            raise WorldError(f"ImportedBody '{self.name}': needs one root body, with a name (there is {found}); use Imported for scenery")
        return roots[0]
