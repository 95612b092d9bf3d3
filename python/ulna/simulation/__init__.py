"""Arms that are only numbers: they are moved, touch things and are read, and the truth is known."""

from ulna.ground.renamed import SPREAD, finder

__getattr__ = finder("simulation", SPREAD["simulation"])
