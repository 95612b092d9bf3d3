"""What a metrologist reads from touches of features: seat scatter, length error, coordinate error.

* **seat scatter**: distance of each touch to the mean of its own seat's touches; seats touched once have none.
* **length error**: distance between the means of two seats minus their calibrated distance. Signed: positive is
  measured too long.
* **coordinate error**: distance of each touch to its reference coordinates, after the best rigid fit (rotation and
  translation, no mirror, least squares after Kabsch 1976, Acta Cryst. A32) of those coordinates onto the placement's
  touches; for ``frame = "arm"`` without any fit, because the coordinates are in the arm's own frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.artefacts.artefact import features_mm
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.readings import Readings
from ulna.geometry.rigid import placed
from ulna.ground.arrays import F64, I64

MOST_PAIRED_SEATS = 500
"""Beyond this many seats in one placement the pairs of free points are too many to mean anything; no length error."""


@dataclass(frozen=True)
class Seats:
    """Touches gathered by the seat that they were in; seats are sorted by placement."""

    mean_mm: F64
    """(S, 3) of the touches of each."""
    code: I64
    """(S,) the placement."""
    reference_mm: F64
    """(S, 3) in the artefact's frame."""
    scatter: Errors
    """Of touches in seats that were touched again."""

    @classmethod
    def of(cls, readings: Readings, tips: Tips) -> Seats:
        """From the tips of all readings."""
        reference_mm = features_mm(readings.artefact)
        seat, seat_of_row, touches = np.unique(
            tips.code * len(reference_mm) + readings.feature, return_inverse=True, return_counts=True
        )
        code, feature = np.divmod(seat, len(reference_mm))
        sums = [np.bincount(seat_of_row, column, len(touches)) for column in tips.first_mm.T]
        mean_mm = np.stack(sums, axis=1) / touches[:, np.newaxis]
        again = touches[seat_of_row] > 1
        scatter_mm = np.linalg.norm(tips.first_mm[again] - mean_mm[seat_of_row[again]], axis=1)
        return cls(mean_mm, code, reference_mm[feature], Errors(scatter_mm, tips.code[again]))

    def pair_errors(self) -> Errors | None:
        """Distances of all pairs of seats of a placement minus the calibrated ones; None where there are none."""
        most = int(np.bincount(self.code).max())
        if most > MOST_PAIRED_SEATS:
            return None
        values, codes = [], []
        for apart in range(1, most):
            together = self.code[apart:] == self.code[:-apart]
            measured = np.linalg.norm(self.mean_mm[apart:] - self.mean_mm[:-apart], axis=1)[together]
            calibrated = np.linalg.norm(self.reference_mm[apart:] - self.reference_mm[:-apart], axis=1)[together]
            values.append(measured - calibrated)
            codes.append(self.code[apart:][together])
        return Errors(np.concatenate(values), np.concatenate(codes)) if values else None

    def found(self, lengths: bool) -> dict[str, Errors]:
        """Seat scatter where there is some, and length errors where they are asked for."""
        found = {"seat_scatter": self.scatter} if len(self.scatter.code) else {}
        pairs = self.pair_errors() if lengths else None
        return found if pairs is None else found | {"length_error": pairs}

    def coordinate_errors(self, readings: Readings, tips: Tips) -> Errors | None:
        """Of each touch, in placements where several seats were touched; in the arm's frame of all."""
        reference_mm = features_mm(readings.artefact)[readings.feature]
        if readings.artefact.frame == "arm":
            return Errors(np.linalg.norm(tips.first_mm - reference_mm, axis=1), tips.code)
        several = (np.bincount(self.code) > 1)[tips.code]
        if not several.any():
            return None
        error_mm = np.linalg.norm(tips.first_mm - placed(reference_mm, tips.first_mm, tips.code), axis=1)
        return Errors(error_mm[several], tips.code[several])
