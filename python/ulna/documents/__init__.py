"""Reports of a calibration: one content, gathered once, and its renderings."""
