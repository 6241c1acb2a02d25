"""All sensors by their words; each file of this package adds its own."""

from __future__ import annotations

from actr3d.world.words import Word, adder

SENSORS: dict[str, Word] = {}
"""By word."""

sensor = adder(SENSORS)
"""Adds a sensor that every body has."""
