"""Runs model files: programs, and descriptions of simulations; records the runs, and runs recordings again.

A file that needs no world is run without loading what worlds need.
"""
