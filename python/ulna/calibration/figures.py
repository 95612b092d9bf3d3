"""What a metrologist reads from touches: seat scatter, length error, coordinate error.

All of it comes from the tip positions alone, without the fit's own idea of where an artefact stands:

* **seat scatter**: distance of each touch to the mean of its own seat's touches; seats touched once have none.
* **length error**: distance between the means of two seats minus their calibrated distance (a bar, and all pairs of
  seats of free `points` with up to `MOST_PAIRED_SEATS` of them); for length rows the distance between the two tips
  minus the stated length. Signed: positive is measured too long.
* **coordinate error**: distance of each touch to its reference coordinates, after the best rigid fit (rotation and
  translation, no mirror, least squares after Kabsch 1976, Acta Cryst. A32) of those coordinates onto the placement's
  touches; for ``frame = "arm"`` without any fit, because the coordinates are in the arm's own frame.

* **form**, **diameter error**: of touches of a surface, the spread of their distances from the least-squares sphere or
  plane of the placement (largest minus smallest), and the sphere's diameter, less the ball's, minus the calibrated one
  (signed; the largest in size over several placements). Placements touched too few times have none.

Names end in the unit; `_mean_abs_` is the mean of magnitudes, `_mean_` of a length error is the signed mean.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import SURFACES
from ulna.artefacts.readings import Readings
from ulna.artefacts.surface import Errors, surface_errors
from ulna.study.assembly import balls_mm, warmth_k
from ulna.study.study import Study

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Figures = dict[str, float]

MOST_PAIRED_SEATS = 500
"""Beyond this many seats in one placement the pairs of free points are too many to mean anything; no length error."""

NAMES = (
    "seat_scatter_mean_mm",
    "seat_scatter_rms_mm",
    "seat_scatter_max_mm",
    "length_error_mean_mm",
    "length_error_mean_abs_mm",
    "length_error_rms_mm",
    "length_error_max_abs_mm",
    "coordinate_error_mean_mm",
    "coordinate_error_rms_mm",
    "coordinate_error_max_mm",
    "form_mm",
    "diameter_error_mm",
)
"""Every figure, in the order in which it is shown. A figure that the readings do not give is left out, never 0."""


@dataclass(frozen=True)
class PlacementFigures:
    """The figures of one artefact in one placement."""

    artefact: str
    placement: str
    kind: str
    readings: int
    """Number of rows."""
    figures: Figures
    """Only those of `NAMES` that these readings give, mm."""

    def as_dict(self) -> dict[str, Any]:
        """As in `result.json` and `evaluation.json`, list `artefacts`."""
        return {
            "artefact": self.artefact,
            "placement": self.placement,
            "kind": self.kind,
            "readings": self.readings,
            **self.figures,
        }

    @classmethod
    def from_dict(cls, entry: Mapping[str, Any]) -> PlacementFigures:
        """The inverse of `as_dict`."""
        figures = {name: float(entry[name]) for name in NAMES if name in entry}
        return cls(entry["artefact"], entry["placement"], entry["kind"], entry["readings"], figures)


def figures(arm: Arm, study: Study) -> tuple[list[PlacementFigures], Figures]:
    """Per artefact and placement, and over all touches and lengths of all of them together.

    `arm` must carry the study's probes in the study's order. Errors: those of the core for wrong shapes.
    """
    entries: list[PlacementFigures] = []
    pooled: list[dict[str, Errors]] = []
    for readings in study.readings:
        # one probe for all is much quicker than one for each row
        probe = int(readings.probe[0]) if (readings.probe == readings.probe[0]).all() else readings.probe
        warmth = warmth_k(study, arm, readings)
        first_mm = arm.core.tip(np.ascontiguousarray(readings.q_rad), probe, warmth)
        second_mm = None
        if readings.p_rad is not None:
            second_mm = arm.core.tip(np.ascontiguousarray(readings.p_rad), probe, warmth)
        labels, code = placements(readings)
        if readings.artefact.kind in SURFACES:
            errors = surface_errors(readings, code, first_mm, balls_mm(study, arm, readings)[readings.probe])
        else:
            errors = errors_of_tips(readings, code, first_mm, second_mm)
        pooled.append(errors)
        per_quantity = {name: _by_placement(name, error, len(labels)) for name, error in errors.items()}
        counts = np.bincount(code, minlength=len(labels))
        for number, label in enumerate(labels):
            found = {name: value for quantity in per_quantity.values() for name, value in quantity[number].items()}
            entries.append(
                PlacementFigures(readings.artefact.name, label, readings.artefact.kind, int(counts[number]), found)
            )
    overall: Figures = {}
    for quantity in ("seat_scatter", "length_error", "coordinate_error", "form", "diameter_error"):
        values = [errors[quantity].value_mm for errors in pooled if quantity in errors]
        if values:
            overall.update(_summaries(quantity, np.concatenate(values), np.zeros(1, dtype=np.int64))[0])
    return entries, overall


def placements(readings: Readings) -> tuple[list[str], I64]:
    """Labels of the placements in the order in which they appear, and (N,) the number of each row's placement."""
    code = readings.placement_code
    count = int(code.max()) + 1 if len(code) else 0
    first = np.full(count, len(code), dtype=np.int64)
    np.minimum.at(first, code, np.arange(len(code)))
    return [str(readings.placement[row]) for row in first], code


