"""What is compiled: the exact view of a scene, row by row, without rays.

With the eye as origin, a scan line is a plane through it: directions `d(u) = (u, v, 1)`, u and v the tangents to the
right and upwards, 1 the depth axis. A surface is drawn along the row as its nearness `w(u) = 1 / depth`. There, straight
things stay straight and convex things stay convex: flat faces are lines, balls and cylinders are conics. What is seen is
the upper envelope of all of them, and its corners are roots of polynomials.
"""
