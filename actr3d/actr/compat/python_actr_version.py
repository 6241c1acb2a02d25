"""The version of python_actr whose behaviour models find here; some print it."""

name = "python_actr"
version_info = (1, 9, 5)
dev = False
version = "1.9.5"
