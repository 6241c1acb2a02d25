"""Checks and converts the parameters of a vision module."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from numbers import Real
from typing import Annotated, Any, cast

from annotated_types import Ge, Le

from actr3d.camera import CameraParameters
from actr3d.configuration import is_finite
from actr3d.errors import ParameterError, alternatives, did_you_mean
from actr3d.vision.detectors.registry import Detector
from actr3d.vision.encoding import Emma
from actr3d.vision.salience import Function, salience_of

MAX_VALUE = 1e6
"""Upper bound of times [s] and noise: longer than any run, and far from the limit of floats."""

FromZero = Annotated[float, Ge(0), Le(MAX_VALUE)]

CAMERA = tuple(field.name for field in fields(CameraParameters))
"""Parameters of the camera, which a module accepts besides its own."""


def check_camera(camera: Mapping[str, Any], own: list[str]) -> None:
    """Checks the camera parameters of a module.

    Raises:
        ParameterError: If the camera has no such parameter either.
        ConfigurationError: If a value is invalid.
    """
    for name in camera:
        if name not in CAMERA:
            says = alternatives(name, own, "it has:", CAMERA)
            raise ParameterError(f"Vision has no parameter '{name}'{says}, and the camera's {', '.join(CAMERA)}")
    CameraParameters.from_mapping(camera)


def saliences_of(given: Any, detectors: Mapping[str, Detector]) -> dict[str, Function]:
    """Returns the salience of each feature, by name.

    Args:
        given: A word or function for all features, or a mapping by feature name; None for the default of each feature.
        detectors: The registered detectors.

    Raises:
        ParameterError: If there is no such feature.
        VisionError: If a salience is neither a known word nor a function.
    """
    by_name: dict[Any, Any] = dict(cast("Mapping[Any, Any]", given)) if isinstance(given, Mapping) else {}
    for name in by_name:
        if name not in detectors:
            raise ParameterError(f"Vision.salience: no feature '{name}'{did_you_mean(str(name), detectors)}")
    saliences: dict[str, Function] = {}
    for name, detector in detectors.items():
        own = detector.finds.salience if given is None or by_name else cast("Any", given)
        saliences[name] = salience_of(by_name.get(name, own), "Vision.salience")
    return saliences


def encoding_of(given: Any) -> Emma | float:
    """Returns the timing of encoding: EMMA, or a constant time [s].

    Raises:
        ParameterError: If it is neither.
    """
    if isinstance(given, Emma):
        return given
    if isinstance(given, str) and given == "emma":
        return Emma()
    if not isinstance(given, bool) and isinstance(given, Real) and is_finite(given) and 0 <= float(given) <= MAX_VALUE:
        return float(given)
    raise ParameterError(f"Vision.encoding: must be a time >= 0 [s], 'emma' or an Emma (got {given!r})")
