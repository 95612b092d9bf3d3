"""From a study to a calibrated arm, and what is judged of it."""
