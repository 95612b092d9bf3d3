"""One file for each kind of test that a profile may ask for: touches in, single values and departures out."""
