"""ACT-R 3D: cognitive models in physical bodies, run in exact lockstep."""
