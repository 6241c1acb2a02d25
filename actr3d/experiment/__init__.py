"""Experiments with models: designs, trials on a cluster, and their analysis beside human data."""

from actr3d.experiment.design import Design, Group, Measured, Normal, Trial, Uniform, design

__all__ = ["Design", "Group", "Measured", "Normal", "Trial", "Uniform", "design"]
