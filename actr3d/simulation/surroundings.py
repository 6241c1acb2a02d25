"""Describes a world for pages, curves and overlays: its bodies, doorways and ground, with MuJoCo's numbers."""

from __future__ import annotations

import math
from typing import Any

from actr3d.world import Aperture, Floor, World


def surroundings(world: World) -> dict[str, Any]:
    """Returns a description of a world's constant contents, as plain values."""
    bodies = {
        name: {
            "shoulders": body.anatomy.shoulders,
            "eye": body.eye,
            "root": body.root,
            "feels": body.touch_geoms.tolist(),
            "joints": {joint.name: [_finite(limit) for limit in joint.limits] for joint in body.joints.values()},
        }
        for name, body in world.bodies.items()
    }
    walls = {part.name: _wall(part, world) for part in world.scene.parts if isinstance(part, Aperture)}
    grounds = {part.name for part in world.scene.parts if isinstance(part, Floor)}
    ground = [geom for geom, owner in enumerate(world.owners) if owner in grounds]
    return {"bodies": bodies, "apertures": list(walls), "walls": walls, "ground": ground}


def _wall(aperture: Aperture, world: World) -> dict[str, Any]:
    """Returns where a wall with an aperture stands, and the geoms to the left and to the right of the gap."""
    left, right = (int(world.mj_model.geom(f"{aperture.name}_{side}").id) for side in ("left", "right"))
    return {"position": aperture.position, "heading": aperture.heading, "thickness": aperture.thickness, "segments": (left, right)}


def _finite(limit: float) -> float | None:
    return limit if math.isfinite(limit) else None
