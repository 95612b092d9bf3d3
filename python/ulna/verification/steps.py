"""What a profile asks to be measured, as the list that an operator follows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ulna.verification.profile_tables import (
    ArticulationTest,
    DiameterTest,
    LengthTest,
    ProfileFile,
    SinglePointTest,
    SphereTest,
    TestTable,
)
from ulna.verification.tables import Ends

BALL = "ball"
FACE_TOUCHES = 3
"""Of a face of a gauge: they make a plane."""
SEATS = ("near", "middle", "far")
LONGEST_SHARE = 0.66
"""Of the range, where a profile does not say it."""


@dataclass(frozen=True)
class Step:
    """One touch."""

    test: str
    artefact: str = ""
    position: str = ""
    orientation: str = ""
    repeat: str = ""
    feature: str = ""
    what: str = ""


@dataclass(frozen=True)
class PlannedLength:
    """A length that the profile needs, as a share of the measuring range."""

    name: str
    share: float
    ends: Ends


def steps_of(profile: ProfileFile) -> list[Step]:
    """Every touch, in order."""
    return [step for name, table in profile.test.items() for step in _steps(name, table)]


def lengths_of(profile: ProfileFile) -> list[PlannedLength]:
    """Every calibrated length that is needed, each once."""
    found: dict[str, PlannedLength] = {}
    for table in profile.test.values():
        for length in _lengths(table):
            found[length.name] = length
    return list(found.values())


def needs_ball(profile: ProfileFile) -> bool:
    """Whether a ball is touched."""
    return any(table.kind in ("sphere", "articulation", "effective-diameter") for table in profile.test.values())


def _lengths(table: TestTable) -> list[PlannedLength]:
    if isinstance(table, LengthTest):
        longest = table.longest_share or LONGEST_SHARE
        ends: Ends = "opposite-faces" if table.direction == "bi" else "seats"
        word = "gauge" if table.direction == "bi" else "length"
        count = table.lengths
        # a little above the least share, so that a length rounded to mm is not below it
        return [PlannedLength(f"{word}-{k}", 1.01 * longest * k / count, ends) for k in range(1, count + 1)]
    if table.kind == "volumetric":
        shares = [0.25 * (least + most) for least, most in table.shares] or [LONGEST_SHARE * 0.5]
        shares += shares[-1:] * (table.lengths - len(shares))
        return [PlannedLength(f"bar-{k}", share, "seats") for k, share in enumerate(shares[: table.lengths], start=1)]
    return []


def _steps(name: str, table: TestTable) -> Iterator[Step]:
    if isinstance(table, SphereTest):
        for position in range(1, table.positions + 1):
            what = f"ball in place {position}: touch it all around, over half of it"
            yield from [Step(name, BALL, str(position), what=what)] * table.points
    elif isinstance(table, ArticulationTest):
        for orientation in range(1, table.orientations + 1):
            what = f"probe in orientation {orientation}: touch the ball over half of it"
            yield from [Step(name, BALL, "1", str(orientation), what=what)] * table.points
    elif isinstance(table, DiameterTest):
        for repeat in range(1, table.repeats + 1):
            what = f"ball near middle reach, measurement {repeat}: touch it all around"
            yield from [Step(name, BALL, repeat=str(repeat), what=what)] * table.points
    elif isinstance(table, SinglePointTest):
        for k in range(table.positions):
            place = SEATS[k] if table.positions == len(SEATS) else str(k + 1)
            what = f"seat '{place}': touch it, move elbow and wrist between touches"
            yield from [Step(name, "", place, what=what)] * table.points
    else:
        yield from _length_steps(name, table)


def _length_steps(name: str, table: TestTable) -> Iterator[Step]:
    lengths = _lengths(table)
    if isinstance(table, LengthTest):
        places = [(length, str(place)) for length in lengths for place in range(1, table.positions + 1)]
        repeats = [str(repeat) for repeat in range(1, table.repeats + 1)]
    else:
        assert table.kind == "volumetric"
        places = [(lengths[k % len(lengths)], str(k + 1)) for k in range(table.positions)]
        places.sort(key=lambda place: place[0].name)
        repeats = [""]
    for length, place in places:
        for repeat in repeats:
            for feature in "AB":
                touches = FACE_TOUCHES if length.ends == "opposite-faces" else 1
                end = "face" if length.ends == "opposite-faces" else "seat"
                what = f"{length.name} in place {place}: touch {end} {feature}"
                yield from [Step(name, length.name, place, "", repeat, feature, what)] * touches
