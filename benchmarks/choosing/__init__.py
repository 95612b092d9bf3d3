"""Models that choose themselves against models chosen by hand, on real readings: ``python -m benchmarks.choosing``."""
