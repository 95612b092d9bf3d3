"""An arm: joints, probes, effects beyond geometry, its file, its frames."""
