"""Compiled functions of detectors: from the edges of a view to points in space, gaps and surfaces."""
