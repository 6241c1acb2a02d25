"""How what a mind has seen is drawn: as large as it says that it is, and with labels that can be read."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from actr3d.camera import EyePose
from actr3d.vision import Feature, Sighting
from actr3d.vision.units import Metres
from workbench.overlays.contours import Places
from workbench.overlays.features import DIAMOND, _outline


@dataclass(frozen=True, kw_only=True)
class Spot(Feature):
    """What a detector of a model's own finds, without a size."""


@dataclass(frozen=True, kw_only=True)
class Sign(Feature):
    """One with a size."""

    width: Metres = field(default=0.6)
    top: Metres = field(default=0.5)
    bottom: Metres = field(default=-0.3)


@dataclass(frozen=True, kw_only=True)
class Line(Feature):
    """One that is wide, and no more."""

    width: Metres = field(default=2.0)


def outline(feature: Feature) -> Places:
    """How it is drawn where an eye stands in the world's origin; of what it was found in nothing is asked."""
    view: Any = None
    eye_pose = EyePose(0.0, 0.0, 0.0, 0.0)
    sighting = Sighting(module="vision", bottom_up=False, time=0.0, chosen=True, feature=feature, view=view, eye_pose=eye_pose)
    return _outline(sighting, np.empty((0, 2, 3)))


def test_what_has_no_size_is_a_mark_where_it_is() -> None:
    lines = outline(Spot(distance=2.0, direction=np.pi / 2))
    assert lines.shape == (4, 2, 3)
    assert lines.reshape(-1, 3).mean(axis=0) == pytest.approx((0, 2, 0))
    assert np.ptp(lines[..., 2]) == pytest.approx(2 * DIAMOND)
    assert np.ptp(lines[..., 0]) == pytest.approx(2 * DIAMOND)
    assert np.array_equal(lines[:, 1], np.roll(lines[:, 0], -1, axis=0)), "it is closed"


def test_what_has_a_size_is_a_frame_of_that_size() -> None:
    lines = outline(Sign(distance=3.0, direction=0.0))
    assert lines.shape == (4, 2, 3)
    assert (lines[..., 1].min(), lines[..., 1].max()) == pytest.approx((-0.3, 0.3))
    assert (lines[..., 2].min(), lines[..., 2].max()) == pytest.approx((-0.3, 0.5))
    assert lines[..., 0] == pytest.approx(3.0)
    (line,) = outline(Line(distance=3.0, direction=0.0))
    assert line == pytest.approx(np.array([(3, 1, 0), (3, -1, 0)]))
