"""Distributions from which values of parameters are drawn, for participants or for trials."""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist
from typing import Annotated, Protocol, runtime_checkable

from annotated_types import Ge

from actr3d.configuration import Configuration
from actr3d.errors import DesignError

DIGITS = 6
"""Number of decimals to which drawn values are rounded, so that they are the same on every machine."""
FEWEST = 1e-6
"""Minimum probability between the bounds of a normal distribution; with less, nearly all drawn values would be at a bound."""
FINEST = 1e-5
"""The least standard deviation of a distribution."""


@runtime_checkable
class Distribution(Protocol):
    """A distribution from which values of parameters are drawn."""

    def quantile(self, p: float) -> float:
        """Returns the value below which a drawn value lies with probability p, 0 < p < 1."""
        ...


@dataclass(frozen=True, kw_only=True)
class Normal(Configuration):
    """A normal distribution, truncated if there are bounds: `Normal(mean=0.404, sd=0.02, low=0.3, high=0.7)`."""

    mean: float
    """The mean before truncation."""
    sd: Annotated[float, Ge(0)]
    """The standard deviation before truncation."""
    low: float | None = None
    """The lower bound of values; None for none."""
    high: float | None = None
    """The upper bound of values; None for none."""

    def __post_init__(self) -> None:
        """Checks the values.

        Raises:
            ConfigurationError: If a value is not a number.
            DesignError: If no value, or next to none, lies between the bounds.
        """
        super().__post_init__()
        low, high = self._bounds()
        if 0 < self.sd < FINEST:
            raise DesignError(f"Normal.sd: must be 0 or >= {FINEST:g}: values have {DIGITS} decimals (got {self.sd:g}); use a smaller unit")
        if low > high or (self.sd == 0 and not low <= self.mean <= high):
            raise DesignError(f"Normal: no value lies between low {low:g} and high {high:g} (mean {self.mean:g}, sd {self.sd:g})")
        if self.sd > 0 and self._whole.cdf(high) - self._whole.cdf(low) < FEWEST:
            raise DesignError(f"Normal: low {low:g} and high {high:g} leave out nearly all values (mean {self.mean:g}, sd {self.sd:g})")

    def quantile(self, p: float) -> float:
        """Returns the value below which a drawn value lies with probability p, 0 < p < 1."""
        if self.sd == 0:
            return self.mean
        low, high = self._bounds()
        below, up_to = self._whole.cdf(low), self._whole.cdf(high)
        inside = min(max(below + p * (up_to - below), 1e-12), 1 - 1e-12)
        return min(max(self._whole.inv_cdf(inside), low), high)

    @property
    def _whole(self) -> NormalDist:
        """The distribution without its bounds."""
        return NormalDist(self.mean, self.sd)

    def _bounds(self) -> tuple[float, float]:
        return -math.inf if self.low is None else self.low, math.inf if self.high is None else self.high


@dataclass(frozen=True, kw_only=True)
class Uniform(Configuration):
    """A uniform distribution: `Uniform(low=0, high=0.5)`."""

    low: float
    """The lower bound of values."""
    high: float
    """The upper bound of values."""

    def __post_init__(self) -> None:
        """Checks the values.

        Raises:
            ConfigurationError: If a value is not a number.
            DesignError: If the upper bound is below the lower one.
        """
        super().__post_init__()
        if self.low > self.high:
            raise DesignError(f"Uniform.high: must be >= low {self.low:g} (got {self.high:g})")

    def quantile(self, p: float) -> float:
        """Returns the value below which a drawn value lies with probability p, 0 < p < 1."""
        return self.low + p * (self.high - self.low)
