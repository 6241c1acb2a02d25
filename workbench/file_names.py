"""The names of recordings and experiments, which become parts of paths."""

from __future__ import annotations

import re
import secrets
import time

NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.\-]{0,150}")
"""The names that requests may give."""
STAMP = r"-(\d{8}-\d{6})-[0-9a-f]{4}"
"""The form of `unique_suffix`, as a regular expression; its group is the time."""


def unique_suffix() -> str:
    """Returns the end of a new name: the current time and a random number, as several may be made in one second."""
    return f"-{time.strftime('%Y%m%d-%H%M%S')}-{secrets.token_hex(2)}"
