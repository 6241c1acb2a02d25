"""MuJoCo, which ships no types: all that comes from it is `Any`."""

from __future__ import annotations

import importlib
from typing import Any, TypeAlias

mujoco: Any = importlib.import_module("mujoco")

MjModel: TypeAlias = Any
MjData: TypeAlias = Any
