"""Gives each agent of a scene its own clothes in what is drawn. The world itself, and with it what eyes see, does not change."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from mujoco import MjModel

from actr3d.world import Mannequin
from workbench.palette import channels, palette

USUAL = np.array(Mannequin.colour[:3])
"""Red, green and blue of the clothes of a person for whom the model chooses none."""
DARKEST = 0.05
"""What is darker than this fraction of them has no colour."""
NEAR = 1e-4
"""Tolerance of colours."""


def dress(model: MjModel, roots: Iterable[int]) -> None:
    """Changes the colours of a compiled scene so that agents without clothes of their own differ; the first one keeps the usual ones.

    Args:
        model: The scene, a copy for drawing.
        roots: The MuJoCo body at the root of each agent's body, in the order of the scene.
    """
    colours = [np.array(channels(colour)) / 255 for colour in palette()["clothes"]]
    for number, root in enumerate(list(roots)[1:]):
        for geom in np.flatnonzero(model.body_rootid[model.geom_bodyid] == model.body_rootid[root]).tolist():
            # Trousers and shoes are darker shades of the shirt.
            shade = float(model.geom_rgba[geom, :3] @ USUAL / (USUAL @ USUAL))
            if shade > DARKEST and np.abs(model.geom_rgba[geom, :3] - shade * USUAL).max() < NEAR:
                model.geom_rgba[geom, :3] = shade * colours[number % len(colours)]
