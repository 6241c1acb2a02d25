"""Declarative memory, and the modules that compute the activation of its chunks."""
