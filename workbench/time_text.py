"""Writes times for people."""

from __future__ import annotations

HOUR = 3600
"""The length of an hour [s]."""


def time_text(time: float, digits: int | None = None, longest: float | None = None) -> str:
    """Returns a time as the page's `timeText` writes it: seconds with their unit; from an hour on, `1:15:12.30`.

    Args:
        time: The time [s].
        digits: The number of decimals, from an hour on at most 2; None for those that are needed.
        longest: The longest of the times that it stands beside, whose form it has [s]; None for this one.
    """
    if max(time, longest or 0) < HOUR:
        return f"{time:g} s" if digits is None else f"{time:.{digits}f} s"
    minutes, rest = divmod(round(100 * time), 6_000)  # of hundredths of a second
    decimals = f".{rest % 100:02}" if digits or rest % 100 else ""
    return f"{minutes // 60}:{minutes % 60:02}:{rest // 100:02}{decimals}"
