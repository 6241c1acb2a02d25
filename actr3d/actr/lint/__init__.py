"""Checks of a model's source: warnings about what its author most likely does not mean."""
