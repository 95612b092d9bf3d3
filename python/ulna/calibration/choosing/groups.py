"""Readings that are left out together: places of artefacts where they are several, else regions of joint space.

What a model does not explain is alike for readings near each other, so single readings left out at random flatter every
model. A region is a part of the poses, halved again and again along the joint that varies most. Where a region is a
part of a placement, that placement counts as one for each region: of readings left out nothing is known from the
others, their placement neither.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64, I64, Bool
from ulna.study.study import Study

BY_PLACEMENTS, BY_REGIONS, BY_READINGS = "placements", "regions of placements", "regions of readings"
FEWEST_PLACES = 5
"""Of fewer placements one left out takes too much of the volume with it: what is left says little of another."""
MOST_PLACES = 10
"""Of more, those near each other are left out together."""
REGIONS = 8
FEWEST_READINGS = 12
"""In a region, on average."""
FEWEST_REGIONS = 4
FEWEST_OF_PART = 4
"""Readings of a placement in a region; fewer are left out of it all."""
MOST_READINGS = 5000
"""Of more, some say as well which model is best."""


@dataclass(frozen=True)
class Groups:
    """A study whose readings are told into groups."""

    by: str
    study: Study
    """The same readings; of a placement that was parted each part is one."""
    codes: list[I64]
    """(N,) of each of `study.readings`: the group of each row."""
    standings: I64
    """(S,) the group of each standing, in the core's order."""
    count: int


def groups_of(study: Study) -> Groups | None:
    """None where there are too few readings to leave some out."""
    found = codes_of(study)
    if found is None:
        return None
    by, codes = found
    if by == BY_READINGS and any(_placed(each) for each in study.readings):
        readings = [_parted(each, own) for each, own in zip(study.readings, codes, strict=True)]
        kept = [_large(each) for each in readings]
        codes = [code[mask] for code, mask in zip(codes, kept, strict=True) if mask.any()]
        study = dataclasses.replace(study, readings=readings).subset(kept)
    return _grouped(by, study, codes)


def codes_of(study: Study) -> tuple[str, list[I64]] | None:
    """What is left out together, and the group of each row of each of `study.readings`, no placement parted; None
    where there are too few."""
    units, count = _units(study)
    if count >= FEWEST_PLACES:
        of_unit = np.arange(count) if count <= MOST_PLACES else regions(_mean_pose(study, units, count), REGIONS)
        by = BY_PLACEMENTS if count <= MOST_PLACES else BY_READINGS
        if count > MOST_PLACES and any(_placed(each) for each in study.readings):
            by = BY_REGIONS
        return by, [of_unit[unit] for unit in units]
    total = sum(len(each) for each in study.readings)
    parts = min(REGIONS, total // FEWEST_READINGS)
    if parts < FEWEST_REGIONS:
        return None
    code = regions(np.concatenate([each.q_rad for each in study.readings]), parts)
    return BY_READINGS, np.split(code, np.cumsum([len(each) for each in study.readings])[:-1])


def whole(study: Study) -> Groups:
    """All readings as one group, none parted."""
    units, count = _units(study)
    codes = [np.zeros(len(unit), dtype=np.int64) for unit in units]
    return Groups("", study, codes, np.zeros(count, dtype=np.int64), 1)


def thinned(study: Study) -> Study:
    """With no more readings than `MOST_READINGS`: placements, or rows of few placements, drawn by the study's seed."""
    units, count = _units(study)
    total = sum(len(each) for each in study.readings)
    if total <= MOST_READINGS:
        return study
    if count < FEWEST_PLACES:
        ends = np.cumsum([len(each) for each in study.readings])
        units, count = [np.arange(end - len(r), end) for end, r in zip(ends, study.readings, strict=True)], total
    drawn = np.random.default_rng(study.fit.seed).permutation(count)
    sizes = np.bincount(np.concatenate(units), minlength=count)[drawn]
    kept = np.zeros(count, dtype=bool)
    kept[drawn[: max(int(np.searchsorted(np.cumsum(sizes), MOST_READINGS)), min(count, FEWEST_PLACES))]] = True
    return study.subset([kept[unit] for unit in units])


def regions(q_rad: F64, count: int) -> I64:
    """(N,) numbers of `count` regions of poses (N, n), of near-equal size."""
    parts = [np.arange(len(q_rad))]
    while len(parts) < count:
        largest = parts.pop(int(np.argmax([len(part) for part in parts])))
        joint = int(np.argmax(q_rad[largest].std(axis=0)))
        in_order = largest[np.argsort(q_rad[largest, joint], kind="stable")]
        parts += np.array_split(in_order, 2)
    code = np.empty(len(q_rad), dtype=np.int64)
    for number, part in enumerate(parts):
        code[part] = number
    return code


def _units(study: Study) -> tuple[list[I64], int]:
    """What stays together: placements; rows of their own where no placement is fitted."""
    units, total = [], 0
    for each in study.readings:
        code = each.placement_code if _placed(each) else np.arange(len(each))
        units.append(code + total)
        total += int(code.max()) + 1
    return units, total


def _mean_pose(study: Study, units: list[I64], count: int) -> F64:
    unit, q_rad = np.concatenate(units), np.concatenate([each.q_rad for each in study.readings])
    sums = np.zeros((count, q_rad.shape[1]))
    np.add.at(sums, unit, q_rad)
    mean: F64 = sums / np.bincount(unit, minlength=count)[:, None]
    return mean


def _placed(readings: Readings) -> bool:
    return kind_of(readings.artefact).placed(readings.artefact)


def _parted(readings: Readings, code: I64) -> Readings:
    if not _placed(readings):
        return readings
    placement = readings.placement_code
    labels = np.array([f"{a}/{b}" for a, b in zip(placement.tolist(), code.tolist(), strict=True)], dtype=object)
    return dataclasses.replace(readings, placement=labels)


def _large(readings: Readings) -> Bool:
    """(N,) false of parts with so few readings that they say next to nothing but where the part stands."""
    if not _placed(readings):
        return np.ones(len(readings), dtype=bool)
    large: Bool = np.bincount(readings.placement_code)[readings.placement_code] >= FEWEST_OF_PART
    return large


def _grouped(by: str, study: Study, codes: list[I64]) -> Groups:
    units, count = _units(study)
    standings = np.zeros(count, dtype=np.int64)
    for unit, code in zip(units, codes, strict=True):
        standings[unit] = code
    return Groups(by, study, codes, standings, int(max(code.max() for code in codes)) + 1)
