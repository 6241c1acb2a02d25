"""Describes a world for pages, curves and overlays: its bodies and doorways, with MuJoCo's numbers."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from actr3d.world import Aperture, World
from actr3d.world.compiled import to_bytes, to_text


def surroundings(world: World) -> dict[str, Any]:
    """Returns a description of a world's constant contents, as plain values."""
    bodies = {
        name: {
            "shoulders": body.anatomy.shoulders,
            "eye": body.eye,
            "root": body.root,
            "joints": {joint.name: [limit if math.isfinite(limit) else None for limit in joint.limits] for joint in body.joints.values()},
        }
        for name, body in world.bodies.items()
    }
    walls = {part.name: asdict(part.gap_in(world.mj_model)) for part in world.scene.parts if isinstance(part, Aperture)}
    return {"bodies": bodies, "apertures": list(walls), "walls": walls}


def scene_facts(world: World) -> dict[str, Any]:
    """Returns the facts with which a recording shows a world: its compiled model, and its surroundings."""
    return {"compiled": to_text(to_bytes(world.mj_model)), "world": surroundings(world)}
