"""Two calibrations of one arm: what has moved, by more than both uncertainties explain or not."""
