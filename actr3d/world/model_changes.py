"""Changes of the compiled model since the start: part of the world's state."""

from __future__ import annotations

from functools import cached_property
from hashlib import blake2b
from typing import Any

import mujoco
import numpy as np
from mujoco import MjModel
from numpy.typing import NDArray

from actr3d.world.compiled import from_bytes

Changes = tuple[tuple[str, NDArray[Any]], ...]
"""Each array of the model, and each option (`opt.gravity`), that differs from the start, by name."""


class ModelChanges:
    """Compares a compiled model with its start, and restores it.

    The weld of a hand is in the model and not in the data, and so is all that a program changes there: sizes, colours, gains.
    Options of drawing (`vis`) do not count.

    Args:
        mj_model: The compiled model, at the start.
    """

    def __init__(self, mj_model: MjModel) -> None:
        self._model = mj_model
        self._image = np.empty(mujoco.mj_sizeModel(mj_model), np.uint8)
        self._start = self._saved()
        self.fingerprint = blake2b(self._start, digest_size=8).hexdigest()
        """A hash of the compiled model: equal for two scenes that compile to the same bytes."""

    def changes(self) -> Changes:
        """Returns copies of what differs from the start."""
        if self._saved() == self._start:  # 15 us for a walker in a room
            return ()
        pairs = zip(_numbers(self._model), _numbers(self._original), strict=True)
        return tuple((name, now.copy()) for (name, now), (_, before) in pairs if now.tobytes() != before.tobytes())

    def restore(self, changes: Changes) -> None:
        """Sets everything to its value at the start, except for these changes."""
        if not changes and self._saved() == self._start:
            return
        wanted = {**dict(_numbers(self._original)), **dict(changes)}
        for name, now in _numbers(self._model):
            if now.tobytes() != wanted[name].tobytes():
                self._set(name, wanted[name])

    def _saved(self) -> bytes:
        mujoco.mj_saveModel(self._model, None, self._image)
        return self._image.tobytes()

    @cached_property
    def _original(self) -> MjModel:
        """The model at the start; made when something first differs from it."""
        return from_bytes(self._start)

    def _set(self, name: str, number: NDArray[Any]) -> None:
        option = name.removeprefix("opt.")
        of: Any = self._model if option == name else self._model.opt
        if isinstance(getattr(of, option), np.ndarray):
            getattr(of, option)[...] = number
        else:
            setattr(of, option, number.item())


def _numbers(mj_model: Any) -> list[tuple[str, NDArray[Any]]]:
    """Returns the arrays and the options of a model."""
    arrays: list[tuple[str, NDArray[Any]]] = [
        (name, value) for name in dir(mj_model) if isinstance(value := getattr(mj_model, name), np.ndarray)
    ]
    options = [(f"opt.{name}", np.asarray(getattr(mj_model.opt, name))) for name in dir(mj_model.opt) if not name.startswith("_")]
    return [*arrays, *options]
