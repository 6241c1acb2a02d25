"""A recorded run as one HTML file that needs nothing else: its 3D scene playing, and the trace beside it."""
