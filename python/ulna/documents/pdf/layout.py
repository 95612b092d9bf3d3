"""How wide the columns of each table are on paper; columns that are not named have no room and are left out."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Layout:
    """Of one table."""

    widths: dict[str, float]
    """Key of a column → its share of the width; 0 for as wide as its cells."""
    size_pt: float = 8.0


def _shares(share: float, *keys: str) -> dict[str, float]:
    return dict.fromkeys(keys, share)


#: table → its layout
LAYOUTS: dict[str, Layout] = {
    "parameters": Layout(
        {"number": 0, "parameter": 3, "unit": 0, "status": 1.6, **_shares(0, "nominal", "estimate", "expanded")}
    ),
    "cylindrical": Layout({"probe": 2, **_shares(0, "parameter", "unit"), **_shares(1, "status", "value", "expanded")}),
    "directions": Layout({"combination": 1.3, "cause": 1, "because": 1.6, "remedy": 1.6}),
    "quality": Layout(
        {"quantity": 2.1, "readings": 1.9}
        | _shares(1, *(f"{what}-{when}" for what in ("mean", "rms", "sigma", "max") for when in ("before", "after"))),
        size_pt=7.5,
    ),
    "coverage": Layout({"quantity": 1, "readings": 2, **_shares(1, "judged", "inside", "share"), "interval": 1.6}),
    "artefacts": Layout({"artefact": 1.5, "kind": 1, "calibrated": 2, "u": 1.5, "placements": 0, "count": 0}),
    "equipment": Layout({"standard": 3, "serial": 2, "certificate": 2, "certified-by": 3}, size_pt=8.5),
    "standards": Layout(
        {"artefact": 1.8, "kind": 1.5, "used-in": 1.2, "calibrated": 2, "u": 0, "certificate": 1.2}, size_pt=7.5
    ),
    "extras": Layout(
        {"extra": 1.6, "quantity": 1.8, "verdict": 1.2, **_shares(1, "without", "with", "better", "u-better")}
    ),
    "tried": Layout(
        {"model": 2.6, "chosen": 0.9}
        | _shares(1, "parameters-more", "lengths-u", "prior-u", "left-out", "worse", "u-worse"),
        size_pt=7.5,
    ),
    "moved-lengths": Layout(
        {
            "lengths": 1.2,
            "how-many": 0.8,
            **_shares(1, "change-rms", "change-largest", "change-expanded", "change-share"),
        }
    ),
    "moved-parameters": Layout({"parameter": 2, "unit": 0.8, **_shares(1, "change", "u", "change-ratio")}),
    "mapped": Layout({"map-joint": 0.6, "follows": 1.2, **_shares(1, "map-share", "u-worse", "amplitude")}),
    "outliers": Layout(
        {"row": 0, "file": 1.5, **_shares(1, "artefact", "placement", "probe"), "size": 0, "times": 1, "counted": 0.9},
        size_pt=7.5,
    ),
    "verification": Layout(
        {"condition": 1.7, "figure": 2.7, "verdict": 1.5}
        | _shares(1, "value-mm", "expanded-mm", "limit-mm", "guard-mm")
        | {"values": 0.9}
    ),
    "risk": Layout(
        {"condition": 1.3, "figure": 0.8}
        | _shares(1.3, "conformity", "specific")
        | _shares(1.5, "consumer-at-most", "producer-at-most")
    ),
    "global-risk": Layout(
        {"condition": 1.3, "figure": 0.8} | _shares(1.4, "consumer", "producer", "withheld", "undecided")
    ),
    "files": Layout({"file": 1, "sha256": 0, "state": 0}, size_pt=7.5),
}
