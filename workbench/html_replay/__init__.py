"""Exports a recorded run as one self-contained HTML file that plays its 3D scene beside its trace."""
