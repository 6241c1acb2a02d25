"""Checks and converts the parameters of a vision module."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from numbers import Real
from typing import Any, cast

from actr3d.camera import CameraParameters
from actr3d.errors import ParameterError, alternatives, did_you_mean
from actr3d.vision.detectors.registry import Detector
from actr3d.vision.encoding import Emma
from actr3d.vision.salience import RULES, Function, salience_of

MAX_VALUE = 1e6
"""Upper bound of times [s] and noise: longer than any run, and far from the limit of floats."""

FROM_ZERO = ("delay", "delay_sd", "bottom_up_delay", "hold", "edge_noise", "distance_noise")

CAMERA = tuple(field.name for field in fields(CameraParameters))
"""Parameters of the camera, which a module accepts besides its own."""


def check_numbers(given: Mapping[str, Any]) -> None:
    """Checks the numbers and the rule of a module.

    Raises:
        ParameterError: If one is out of bounds.
    """
    for name in FROM_ZERO:
        value = given[name]
        if value is None and name == "delay_sd":
            continue
        number = _number(value)
        if number < 0:
            raise ParameterError(f"Vision.{name}: must be >= 0 (got {value!r})")
        if number > MAX_VALUE:
            raise ParameterError(f"Vision.{name}: must be <= {MAX_VALUE:g} (got {value!r})")
    for name in ("saccades", "private_view"):
        if not isinstance(given[name], bool):
            raise ParameterError(f"Vision.{name}: must be True or False (got {given[name]!r})")
    if not 0 <= _number(given["error_rate"]) <= 1:
        raise ParameterError(f"Vision.error_rate: must be a probability, >= 0 and <= 1 (got {given['error_rate']!r})")
    if not isinstance(given["rule"], str) or given["rule"] not in RULES:
        raise ParameterError(f"Vision.rule: must be one of {', '.join(RULES)} (got {given['rule']!r})")


def _number(value: Any) -> float:
    """Returns a number; infinity if it is too large for a float, -1 if it is not a number."""
    if isinstance(value, bool) or not isinstance(value, Real):
        return -1.0
    try:
        return -1.0 if math.isnan(value) else float(value)
    except OverflowError:
        return math.inf


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
    if 0 <= _number(given) <= MAX_VALUE:
        return _number(given)
    raise ParameterError(f"Vision.encoding: must be a time >= 0 [s], 'emma' or an Emma (got {given!r})")
