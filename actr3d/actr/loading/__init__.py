"""Loads and runs model files: as programs, unchanged, from a file or from text."""

from __future__ import annotations

from actr3d.actr.loading.model_file import load_text, run_file, run_text
from actr3d.actr.loading.source_text import compile_source, read_source

__all__ = ["compile_source", "load_text", "read_source", "run_file", "run_text"]
