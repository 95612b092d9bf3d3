"""Speed of the core beside its peers, in one run, as ratios: ``make bench`` (or ``python -m benchmarks``).

Every peer computes the same four tasks on the same readings, and its answer is checked before its time is believed.
A peer that is not installed is skipped by name; ``benchmarks/requirements.txt`` lists what to install.
"""
