"""The library's own designs, one file each."""

MAIN = "warren_whang_1987"
"""The main design, which is listed first."""
