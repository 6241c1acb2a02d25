"""Benchmarks: each prints its figures with their bars, as ratios of things measured in one run."""
