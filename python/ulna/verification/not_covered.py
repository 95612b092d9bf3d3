"""What tests with a touching probe say nothing of."""

from __future__ import annotations


def not_covered(scanner: str | None) -> str:
    """In words; scanner: what the arm carries beside its probe, where that was stated."""
    if scanner is None:
        return "Tactile probing alone was tested; of a scanner on the arm (ISO 10360-8) nothing is said."
    return (
        f"Not covered: the scanner ({scanner}). Tactile probing alone was tested; of the scanner (ISO 10360-8) "
        "nothing is said."
    )
