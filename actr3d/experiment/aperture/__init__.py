"""Passing through apertures: the measure of a passage, the trials of the experiment, and what people and the original model did."""

from actr3d.experiment.aperture.experience import experiences
from actr3d.experiment.aperture.passage import Passage, PassageResult

__all__ = ["Passage", "PassageResult", "experiences"]