def errors_of_tips(readings: Readings, code: I64, first_mm: F64, second_mm: F64 | None) -> dict[str, Errors]:
    """The single errors, mm, from tip positions (N, 3); `code` (N,) numbers the placements."""
    artefact = readings.artefact
    if artefact.kind == "length":
        assert second_mm is not None
        assert readings.length_mm is not None
        distance_mm = np.linalg.norm(second_mm - first_mm, axis=1)
        return {"length_error": Errors(distance_mm - readings.length_mm, code)}
    features_mm = np.array(list(artefact.features.values()), dtype=np.float64).reshape(-1, 3)
    seat, seat_of_row, touches = np.unique(
        code * len(features_mm) + readings.feature, return_inverse=True, return_counts=True
    )
    seat_code, seat_feature = np.divmod(seat, len(features_mm))
    mean_mm = _grouped_mean(first_mm, seat_of_row, touches)
    found: dict[str, Errors] = {}
    again = touches[seat_of_row] > 1
    if again.any():
        scatter_mm = np.linalg.norm(first_mm - mean_mm[seat_of_row], axis=1)
        found["seat_scatter"] = Errors(scatter_mm[again], code[again])
    free_points = artefact.kind == "points" and artefact.frame == "free"
    if artefact.kind == "bar" or free_points:
        lengths = _pair_errors(mean_mm, seat_code, features_mm[seat_feature])
        if lengths is not None:
            found["length_error"] = lengths
    if free_points:
        several = (np.bincount(seat_code) > 1)[code]
        if several.any():
            reference_mm = features_mm[readings.feature]
            error_mm = np.linalg.norm(first_mm - _placed(reference_mm, first_mm, code), axis=1)
            found["coordinate_error"] = Errors(error_mm[several], code[several])
    elif artefact.kind == "points":
        error_mm = np.linalg.norm(first_mm - features_mm[readings.feature], axis=1)
        found["coordinate_error"] = Errors(error_mm, code)
    return found


def _grouped_mean(values: F64, group: I64, counts: I64) -> F64:
    """(N, k) → (groups, k)."""
    return np.stack([np.bincount(group, column, len(counts)) for column in values.T], axis=1) / counts[:, np.newaxis]


