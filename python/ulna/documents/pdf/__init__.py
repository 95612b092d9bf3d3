"""The report on paper: a calibration certificate, set by Typst."""
