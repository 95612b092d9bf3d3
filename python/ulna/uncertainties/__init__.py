"""Measurement uncertainty: the law of propagation (GUM), Monte Carlo (JCGM 101), regions (JCGM 102), and of tasks."""
