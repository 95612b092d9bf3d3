"""Results that no certificate is made of, and what the user is told."""

from __future__ import annotations

import functools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.certificates import MINIMAL, document, make, nasty, without_noise

from ulna.documents.dcc.document import dcc_certificate
from ulna.ground.errors import UlnaInputError


@pytest.fixture
def made(tmp_path: Path) -> Callable[..., bytes]:
    return functools.partial(make, tmp_path)


def test_what_xml_cannot_hold_is_told(tmp_path: Path) -> None:
    result = document()
    nasty(result)
    result["outliers"][0]["placement"] = "on the\x01table"
    path, laboratory = tmp_path / "result.json", tmp_path / "lab.toml"
    path.write_text(json.dumps(result))
    laboratory.write_text(MINIMAL, encoding="utf-8")
    with pytest.raises(UlnaInputError, match=r"result\.json: the text .* control character U\+0001, which no XML"):
        dcc_certificate(path, laboratory)


def test_a_fit_that_did_not_converge_is_not_certified(made: Callable[..., bytes]) -> None:
    def fail(result: dict[str, Any]) -> None:
        result["fit"] |= {"converged": False, "termination": "max-iterations"}

    with pytest.raises(UlnaInputError, match=r"'fit.converged'.*did not converge \(max-iterations\).*Calibrate again"):
        made(fail)


DAMAGED: dict[str, tuple[Callable[[dict[str, Any]], Any], str]] = {
    "no provenance": (lambda result: result.pop("provenance"), "'provenance' is missing"),
    "no version": (lambda result: result["provenance"].pop("version"), "'provenance.version' is missing"),
    "a file without sum": (
        lambda result: result["provenance"]["files"][1].pop("sha256"),
        "'provenance.files.2.sha256' is missing",
    ),
    "a text for a number": (
        lambda result: result["parameters"][1].update(value="1"),
        "'parameters: joint.1.alpha': got '1', expected a number",
    ),
    "no figures": (lambda result: result["overall"].pop("before"), "'overall.before' is missing"),
    "a text as a figure": (
        lambda result: result["overall"]["after"].update(form_mm="x"),
        "'overall.after.form_mm': got 'x', expected a number",
    ),
    "a text in a placement": (
        lambda result: result["artefacts"][0].update(length_error_mean_mm="x"),
        "'artefacts.1.length_error_mean_mm': got 'x'",
    ),
    "another unit": (
        lambda result: result["parameters"][1].update(unit="deg"),
        "'parameters: joint.1.alpha': its unit is 'deg', but it is in rad",
    ),
    "another uncertainty": (
        lambda result: result["parameters"][1].update(u=1e-3),
        "'parameters: joint.1.alpha': its u is 0.001, but by the covariance in this file 4.59",
    ),
    "an uncertainty out of nothing": (
        lambda result: result["parameters"][0].update(u=1e-3, status="fitted"),
        "'parameters: joint.1.theta0': its status is 'fitted', but by the covariance in this file it was not free",
    ),
    "no degrees of freedom": (
        lambda result: (without_noise(result), result["fit"].update(degrees_of_freedom=0)),
        "'fit.degrees_of_freedom': 0 give no coverage factor",
    ),
}


@pytest.mark.parametrize("case", DAMAGED)
def test_a_damaged_result_is_told(made: Callable[..., bytes], case: str) -> None:
    change, expected = DAMAGED[case]
    with pytest.raises(UlnaInputError) as caught:
        made(change)
    assert expected in str(caught.value)
    assert "result.json" in str(caught.value)
