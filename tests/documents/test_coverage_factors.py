"""The coverage factors of certificates: they cover as often as they say, in simulation."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ulna import Result
from ulna.documents.certified.parameters import stated_parameters

RESULT = Path(__file__).resolve().parents[1] / "data" / "fossils" / "result-1.json"
TRIALS = 40_000


@pytest.mark.parametrize("freedom", [None, 8])
def test_intervals_and_region_cover_as_often_as_they_say(tmp_path: Path, freedom: int | None) -> None:
    """Estimates drawn about a truth of zero; with an estimated noise their covariance is drawn too, as χ²/ν."""
    document = json.loads(RESULT.read_text(encoding="utf-8"))
    if freedom is not None:
        document["provenance"]["noise"] = None
        document["fit"]["degrees_of_freedom"] = freedom
    (tmp_path / "result.json").write_text(json.dumps(document))
    stated = stated_parameters(Result.load(tmp_path))
    n = len(stated.fitted)
    rng = np.random.default_rng(4)
    white = rng.standard_normal((TRIALS, n))
    variance = np.ones(TRIALS) if freedom is None else rng.chisquare(freedom, TRIALS) / freedom
    within = (white**2).sum(axis=1) <= stated.k_region**2 * variance
    u = np.sqrt(np.diag(stated.covariance))
    drawn = white @ np.linalg.cholesky(stated.covariance / np.outer(u, u)).T
    each = np.abs(drawn) <= stated.k * np.sqrt(variance)[:, np.newaxis]
    assert within.mean() == pytest.approx(stated.p, abs=0.005)
    assert each.mean(axis=0) == pytest.approx(np.full(n, stated.p), abs=0.006)


def test_parameters_are_sorted_by_what_can_be_said() -> None:
    stated = stated_parameters(Result.load(RESULT))
    assert [row.name for row in stated.held] == ["joint.1.theta0"]
    assert [row.name for row in stated.lost] == ["joint.1.d", *(f"probe.straight.{axis}" for axis in "xyz")]
    assert (len(stated.fitted), len(stated.unsure)) == (17, 0)
    assert stated.expanded == pytest.approx([stated.k * np.sqrt(c) for c in np.diag(stated.covariance)])
