"""Compiled functions that compute the exact view of a scene, row by row, without rays.

With the eye as origin, a scan line is a plane through it: directions `d(u) = (u, v, 1)`, where u and v are the tangents to
the right and upwards, and 1 is along the depth axis. A surface is drawn along the row as its nearness `w(u) = 1 / depth`.
In this form, straight lines stay straight and convex shapes stay convex: flat faces are lines, balls and cylinders are conics.
The visible parts are the upper envelope of all these curves, and its corners are roots of polynomials.
"""

from pathlib import Path

SOURCES = Path(__file__).parent
"""The folder of these functions: what was compiled of them is compiled again when one of its files changes."""