def _pair_errors(mean_mm: F64, seat_code: I64, reference_mm: F64) -> Errors | None:
    """Distances of all pairs of seats of a placement minus the calibrated ones. Seats are sorted by placement."""
    most = int(np.bincount(seat_code).max())
    if most > MOST_PAIRED_SEATS:
        return None
    values, codes = [], []
    for apart in range(1, most):
        together = seat_code[apart:] == seat_code[:-apart]
        measured = np.linalg.norm(mean_mm[apart:] - mean_mm[:-apart], axis=1)[together]
        calibrated = np.linalg.norm(reference_mm[apart:] - reference_mm[:-apart], axis=1)[together]
        values.append(measured - calibrated)
        codes.append(seat_code[apart:][together])
    if not values:
        return None
    return Errors(np.concatenate(values), np.concatenate(codes))


def _placed(reference_mm: F64, tip_mm: F64, code: I64) -> F64:
    """(N, 3): each row's reference coordinates after its placement's best rigid motion onto the touches."""
    counts = np.bincount(code)
    reference_mean = _grouped_mean(reference_mm, code, counts)
    tip_mean = _grouped_mean(tip_mm, code, counts)
    reference = reference_mm - reference_mean[code]
    tip = tip_mm - tip_mean[code]
    cross = np.empty((len(counts), 3, 3))
    for i in range(3):
        for j in range(3):
            cross[:, i, j] = np.bincount(code, tip[:, i] * reference[:, j], len(counts))
    u, _, vt = np.linalg.svd(cross)
    u[:, :, 2] *= np.linalg.det(u @ vt)[:, np.newaxis]  # a rotation, never a mirror
    placed: F64 = np.einsum("nij,nj->ni", (u @ vt)[code], reference) + tip_mean[code]
    return placed


def _by_placement(quantity: str, errors: Errors, count: int) -> list[Figures]:
    """The figures of each placement; {} where it has none."""
    found: list[Figures] = [{} for _ in range(count)]
    order = np.argsort(errors.code, kind="stable")
    present, start = np.unique(errors.code[order], return_index=True)
    for number, summary in zip(present, _summaries(quantity, errors.value_mm[order], start), strict=True):
        found[number] = summary
    return found


def _summaries(quantity: str, values_mm: F64, start: I64) -> list[Figures]:
    """The figures of each run of values; a run begins at each of `start`."""
    counts = np.diff(start, append=len(values_mm))
    size = np.abs(values_mm)
    mean = np.add.reduceat(size, start) / counts
    rms = np.sqrt(np.add.reduceat(size**2, start) / counts)
    largest = np.maximum.reduceat(size, start)
    if quantity in ("form", "diameter_error"):
        largest_at = [at + int(np.argmax(size[at : at + count])) for at, count in zip(start, counts, strict=True)]
        columns = [values_mm[largest_at]]
    elif quantity == "length_error":
        columns = [np.add.reduceat(values_mm, start) / counts, mean, rms, largest]
    else:
        columns = [mean, rms, largest]
    names = [name for name in NAMES if name.startswith(quantity)]
    return [dict(zip(names, row, strict=True)) for row in np.stack(columns, axis=1).tolist()]


def over_groups(groups: Iterable[Figures]) -> Figures:
    """Over all groups of a cross-validation: means are means of the groups' means, every group weighing the same;
    rms is the root of the mean of their squares; max is the largest."""
    gathered: dict[str, Sequence[float]] = {}
    for group in groups:
        for name, value in group.items():
            gathered[name] = [*gathered.get(name, ()), value]
    found: Figures = {}
    for name in NAMES:
        if name not in gathered:
            continue
        values = np.array(gathered[name])
        if "_max_" in name or name in ("form_mm", "diameter_error_mm"):
            found[name] = float(values[np.argmax(np.abs(values))])
        elif "_rms_" in name:
            found[name] = float(np.sqrt(np.mean(values**2)))
        else:
            found[name] = float(values.mean())
    return found


def without_repeats(entries: Sequence[PlacementFigures], columns: Sequence[str]) -> list[str]:
    """Where every placement has one length, its signed error says all: the columns without the sizes of it."""
    mean, largest = "length_error_mean_abs_mm", "length_error_max_abs_mm"
    if all(entry.figures.get(mean) == entry.figures.get(largest) for entry in entries):
        return [name for name in columns if name not in (mean, largest)]
    return list(columns)
