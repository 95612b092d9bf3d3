"""What to fit to what: a study, its file, its readings, and how it enters the core."""

from ulna.ground.renamed import SPREAD, finder

__getattr__ = finder("study", SPREAD["study"])
