"""The motor module: commands to the limbs, knowledge of the body, and the learned body schema."""

from actr3d.motor.limbs import BodyPart, DegreeOfFreedom
from actr3d.motor.module import Motor
from actr3d.motor.plan import Plan

__all__ = ["BodyPart", "DegreeOfFreedom", "Motor", "Plan"]
