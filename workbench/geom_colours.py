"""Chooses the colours of what is drawn: each agent has its own clothes. The world itself, and with it what agents see, does not change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import mujoco
import numpy as np
from mujoco import MjModel

from actr3d.world import Mannequin
from workbench.scene_colours import channels, palette

USUAL = np.array(Mannequin.colour[:3])
"""Red, green and blue of the clothes of a person for whom the model chooses none."""
DARKEST = 0.05
"""What is darker than this fraction of them has no colour."""
NEAR = 1e-4
"""Tolerance of colours."""
TEXTURE = int(mujoco.mjtTextureRole.mjTEXROLE_RGB)


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


def colour_of(model: MjModel, geom: int) -> list[int]:
    """Returns the colour of a geom and its opacity, 0 to 255; for a texture, its mean colour."""
    material = int(model.geom_matid[geom])
    colour = np.array(model.geom_rgba[geom] if material < 0 else model.mat_rgba[material])
    texture = -1 if material < 0 else int(model.mat_texid[material, TEXTURE])
    if texture >= 0 and model.tex_nchannel[texture] >= 3:
        channels, first = int(model.tex_nchannel[texture]), int(model.tex_adr[texture])
        count = int(model.tex_width[texture]) * int(model.tex_height[texture]) * channels
        colour[:3] *= model.tex_data[first : first + count].reshape(-1, channels)[:, :3].mean(axis=0) / 255
    return (np.clip(colour, 0, 1) * 255).astype(int).tolist()


def colour_of_object(model: MjModel, geoms: Sequence[int]) -> str:
    """Returns the colour of an object, such as `#5b7fa6`: that of its largest visible geom, which is a person's shirt."""
    colours = {geom: colour_of(model, geom) for geom in geoms}
    largest = max(geoms, key=lambda geom: (colours[geom][3] > 0, float(model.geom_aabb[geom, 3:].prod())))
    return "#" + bytes(colours[largest][:3]).hex()
