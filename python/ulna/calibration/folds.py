"""Which readings are left out together when a study is cross-validated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ulna.artefacts.kinds import kind_of
from ulna.ground.errors import UlnaInputError
from ulna.study.study import Study

Bool = NDArray[np.bool_]
I64 = NDArray[np.int64]


@dataclass(frozen=True)
class Fold:
    """Readings that are left out together."""

    name: str
    masks: list[Bool]
    """One (N,) for each of `Study.readings`: true where left out."""

    @property
    def rows(self) -> int:
        """Number of rows left out."""
        return int(sum(mask.sum() for mask in self.masks))


def folds(study: Study, by: str | int) -> tuple[str, list[Fold]]:
    """How the groups are called together, and the groups. Raises UlnaInputError where there are fewer than two."""
    if isinstance(by, int) and not isinstance(by, bool):
        return _dealt(study, by)
    if by == "artefact":
        found = [
            Fold(readings.artefact.name, [np.full(len(other), other is readings) for other in study.readings])
            for readings in study.readings
        ]
    elif by == "placement":
        found = _by_placement(study)
    else:
        raise UlnaInputError(
            f"cross-validation by {by!r}; expected 'placement', 'artefact' or a number of folds such as 10."
        )
    if len(found) < 2:
        most = _dealt_units(study)[1]
        more = f" Or deal the readings into folds: by a number from 2 to {most}, such as {min(most, 10)}."
        more = more if most >= 2 else ""
        raise UlnaInputError(
            f"{study.label}: the readings are all of one {by}, so leaving it out leaves nothing to fit; expected two "
            f"or more. Name each standing of an artefact in the column 'placement', or measure more of them.{more}"
        )
    return by, found


def _by_placement(study: Study) -> list[Fold]:
    several = len(study.readings) > 1
    found = []
    for k, readings in enumerate(study.readings):
        code, labels = readings.labels.as_they_appear()
        for number, label in enumerate(labels):
            masks = [np.zeros(len(other), dtype=bool) for other in study.readings]
            masks[k] = code == number
            found.append(Fold(f"{readings.artefact.name}/{label}" if several else label, masks))
    return found


def _dealt(study: Study, count: int) -> tuple[str, list[Fold]]:
    """Random folds of near-equal size."""
    units, unit_count, what = _dealt_units(study)
    if not 2 <= count <= unit_count:
        kind = what if unit_count != 1 else what.removesuffix("s")
        if unit_count < 2:
            remedy = "expected two or more to deal. Measure more placements."
        else:
            remedy = f"expected a number from 2 to {unit_count}."
        if what == "placements" and unit_count >= 2:
            remedy += (
                f" What stands together is left out together. Ask for at most {unit_count} folds, or measure more "
                "placements."
            )
        raise UlnaInputError(f"{study.label}: {count} folds of {unit_count} {kind}; {remedy}")
    dealt = np.arange(unit_count) % count
    np.random.default_rng(study.fit.seed).shuffle(dealt)
    width = len(str(count))
    return f"{count} folds of {what}", [
        Fold(f"fold {fold + 1:0{width}}", [dealt[unit] == fold for unit in units]) for fold in range(count)
    ]


def _dealt_units(study: Study) -> tuple[list[I64], int, str]:
    """What is dealt: the unit of each row, how many units, and what they are called.

    What stands together stays together, so that nothing of a placement that is judged was fitted. Length rows, and
    points in the arm's frame, stand alone. Where all readings are of one placement its single readings are dealt,
    except of a bar: with single readings left out it would lose an end, and with it the length that is judged.
    """
    units, count = _standings(study)
    if count >= 2 or any(kind_of(readings.artefact).indivisible for readings in study.readings):
        return units, count, "placements"
    return *_single_readings(study), "readings"


def _standings(study: Study) -> tuple[list[I64], int]:
    """The unit of each row, and how many units: placements; rows of their own where no placement is fitted."""
    units: list[I64] = []
    total = 0
    for readings in study.readings:
        placed = kind_of(readings.artefact).placed(readings.artefact)
        code = readings.placement_code if placed else np.arange(len(readings))
        units.append(code + total)
        total += int(code.max()) + 1 if len(code) else 0
    return units, total


def _single_readings(study: Study) -> tuple[list[I64], int]:
    ends = np.cumsum([len(readings) for readings in study.readings])
    return [np.arange(end - len(r), end) for end, r in zip(ends, study.readings, strict=True)], int(ends[-1])
