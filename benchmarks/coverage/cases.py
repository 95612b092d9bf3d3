"""The cases of simulated coverage: one row each of what is touched with which arm, how it errs, and what a study says.

Where a study states what is known of a parameter beforehand, each calibration starts from a drawing that is off by
that: a prior is true only of arms that it describes. Other parameters start anywhere near, effects beyond geometry at
nothing: what Ulna takes as known of them is wider than what arms have.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from benchmarks.coverage.artefacts import (
    Coordinates,
    Distances,
    Lengths,
    bar,
    cylinder,
    plane,
    plate,
    seats,
    sphere,
)
from benchmarks.coverage.touching import Artefact, Errors

MIXED = Errors(encoder_rad=1e-5, touch_mm=0.02)
"""At a metre, encoders and touches count about alike."""
ENCODERS = Errors(encoder_rad=5e-5, touch_mm=0.002)
FINE, FINEST = Errors(3e-6, 0.005), Errors(1e-6, 0.002)
WRIST = ("joint.6.*", "probe.*")
EVERYTHING = ("parameters", "lengths", "measured")
NOTHING: Mapping[str, Any] = MappingProxyType({})
RECIPE = MappingProxyType(
    {"joint.*.theta0": 0.01, "joint.*.alpha": 0.01, "joint.*.a": 1.0, "joint.*.d": 1.0, "probe.*": 5.0}
)
"""Of docs/real-readings.md: what is known of all of an arm beforehand, rad and mm."""


@dataclass(frozen=True)
class Case:
    """One row."""

    touched: tuple[Artefact, ...]
    arm: str = "seven"
    """One of `benchmarks.coverage.arms.ARMS`."""
    errors: Errors = MIXED
    states: float | None = None
    """What the study states of the noise, over what it is; None: nothing."""
    fit: Mapping[str, Any] = field(default_factory=lambda: NOTHING)
    """Fields of `ulna.FitOptions`."""
    priors: Mapping[str, float] = field(default_factory=lambda: NOTHING)
    """Pattern → standard uncertainty of what the drawing says."""
    effects_drawn: bool = False
    """Whether the drawing says of effects what is off by as much as Ulna takes for possible, 0.0005 rad; else it says
    nothing of them."""
    drawn_straight: bool = False
    """Whether the drawing has the tip on the last axis."""
    lacking: bool = False
    """Whether the study knows nothing of what joints do beyond geometry."""
    judged: tuple[str, ...] = EVERYTHING
    """Columns of the table."""
    parameters: tuple[str, ...] = ("*",)
    """Patterns of those that are judged."""


def harmonics(most: int) -> dict[str, Any]:
    """A study that asks for orders 1 to so many."""
    return {"extras": ["encoder-harmonics"], "harmonics": list(range(1, most + 1))}


def block(*names: str) -> dict[str, Any]:
    """A study that asks for blocks of the model."""
    return {"extras": list(names)}


HUBER, TUKEY, CAUCHY = ({"loss": loss} for loss in ("huber", "tukey", "cauchy"))
BARS = (bar(101),)
FEW = (bar(40),)
MANY = (bar(110),)
MISSED = Errors(1e-5, 0.02, missed=0.03)

CASES: dict[str, Case] = {
    # the noise, stated or not
    "noise stated": Case(BARS, states=1.0),
    "noise stated half": Case(BARS, states=0.5),
    "noise stated twice": Case(BARS, states=2.0),
    "noise not stated": Case(BARS),
    "noise not stated encoders dominate": Case(BARS, errors=ENCODERS),
    "noise stated encoders dominate": Case(BARS, errors=ENCODERS, states=1.0),
    # many parameters
    "harmonics 1-4": Case(BARS, "harmonics 1-4", fit=harmonics(4)),
    "harmonics 1-4 as wide as their prior": Case(BARS, "harmonics 1-4", fit=harmonics(4), effects_drawn=True),
    "harmonics 1-10": Case(BARS, "harmonics 1-10", fit=harmonics(10)),
    "harmonics 1-10 as wide as their prior": Case(BARS, "harmonics 1-10", fit=harmonics(10), effects_drawn=True),
    "harmonics 1-4 stated": Case(BARS, "harmonics 1-4", states=1.0, fit=harmonics(4)),
    "priors on all": Case(BARS, priors=RECIPE),
    "priors on all stated": Case(BARS, states=1.0, priors=RECIPE),
    # losses: 40 bars are 1.6 equations for each parameter, 101 four, 200 eight
    "huber 40 bars": Case(FEW, fit=HUBER),
    "huber 40 bars stated": Case(FEW, states=1.0, fit=HUBER),
    "huber 40 bars priors on all": Case(FEW, fit=HUBER, priors=RECIPE),
    "huber 75 bars": Case((bar(75),), fit=HUBER),
    "huber 110 bars": Case(MANY, fit=HUBER),
    "huber 110 bars priors on all": Case(MANY, fit=HUBER, priors=RECIPE),
    "huber 110 bars 3 % missed": Case(MANY, errors=MISSED, fit=HUBER),
    "huber 200 bars stated": Case((bar(200),), states=1.0, fit=HUBER),
    "tukey 110 bars": Case(MANY, fit=TUKEY),
    "cauchy 110 bars": Case(MANY, fit=CAUCHY),
    "tukey 110 bars stated": Case(MANY, states=1.0, fit=TUKEY),
    "cauchy 110 bars stated": Case(MANY, states=1.0, fit=CAUCHY),
    "huber 8 plates": Case((plate(8),), fit=HUBER),
    "huber harmonics 1": Case(BARS, "harmonics 1", fit=HUBER | harmonics(1)),
    "huber harmonics 1-2 stated": Case(BARS, "harmonics 1-2", states=1.0, fit=HUBER | harmonics(2)),
    "huber harmonics 1-4 stated": Case(BARS, "harmonics 1-4", states=1.0, fit=HUBER | harmonics(4)),
    # probes near the last axis
    "probe 0.3 mm off drawn straight": Case(BARS, "0.3 mm off", states=1.0, drawn_straight=True),
    "probe 0.1 mm off drawn straight": Case(BARS, "0.1 mm off", states=1.0, drawn_straight=True),
    "probe 0.7 mm off drawn nearly so": Case(BARS, "0.7 mm off", states=1.0),
    # the parameters that such a probe leaves nearly open, at a noise where a u is stated of them now and then
    "probe 0.3 mm off joint 6 and tip": Case(
        BARS, "0.3 mm off", FINE, states=1.0, drawn_straight=True, judged=("parameters",), parameters=WRIST
    ),
    "probe 0.1 mm off joint 6 and tip": Case(
        BARS, "0.1 mm off", FINEST, states=1.0, drawn_straight=True, judged=("parameters",), parameters=WRIST
    ),
    "probe straight": Case(BARS, "straight", states=1.0, drawn_straight=True),
    # what is not known of artefacts
    "two bars u 0.05 mm": Case((bar(50, 0.05), bar(50, 0.05, length_mm=300.0, name="short"))),
    "two bars u 0.05 mm stated": Case((bar(50, 0.05), bar(50, 0.05, length_mm=300.0, name="short")), states=1.0),
    "plate u 0.03 mm": Case((plate(8, 0.03),)),
    "plate u 0.03 mm stated": Case((plate(8, 0.03),), states=1.0),
    "plate u 0.03 mm fitted stated": Case((plate(8, 0.03, fit=True),), states=1.0),
    "bar u 0.05 mm fitted stated": Case((bar(101, 0.05, fit=True),), states=1.0),
    # arms
    "six axes": Case(BARS, "six"),
    "parallel axes": Case((bar(120),), "parallel"),
    "27 bars": Case((bar(27),), states=1.0),
    "60 bars": Case((bar(60),)),
    "short travel": Case(BARS, "short travel"),
    "short travel harmonics 1-4": Case(BARS, "short travel harmonics 1-4", fit=harmonics(4)),
    # blocks of the model
    "block harmonics": Case(BARS, "harmonics 1-2", fit=harmonics(2)),
    "block backlash": Case(BARS, "backlash", fit=block("backlash")),
    "block expansion": Case(BARS, "expansion", fit=block("link-expansion")),
    "block compliance": Case(BARS, "compliance", fit=block("compliance")),
    "block coupling": Case(BARS, "coupling", fit=block("coupling")),
    "block base": Case((Coordinates(70, "arm"),), "base", fit=block("base-tilt", "base-offset")),
    # kinds of artefacts
    "kind plate": Case((plate(8),)),
    "kind coordinates": Case((Coordinates(70, "free"),)),
    "kind coordinates in arm's frame": Case((Coordinates(70, "arm"),)),
    "kind length": Case((Lengths(101),)),
    "kind distance": Case((Distances(3, 50),)),
    "kind sphere": Case((sphere(8, 20),)),
    "kind cylinder": Case((cylinder(8, 20),)),
    "kind plane and bar": Case((plane(8, 15), bar(30))),
    "kind seat and bar": Case((seats(6, 15), bar(30))),
    # what the model lacks: nobody can say where such a parameter should be
    "lacks harmonics": Case(BARS, "harmonics 1-2", lacking=True, judged=("measured",)),
    "lacks harmonics stated": Case(BARS, "harmonics 1-2", states=1.0, lacking=True, judged=("measured",)),
    "lacks compliance": Case(BARS, "compliance", lacking=True, judged=("measured",)),
    "lacks compliance stated": Case(BARS, "compliance", states=1.0, lacking=True, judged=("measured",)),
}
"""By name, without commas, in the order of the table. "stated": the noise; where nothing is said of it, it is not."""
