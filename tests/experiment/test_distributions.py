"""Distributions of the values of parameters."""

from __future__ import annotations

import pytest

from actr3d.errors import DesignError
from actr3d.experiment import Normal, Uniform


def test_distributions_without_values_are_refused() -> None:
    with pytest.raises(DesignError, match=r"Normal: low 1e\+09 and high inf leave out nearly all values \(mean 0\.5, sd 0\.1\)"):
        Normal(mean=0.5, sd=0.1, low=1e9)
    assert Normal(mean=0, sd=1, low=4).quantile(0.5) == pytest.approx(4.1611, abs=1e-3)
    with pytest.raises(DesignError, match="no value lies between low 2 and high 1"):
        Normal(mean=1, sd=1, low=2, high=1)
    with pytest.raises(DesignError, match=r"Normal\.sd: must be 0 or >= 1e-05: values have 6 decimals \(got 1e-07\)"):
        Normal(mean=3e-7, sd=1e-7)
    with pytest.raises(DesignError, match=r"Uniform\.high: must be >= low 2 \(got 1\)"):
        Uniform(low=2, high=1)
