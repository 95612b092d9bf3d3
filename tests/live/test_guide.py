"""Where to touch next: of every kind of artefact that a plan knows, and better than anywhere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.live.guided_hand import platinum_plan

import ulna
from ulna.artefacts.artefact import Artefact
from ulna.live.guide import Guide
from ulna.live.running import RunningFit
from ulna.live.touches import Touch
from ulna.study.data import FitOptions, Noise

PLATE = {"1": (0.0, 0.0, 0.0), "2": (200.0, 0.0, 0.0), "3": (0.0, 150.0, 0.0)}
GRID = {"1": (300.0, 0.0, 100.0), "2": (300.0, 250.0, 150.0), "3": (350.0, -200.0, 200.0), "4": (250.0, 150.0, 300.0)}
ARTEFACTS = [
    Artefact("bar", "bar", features={"A": (0.0, 0.0, 0.0), "B": (400.0, 0.0, 0.0)}, length_mm=400.0),
    Artefact("plate", "points", features=PLATE),
    Artefact("grid", "points", features=GRID, frame="arm"),
    Artefact("cone", "seat", features={"seat": (0.0, 0.0, 0.0)}),
    Artefact("ball", "sphere", features={}, diameter_mm=50.0),
]


def begun(artefact: Artefact) -> tuple[ulna.Arm, RunningFit, Guide]:
    arm, spec = platinum_plan()
    probes = {name: replace(probe, ball_mm=6.0) for name, probe in arm.probes.items()}
    arm = replace(arm, probes=probes)
    spec = replace(spec, artefact=artefact, touches=12 if artefact.kind == "sphere" else 1)
    noise = Noise(spec.encoder_rad, spec.seat_mm)
    fit = RunningFit(arm, [artefact], noise, FitOptions(hold=spec.hold))
    return arm, fit, Guide(fit, spec)


@pytest.mark.parametrize("artefact", ARTEFACTS, ids=lambda artefact: artefact.name)
def test_following_the_guide_lowers_the_uncertainty_of_lengths(artefact: Artefact) -> None:
    arm, fit, guide = begun(artefact)
    rng = np.random.default_rng(1)
    so_far, place, places = fit.so_far(), 0, []
    before = guide.worth(so_far).u_mm
    for number in range(1, 31):
        suggestion = guide.next(so_far, str(place) if place else None)
        assert np.isfinite(suggestion.q_rad).all()
        # exactly there: the posture puts the tip on the point that is said
        assert np.linalg.norm(arm.core.tip(suggestion.q_rad[None], 0)[0] - suggestion.point_mm) < 0.5
        place += not suggestion.here
        places.append(place)
        feature = suggestion.feature if artefact.features else 0
        read = suggestion.q_rad + 5e-6 * rng.standard_normal(arm.n)
        fit.add(Touch(number, artefact.name, str(place), feature, 0, read))
        so_far = fit.so_far()
    after = guide.worth(so_far).u_mm
    assert after < 0.5 * before
    if artefact.frame == "arm":
        assert set(places) == {0}
        assert len({touch.feature for touch in fit.touches}) == len(GRID)
    else:
        # neither moved at every touch nor never
        assert 1 < len(set(places)) < 16
    # a cone knows no length at all: no number of touches makes an arm of it that is known so well
    assert (guide.touches_more(so_far, 0.5 * after) is None) == (artefact.kind == "seat")
    assert guide.touches_more(so_far, 1.5 * after) is None


def test_after_an_interruption_a_place_that_was_half_touched_is_no_trouble() -> None:
    _, fit, guide = begun(ARTEFACTS[0])
    suggestion = guide.next(fit.so_far(), None)
    fit.add(Touch(1, "bar", "1", 0, 0, suggestion.q_rad))
    again = Guide(fit, guide.spec, seed=3)
    assert np.isfinite(again.next(fit.so_far(), "1").q_rad).all()
