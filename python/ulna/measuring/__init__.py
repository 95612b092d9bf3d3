"""Measuring with a calibrated arm: points, their uncertainties, what they depend on."""
