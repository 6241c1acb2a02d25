"""The movements of the mannequin that have names."""

from __future__ import annotations

from actr3d.world.anatomy import NamedMovement

ARM = tuple(f"upper_arm_{hinge}" for hinge in ("yaw", "pitch", "roll"))

MOVEMENTS = (
    NamedMovement(name="rotate_torso", joints=(("torso_yaw", 1),)),
    NamedMovement(name="extend_shoulder", side="left", joints=(("left_shoulder_yaw", -1),)),
    NamedMovement(name="extend_shoulder", side="right", joints=(("right_shoulder_yaw", 1),)),
    NamedMovement(name="compress_shoulder", side="left", joints=(("left_shoulder_yaw", 1),)),
    NamedMovement(name="compress_shoulder", side="right", joints=(("right_shoulder_yaw", -1),)),
    NamedMovement(name="lower_arms", joints=tuple((f"{side}_{joint}", 1) for side in ("left", "right") for joint in ARM), to=0.0),
)
"""The torso turns to the left. A shoulder is extended forward and compressed backward, from where it is at rest: to turn to the left,
the right one is extended and the left one compressed. Arms are lowered to where they hang, or hold the load, at the start.
Source: the names are those of the original ACT-R 3D; what extending and compressing mean there is ours."""
