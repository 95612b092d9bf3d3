"""What one would ask for by hand: blocks, orders and priors, each fitted as it stands."""

from collections.abc import Iterable, Mapping
from typing import Any

HARMONICS, COMPLIANCE = "encoder-harmonics", "compliance"
DRAWING = {
    "joint.*.theta0": 0.01,
    "joint.*.alpha": 0.01,
    "joint.*.beta": 0.01,
    "joint.*.a": 1.0,
    "joint.*.d": 1.0,
    "probe.*": 5.0,
}
"""How well a robot keeps to its drawing, rad and mm."""
STIFF = {"joint.*.compliance": 1e-4}
"""How much its joints may give way, rad/(N m)."""
SMALL = {"joint.*.[cs][0-9]*": 1e-4}
"""Amplitudes of each of many harmonics, rad."""


def with_drawing(
    extras: Iterable[str] = (), most: int = 0, more: Mapping[str, float] | None = None, **fit: Any
) -> dict[str, Any]:
    """Fields of `ulna.FitOptions`; most: highest order of harmonics; more: further priors."""
    blocks = [*([HARMONICS] if most else []), *extras]
    prior = DRAWING | (STIFF if COMPLIANCE in blocks else {}) | dict(more or {})
    return {"extras": blocks, "prior": prior} | ({"harmonics": list(range(1, most + 1))} if most else {}) | fit


CHOICES: dict[str, dict[str, Any]] = {
    "geometry, plain least squares": {},
    "with drawing": with_drawing(),
    "+ harmonics 1": with_drawing(most=1),
    "+ harmonics 1-2": with_drawing(most=2),
    "+ harmonics 1-4": with_drawing(most=4),
    "+ harmonics 1-10, small": with_drawing(most=10, more=SMALL),
    "+ compliance": with_drawing([COMPLIANCE]),
    "+ harmonics 1, compliance": with_drawing([COMPLIANCE], 1),
    "+ harmonics 1-2, compliance": with_drawing([COMPLIANCE], 2),
    "+ harmonics 1-10, small, compliance": with_drawing([COMPLIANCE], 10, SMALL),
    "+ harmonics 1-40, small, compliance": with_drawing([COMPLIANCE], 40, SMALL),
    "plain + harmonics 1-2": {"extras": [HARMONICS], "harmonics": [1, 2]},
    "plain + compliance": {"extras": [COMPLIANCE]},
    "all but joint 1": {"hold": ["joint.1.*"]},
    "all but lengths": {"hold": ["joint.*.a", "joint.*.d"]},
}
"""By the rows of the table; all of them also with the loss that was asked for."""
PLAIN, AUTO = "geometry, plain least squares", "auto"
SLOW = "+ harmonics 1-40, small, compliance"
"""Takes minutes where places are left out; no good there (benchmarks/choosing/__main__.py --slow)."""


def without_masses(choices: Mapping[str, dict[str, Any]]) -> dict[str, dict[str, Any]]:
    """Those that ask for nothing that masses are needed for."""
    return {name: fit for name, fit in choices.items() if COMPLIANCE not in fit.get("extras", [])}
