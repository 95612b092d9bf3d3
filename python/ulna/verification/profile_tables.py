"""The tables of a profile, `ulna-profile/1`: which tests there are, how much is measured, how it is decided."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from ulna.formats.models import Strict
from ulna.formats.units import LengthUnit

Count = Annotated[int, Field(ge=1, le=100_000)]
Positive = Annotated[float, Field(gt=0)]
Share = Annotated[float, Field(ge=0, le=10)]
Shares = list[Annotated[list[Share], Field(min_length=2, max_length=2)]]
Rule = Literal["1.65u", "U", "simple"]


class SphereTest(Strict):
    """P_Size and P_Form: one ball touched all around, in several places."""

    kind: Literal["sphere"]
    positions: Count
    points: Count
    """On the ball in each place."""


class ArticulationTest(Strict):
    """L_Dia: one ball touched in several orientations of the probe."""

    kind: Literal["articulation"]
    orientations: Count
    points: Count
    """In each orientation."""


class LengthTest(Strict):
    """E_Uni or E_Bi: calibrated lengths in several places."""

    kind: Literal["length"]
    direction: Literal["uni", "bi"]
    """Both ends touched from the same direction (or centre to centre), or from opposing ones."""
    lengths: Count
    positions: Count
    repeats: Count
    longest_share: Share | None = None
    """Of the measuring range: the longest length is to be at least so long."""


class DiameterTest(Strict):
    """Effective diameter: one ball measured several times."""

    kind: Literal["effective-diameter"]
    repeats: Count
    points: Count
    """Of each measurement."""


class SinglePointTest(Strict):
    """One seat touched again and again while elbow and wrist move, near, at middle reach, and far."""

    kind: Literal["single-point"]
    positions: Count
    """Seats."""
    points: Count
    """Touches of each."""
    figures: Annotated[list[Literal["asme", "faro"]], Field(min_length=1)]
    """Whose figures: ASME's deviations from the mean, FARO's half ranges of the coordinates."""
    shares: Shares = Field(default_factory=list)
    """Of the reach, half the range: [least, most] distance of each seat from the base, the nearest first."""


class VolumetricTest(Strict):
    """A ball bar in various places and directions."""

    kind: Literal["volumetric"]
    positions: Count
    """Lengths in all, of all bars."""
    lengths: Count
    """Bars."""
    shares: Shares = Field(default_factory=list)
    """Of the reach, half the range: [least, most] length of each bar, the shortest bar first."""


KINDS = ("sphere", "articulation", "length", "effective-diameter", "single-point", "volumetric")


def _kind(table: Any) -> str:
    kind = table.get("kind") if isinstance(table, dict) else getattr(table, "kind", None)
    return f"<{kind}>"


TestTable = Annotated[
    Annotated[SphereTest, Tag("<sphere>")]
    | Annotated[ArticulationTest, Tag("<articulation>")]
    | Annotated[LengthTest, Tag("<length>")]
    | Annotated[DiameterTest, Tag("<effective-diameter>")]
    | Annotated[SinglePointTest, Tag("<single-point>")]
    | Annotated[VolumetricTest, Tag("<volumetric>")],
    Discriminator(_kind),
]


class LimitTable(Strict):
    """A limit that grows with the length: a + L / b."""

    a: Annotated[float, Field(ge=0)]
    """A length."""
    b: Positive
    """No unit: 40000 is 25 µm for each metre."""


def _limit_kind(limit: Any) -> str:
    return "<grows>" if isinstance(limit, dict | LimitTable) else "<constant>"


LimitValue = Annotated[
    Annotated[Positive, Tag("<constant>")] | Annotated[LimitTable, Tag("<grows>")], Discriminator(_limit_kind)
]


class DecisionTable(Strict):
    """When a value passes."""

    rule: Rule
    """Guard band: "1.65u" (ISO 14253-1:2017), "U" (its older editions) or "simple" (none)."""
    k: Positive
    """Coverage factor of the expanded uncertainty U = k u."""
    p: Annotated[float, Field(gt=0.5, lt=1)]
    """Its coverage probability."""


class ProfileFile(Strict):
    """What is tested and how it is decided: `ulna-profile/1`."""

    format: Literal["ulna-profile/1"]
    name: str
    based_on: str | None = None
    """Name or path of another profile: what is not said here is as there."""
    standard: str
    statement: str
    """What reports say of it."""
    decision: DecisionTable
    test: Annotated[dict[str, TestTable], Field(min_length=1)]
    """By name."""
    without: list[str] = Field(default_factory=list)
    """Tests of the profile that this is based on, left out."""
    unit: LengthUnit | None = None
    """Of the limits."""
    limit: dict[str, LimitValue] = Field(default_factory=dict)
    """Maximum permissible errors, by the short name of a figure; those of a verify file come first."""
