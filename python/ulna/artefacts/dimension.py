"""Single numbers that a certificate states of an artefact: lengths, diameters, offsets."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ulna.artefacts.artefact import Artefact
from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class Dimension:
    """One dimension of an artefact, as stated."""

    name: str
    """As in parameter names: `artefact.ball.diameter`."""
    value: float
    """In `unit`."""
    u: float
    fitted: bool
    unit: str = "mm"


def off_by(stated: Artefact, name: str, rng: np.random.Generator) -> Artefact:
    """The artefact with one dimension (`length_mm`, `diameter_mm`) off by a normal draw of u; None stays None."""
    value = getattr(stated, name)
    off_mm = stated.u_mm * float(rng.standard_normal())
    return stated if value is None else replace(stated, **{name: value + off_mm})


def needs_uncertainty(name: str, fit: bool, u: float | None, path: Path) -> None:
    """What is fitted needs an uncertainty to be fitted within. Raises UlnaInputError."""
    if fit and not u:
        raise UlnaInputError(
            f"{path}: key 'artefact.{name}.fit': true, but its uncertainty u is not stated; expected the standard "
            "uncertainty that it may move within. Add u, or remove the key."
        )
