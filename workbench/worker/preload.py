"""What the process has loaded from which all workers are forked, so that a run begins at once."""

from __future__ import annotations

import actr3d.running.building  # pyright: ignore[reportUnusedImport] # noqa: F401
import workbench.worker.built  # pyright: ignore[reportUnusedImport]
import workbench.worker.entry  # pyright: ignore[reportUnusedImport]
import workbench.worker.program  # pyright: ignore[reportUnusedImport] # noqa: F401
from actr3d.camera import glance
from actr3d.world import Floor, Mannequin, Scene, World

# The camera is compiled, or read from its cache, when it first looks.
glance(World(Scene(parts=(Floor(), Mannequin(name="walker")))).bodies["walker"])
