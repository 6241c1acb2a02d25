"""Recordings: one SQLite file a run, which holds all that happened in it and all that is needed to run it again."""

from actr3d.recording.recorded import Recorded
from actr3d.recording.recording import Recording

__all__ = ["Recorded", "Recording"]
