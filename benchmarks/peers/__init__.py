"""One file per contender. Each has `contender()`, which raises MissingPeerError or ImportError where it cannot run."""

from collections.abc import Callable
from dataclasses import dataclass

#: task → seconds, or megabytes for the one named peak_1000000_mb
Times = dict[str, float]


class MissingPeerError(Exception):
    """What this contender needs and this machine lacks, in words."""


@dataclass(frozen=True)
class Contender:
    """One program that can do some of the tasks."""

    name: str
    version: str
    #: what its times count, one sentence
    counted: str
    #: runs the tasks it can do, having checked its answers; quick: the small sizes only
    measure: Callable[[bool], Times]


#: module names below benchmarks.peers, in the order of the result table
ALL = ("ulna_core", "ulna_python", "scipy_numpy", "ceres", "casadi_c", "jax_cpu", "pinocchio")
