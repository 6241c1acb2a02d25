"""Experiments with models: designs, trials on a cluster, and their analysis beside human data."""

from actr3d.experiment.design import Design, Group, Measure, Normal, Trial, Uniform, design

__all__ = ["Design", "Group", "Measure", "Normal", "Trial", "Uniform", "design"]
