"""Limbs under a mind's command: the motor module, what it knows of the body, and the body schema it learns."""

from actr3d.motor.limbs import BodyPart, Freedom
from actr3d.motor.module import Motor

__all__ = ["BodyPart", "Freedom", "Motor"]
