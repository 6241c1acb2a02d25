"""Small models for the tests of trees."""

from __future__ import annotations

from actr3d.actr import Model


class Ball(Model):
    color = "red"


class Box(Model):
    ball = Ball()
    sizes = [1, 2]


def names(model: Model) -> list[str]:
    return [part.name for part in model.get_children()]
