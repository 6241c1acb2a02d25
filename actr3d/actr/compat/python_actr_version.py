"""The version of python_actr that this library is compatible with; some models print it."""

name = "python_actr"
version_info = (1, 9, 5)
dev = False
version = "1.9.5"
