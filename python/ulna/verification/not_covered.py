"""What tests with a touching probe say nothing of."""

from __future__ import annotations

from ulna.ground.worded import worded
from ulna.verification.departures import NO_SCANNER, TACTILE_ALONE


def not_covered(scanner: str | None) -> str:
    """In words; scanner: what the arm carries beside its probe, where that was stated."""
    if scanner is None:
        return worded(TACTILE_ALONE)
    return worded(NO_SCANNER, scanner=scanner)
