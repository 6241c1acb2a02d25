"""Recordings: one SQLite file per run, with everything that happened in it and everything needed to run it again."""

from actr3d.recording.reader import Recorded
from actr3d.recording.recording import Recording

__all__ = ["Recorded", "Recording"]
