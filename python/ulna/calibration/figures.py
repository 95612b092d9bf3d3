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

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import SURFACES
from ulna.artefacts.readings import Readings
from ulna.artefacts.surface import Errors, surface_errors
from ulna.calibration.placements import NAMES, Figures, Placements
from ulna.ground.arrays import F64, I64
from ulna.study.assembly import balls_mm, warmth_k
from ulna.study.study import Study

QUANTITIES = ("seat_scatter", "length_error", "coordinate_error", "form", "diameter_error")

MOST_PAIRED_SEATS = 500
"""Beyond this many seats in one placement the pairs of free points are too many to mean anything; no length error."""


@dataclass(frozen=True)
class _Group:
    """The errors of one artefact's touches, by quantity, and its placements in the order in which they appear."""

    readings: Readings
    placements: list[str]
    code: I64
    """(N,) number of each row's placement."""
    errors: dict[str, Errors]


def figures(arm: Arm, study: Study) -> tuple[Placements, Figures]:
    """Per artefact and placement, and over all touches and lengths of all of them together.

    `arm` must carry the study's probes in the study's order. Errors: those of the core for wrong shapes.
    """
    groups = [_group(arm, study, readings) for readings in study.readings]
    return Placements.joined([_by_placement(group) for group in groups]), _over_all(groups)


def overall_figures(arm: Arm, study: Study) -> Figures:
    """The same over all of them together alone."""
    return _over_all([_group(arm, study, readings) for readings in study.readings])


def _group(arm: Arm, study: Study, readings: Readings) -> _Group:
    # one probe for all is much quicker than one for each row
    probe = int(readings.probe[0]) if (readings.probe == readings.probe[0]).all() else readings.probe
    warmth = warmth_k(study, arm, readings)
    first_mm = arm.core.tip(np.ascontiguousarray(readings.q_rad), probe, warmth)
    second_mm = None
    if readings.p_rad is not None:
        second_mm = arm.core.tip(np.ascontiguousarray(readings.p_rad), probe, warmth)
    code, labels = readings.labels.as_they_appear()
    if readings.artefact.kind in SURFACES:
        errors = surface_errors(readings, code, first_mm, balls_mm(study, arm, readings)[readings.probe])
    else:
        errors = errors_of_tips(readings, code, first_mm, second_mm)
    return _Group(readings, labels, code, errors)


def _over_all(groups: Sequence[_Group]) -> Figures:
    found: Figures = {}
    for quantity in QUANTITIES:
        values = [group.errors[quantity].value_mm for group in groups if quantity in group.errors]
        if values:
            columns = _summaries(quantity, np.concatenate(values), np.zeros(1, dtype=np.int64))
            found.update({name: float(column[0]) for name, column in columns.items()})
    return found


def _by_placement(group: _Group) -> Placements:
    columns: dict[str, F64] = {}
    for quantity, errors in group.errors.items():
        order = np.argsort(errors.code, kind="stable")
        present, start = np.unique(errors.code[order], return_index=True)
        for name, values in _summaries(quantity, errors.value_mm[order], start).items():
            columns[name] = np.full(len(group.placements), np.nan)
            columns[name][present] = values
    artefact, counts = group.readings.artefact, np.bincount(group.code, minlength=len(group.placements))
    return Placements.of_columns(artefact.name, artefact.kind, group.placements, counts, columns)


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


def _summaries(quantity: str, values_mm: F64, start: I64) -> dict[str, F64]:
    """The figures of each run of values, by name; a run begins at each of `start`."""
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
    return dict(zip([name for name in NAMES if name.startswith(quantity)], columns, strict=True))


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
