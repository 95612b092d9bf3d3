"""Points that touches set, p1, p2, …, and features made of them: a length, a ball, a circle, a plane, each with U."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError, nearest
from ulna.live.figures import Calibrated, Figure
from ulna.uncertainties.measurands import MEASURANDS


@dataclass(frozen=True)
class FeatureKind:
    """What touches can be made into."""

    measurand: str
    form: str | None
    """The measurand that says how far the surface is from it, where touches are enough."""
    most: int | None
    """Touches that it takes; None: any number."""
    what: str
    """In words."""

    @property
    def least(self) -> int:
        """Touches from which on it is known."""
        return sum(MEASURANDS[self.measurand].features.values())


FEATURES: dict[str, FeatureKind] = {
    "point": FeatureKind("point", None, None, "the mean of its touches"),
    "length": FeatureKind("length", None, 2, "from its first touch to its second"),
    "ball": FeatureKind("ball", "sphericity", None, "least-squares sphere, the probe's own ball taken off"),
    "circle": FeatureKind(
        "circle", "roundness", None, "least-squares circle, the probe's own ball taken off in its plane"
    ),
    "plane": FeatureKind("plane", "flatness", None, "least-squares plane"),
    "distance": FeatureKind("distance", None, None, "of its last touch from the plane of those before"),
}
"""Word → what it is: in the order in which a key goes through them."""


@dataclass(frozen=True)
class Point:
    """A touch, by its name."""

    name: str
    q_rad: F64
    """(n,) mean encoder angles of the dwell."""
    samples: int
    spread_mm: float
    drift_mm: float
    begun_s: float
    ended_s: float
    figures: tuple[Figure, ...]
    """x, y, z."""

    def as_dict(self) -> dict[str, Any]:
        """As JSON has it."""
        return {
            "name": self.name,
            **{each.name: each.as_dict() for each in self.figures},
            "q_rad": self.q_rad.tolist(),
            "samples": self.samples,
            "spread_mm": self.spread_mm,
            "drift_mm": self.drift_mm,
            "begun_s": self.begun_s,
            "ended_s": self.ended_s,
        }


@dataclass
class Feature:
    """Points that make one."""

    name: str
    kind: str
    points: list[Point] = field(default_factory=list)

    @property
    def full(self) -> bool:
        """Whether another touch begins another."""
        most = FEATURES[self.kind].most
        return most is not None and len(self.points) >= most

    @property
    def lacking(self) -> int:
        """Touches that are still needed."""
        return max(0, FEATURES[self.kind].least - len(self.points))

    def figures(self, arm: Calibrated) -> list[Figure]:
        """Its values; none as long as touches lack."""
        if self.lacking:
            return []
        kind = FEATURES[self.kind]
        taken = self.points[: kind.most]
        poses = [point.q_rad for point in taken]
        found = arm.figures(kind.measurand, poses, self.name)
        if kind.form is not None and len(poses) >= sum(MEASURANDS[kind.form].features.values()):
            found += arm.figures(kind.form, poses, self.name)
        return found


@dataclass(frozen=True)
class Asked:
    """A feature of points by their names: "length p1 p2"."""

    words: str
    kind: str
    names: tuple[str, ...]

    def of(self, points: Sequence[Point]) -> Feature | None:
        """None as long as not all of them are taken."""
        known = {point.name: point for point in points}
        if not all(name in known for name in self.names):
            return None
        return Feature(self.words, self.kind, [known[name] for name in self.names])


def asked_for(texts: Sequence[str]) -> tuple[str, list[Asked]]:
    """What touches become from the first on ("ball"; "point" where nothing is said), and what is asked of named points
    ("length p1 p2"). Raises UlnaInputError."""
    begin: list[str] = []
    named: list[Asked] = []
    for text in texts:
        kind, *names = text.split() or [""]
        if kind not in FEATURES:
            raise UlnaInputError(
                f"option --feature: got '{text}'; expected {', '.join(FEATURES)}, alone or with names of points "
                f"(length p1 p2).{nearest(kind, FEATURES)}"
            )
        if not names:
            begin.append(kind)
            continue
        what = FEATURES[kind]
        if len(names) < what.least or (what.most is not None and len(names) > what.most):
            count = what.least if what.most == what.least else f"{what.least} or more"
            raise UlnaInputError(
                f"option --feature: '{text}' has {len(names)} points; expected {count} of a {kind}. Name them p1, p2, …"
            )
        for name in names:
            if not (name[:1] == "p" and name[1:].isdecimal() and name[1:].isascii() and name[1] != "0"):
                raise UlnaInputError(
                    f"option --feature: '{text}': got '{name}'; expected names of touches as they come, p1, p2, …"
                )
        if len(set(names)) < len(names):
            raise UlnaInputError(f"option --feature: '{text}' names a point twice; expected each once. Correct it.")
        named.append(Asked(" ".join([kind, *names]), kind, tuple(names)))
    if len(begin) > 1:
        raise UlnaInputError(
            f"option --feature: got {' and '.join(begin)} without names of points; expected one of them, for what "
            "touches become from the first on. Leave the others out."
        )
    return (begin[0] if begin else "point"), named


class Notebook:
    """What was taken, in its order."""

    def __init__(self, kind: str = "point", asked: Sequence[Asked] = ()) -> None:
        self.asked = list(asked)
        self.features: list[Feature] = [Feature("f1", kind)]

    @property
    def points(self) -> list[Point]:
        """All that were not taken back."""
        return [point for feature in self.features for point in feature.points]

    @property
    def current(self) -> Feature:
        """What the next touch belongs to, unless it is full."""
        return self.features[-1]

    def next_name(self) -> str:
        """Of the next point; one that was taken back hands its name on."""
        return f"p{len(self.points) + 1}"

    def take(self, point: Point) -> Feature:
        """What it became part of."""
        if self.current.full:
            self.new()
        self.current.points.append(point)
        return self.current

    def new(self) -> None:
        """The next touch begins another feature of the same kind."""
        if self.current.points:
            number = int(self.current.name[1:]) + 1
            self.features.append(Feature(f"f{number}", self.current.kind))

    def turn_kind(self) -> None:
        """What is touched is the next kind; what was touched of it stays."""
        kinds = list(FEATURES)
        self.current.kind = kinds[(kinds.index(self.current.kind) + 1) % len(kinds)]

    def take_back(self) -> Point | None:
        """The last point; None where there is none."""
        while len(self.features) > 1 and not self.current.points:
            self.features.pop()
        return self.current.points.pop() if self.current.points else None
