"""Chunks, and the pattern language that describes them."""
