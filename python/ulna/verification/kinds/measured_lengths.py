"""Touches of the two ends of a length, to a length: what the length tests share."""

from __future__ import annotations

from ulna.ground.errors import UlnaInputError
from ulna.verification.bench import Bench, Length, called, tip_mm
from ulna.verification.figures.lengths import OPPOSING, length_between
from ulna.verification.outcome import Labels, Single
from ulna.verification.touches import Touches

LONGEST_SHARE = 0.66
"""Of the range, where a profile does not say it."""
WORDS = ("verification.lengths", "verification.no-mpe", "axis.length-mm", "axis.length-error-mm")
"""Of a drawing of errors over lengths."""


def measured_lengths(name: str, touches: Touches, bench: Bench) -> list[tuple[Length, Single]]:
    """One for each artefact in each position and repeat, in order. Raises UlnaInputError."""
    found = []
    for (artefact, position, repeat), own in touches.groups(("artefact", "position", "repeat")):
        length = bench.length(artefact, name)
        what = f"{own.path}: test '{name}', {called(artefact=length.name, position=position, repeat=repeat)}"
        ends = {feature: part for (feature,), part in own.groups(("feature",))}
        for feature, part in ends.items():
            if feature not in ("A", "B"):
                said = f"got '{feature}'" if feature else "nothing is said of the end"
                raise UlnaInputError(
                    f"{part.path}: row {part.row[0]}, column 'feature': {said}; expected A or B, the two ends of a "
                    "length. Correct it."
                )
        if len(ends) < 2:
            raise UlnaInputError(
                f"{what}: only end {next(iter(ends))} was touched ({len(own.row)} rows); a length needs A and B. Add "
                "the missing rows, or remove these."
            )
        kind = length.table.ends
        tip = tip_mm(own, bench.path, name) if kind in OPPOSING else None
        try:
            measured = float(length_between(ends["A"].p_mm, ends["B"].p_mm, kind, tip))
        except UlnaInputError as error:
            raise UlnaInputError(f"{what}: {error}") from None
        calibrated = length.calibrated_mm
        labels = Labels(length.name, position, repeat=repeat)
        found.append((length, Single(labels, measured - calibrated, length.budget, calibrated, measured)))
    return found
