"""The harness that judges stated intervals (benchmarks/coverage): its statistics, and that it runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.coverage import real, simulated
from benchmarks.coverage.artefacts import Coordinates, Lengths
from benchmarks.coverage.cases import CASES, Case
from benchmarks.coverage.judging import counted
from benchmarks.coverage.statistics import (
    coverage_factor,
    inside,
    share_of_clusters,
    squared_radius,
    wilson,
)


@pytest.mark.parametrize(
    ("held", "judged", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_wilson_as_published(held: int, judged: int, low: float, high: float) -> None:
    """Newcombe, Statistics in Medicine 17 (1998), Table I, method 3."""
    assert wilson(held, judged) == (pytest.approx(low, abs=5e-5), pytest.approx(high, abs=5e-5))


def test_a_share_is_known_as_well_as_there_are_calibrations() -> None:
    single = np.array([1] * 90 + [0] * 10)
    alone = share_of_clusters(single, np.ones(100))
    assert alone.share == 0.9
    assert alone.standard_error == pytest.approx(np.sqrt(0.9 * 0.1 / 99))
    # 40 lengths that are all right or all wrong say no more than one
    together = share_of_clusters(40 * single, np.full(100, 40))
    assert (together.judged, together.share) == (4000, 0.9)
    assert together.standard_error == pytest.approx(alone.standard_error)
    independent = share_of_clusters(np.random.default_rng(1).binomial(40, 0.9, 2000), np.full(2000, 40))
    assert independent.standard_error == pytest.approx(np.sqrt(0.9 * 0.1 / 80_000), rel=0.05)


def test_intervals_of_known_coverage() -> None:
    """u half of what it should be holds 67.3 % (2 Φ(0.98) - 1); then three coordinates together, and with a factor
    common to them that was estimated."""
    rng = np.random.default_rng(2)
    error = rng.standard_normal(100_000)
    u = np.where(np.arange(len(error)) % 10 == 0, np.nan, 0.5)
    held, judged, without = counted(error, u, coverage_factor(np.inf))
    assert (judged, without) == (90_000, 10_000)
    assert held / judged == pytest.approx(0.6729, abs=0.005)
    root = np.array([[2.0, 0.0, 0.0], [1.0, 0.5, 0.0], [-0.3, 0.2, 0.1]])
    errors, covariance = rng.standard_normal((50_000, 3)) @ root.T, root @ root.T
    assert inside(errors, np.tile(covariance, (50_000, 1, 1)), squared_radius(np.inf)).mean() == pytest.approx(
        0.95, abs=0.004
    )
    estimated = rng.chisquare(8, 50_000) / 8.0
    covariances = estimated[:, None, None] * covariance
    assert inside(errors, covariances, squared_radius(8.0)).mean() == pytest.approx(0.95, abs=0.004)
    assert coverage_factor(10) == pytest.approx(2.228, abs=5e-4)  # GUM, Table G.2


class Points:
    """Measured points that err together."""

    def __init__(self, whole_mm2: np.ndarray) -> None:
        self.whole_mm2 = whole_mm2
        blocks = whole_mm2.reshape(len(whole_mm2) // 3, 3, -1, 3)
        self.covariance_mm2 = np.stack([blocks[k, :, k] for k in range(len(blocks))])

    def joint_covariance_mm2(self, rows: np.ndarray) -> np.ndarray:
        return self.whole_mm2.copy()


def test_what_a_socket_takes_off_is_no_error_of_the_arm() -> None:
    """Points that err mostly together, judged about their mean: 95 %, whatever they have in common."""
    rng = np.random.default_rng(3)
    root = np.hstack([np.tile(5.0 * np.eye(3), (6, 1)), 0.1 * rng.standard_normal((18, 18))])
    points, shift = Points(root @ root.T), np.tile(np.eye(3), (6, 1))
    hits = []
    for _ in range(1500):
        off = (root @ rng.standard_normal(21)).reshape(6, 3)
        rest, covariance = real.left_over(points, np.arange(6), off, shift)  # type: ignore[arg-type]
        assert np.allclose(rest, off - off.mean(axis=0))
        hits.append(inside(rest, covariance, squared_radius(np.inf)))
    assert np.mean(hits) == pytest.approx(0.95, abs=0.009)


def test_the_simulated_harness(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Cases that need no search for places; with the noise as stated, parameters and lengths hold."""
    monkeypatch.setitem(CASES, "few lengths", Case((Lengths(101),), states=1.0))
    monkeypatch.setitem(CASES, "few coordinates", Case((Coordinates(70, "arm"),), "base", fit=CASES["block base"].fit))
    found = simulated.some("few lengths", 0, 16)
    for what in ("parameters", "lengths"):
        share = share_of_clusters(*np.array([each.held[what][:2] for each in found]).T)
        assert share.share == pytest.approx(0.95, abs=0.05), what
    simulated.main(["--calibrations", "2", "--cases", "few c*"])
    *_, row = capsys.readouterr().out.splitlines()
    assert row.startswith("| few coordinates | – | ")
    assert [each.failed for each in found] == [""] * 16


def test_every_case_has_its_arm() -> None:
    """The independent arm and Ulna's with the same numbers have the same tips: `in_ulna` looks."""
    from benchmarks.coverage.arms import ARMS

    assert {case.arm for case in CASES.values()} <= set(ARMS)
    assert not [name for name in CASES if "," in name]
    for true in ARMS.values():
        true().in_ulna()


def test_real_sets_that_are_not_there_are_skipped(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    real.main(["--data", str(tmp_path)])
    rows = capsys.readouterr().out.splitlines()[2:]
    assert len(rows) == 5
    assert all("skipped" in row for row in rows)
