"""Statistics of figures over time: whether they are in control, whether they drift, when to calibrate again."""
