"""The metrologist's figures against hand calculation, SciPy's rigid fit, and what must not change them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import Readings
from ulna.artefacts.seats import MOST_PAIRED_SEATS
from ulna.calibration.figures import figures, over_groups
from ulna.study.study import Study

# An "arm" whose tip is simply its first three readings, in mm: the figures see tips only.
GANTRY: Any = SimpleNamespace(
    core=SimpleNamespace(tip=lambda q, probe: q[:, :3].copy()),
    needs={},
    conditions=lambda count, **said: {},
    probes={"tip": SimpleNamespace(ball_mm=None)},
)


def readings(
    artefact: Artefact, tips: Any, feature: Any = None, placement: Any = None, second: Any = None, length: Any = None
) -> Readings:
    tips = np.asarray(tips, dtype=float)
    rows = len(tips)
    return Readings(
        artefact=artefact,
        q_rad=tips,
        p_rad=None if second is None else np.asarray(second, dtype=float),
        length_mm=None if length is None else np.asarray(length, dtype=float),
        probe=np.zeros(rows, dtype=np.int64),
        feature=np.zeros(rows, dtype=np.int64) if feature is None else np.asarray(feature, dtype=np.int64),
        placement=np.array(["1"] * rows if placement is None else placement, dtype=object),
        row=np.arange(1, rows + 1),
        file=np.zeros(rows, dtype=np.int64),
    )


def study(*groups: Readings) -> Study:
    return Study(path=None, arm=GANTRY, readings=list(groups))


SEAT = Artefact("cone", "seat", {"seat": (0.0, 0.0, 0.0)})
BAR = Artefact("bar", "bar", {"A": (0.0, 0.0, 0.0), "B": (100.0, 0.0, 0.0)}, length_mm=100.0)
LENGTH = Artefact("rows", "length", {})


def test_seat_scatter_is_the_distance_to_the_seats_own_mean() -> None:
    tips = [[0, 0, 1], [0, 0, -1], [2, 0, 0], [-2, 0, 0]]
    (entry,), overall = figures(GANTRY, study(readings(SEAT, tips)))
    expected = {
        "seat_scatter_mean_mm": 1.5,
        "seat_scatter_rms_mm": np.sqrt(2.5),
        "seat_scatter_max_mm": 2.0,
    }
    assert entry.figures == pytest.approx(expected)
    assert overall == pytest.approx(expected)
    assert entry.readings == 4


def test_a_seat_touched_once_has_no_scatter_and_no_zero_in_its_place() -> None:
    (entry,), overall = figures(GANTRY, study(readings(SEAT, [[1, 2, 3]])))
    assert entry.figures == {}
    assert overall == {}


def test_length_error_is_between_the_means_of_the_seats_and_signed() -> None:
    tips = [[0, 0, 0.1], [0, 0, -0.1], [99.7, 0, 0], [5, 0, 0], [5, 101, 0]]
    group = readings(BAR, tips, feature=[0, 0, 1, 0, 1], placement=["p", "p", "p", "r", "r"])
    (p, r), overall = figures(GANTRY, study(group))
    assert p.figures["length_error_mean_mm"] == pytest.approx(-0.3)
    assert p.figures["length_error_max_abs_mm"] == pytest.approx(0.3)
    assert r.figures["length_error_mean_mm"] == pytest.approx(1.0)
    assert overall["length_error_mean_abs_mm"] == pytest.approx(0.65)
    assert overall["length_error_mean_mm"] == pytest.approx(0.35)
    assert overall["length_error_rms_mm"] == pytest.approx(np.sqrt((0.09 + 1.0) / 2))
    assert p.figures["seat_scatter_max_mm"] == pytest.approx(0.1)
    assert "seat_scatter_max_mm" not in r.figures


def test_length_rows() -> None:
    group = readings(LENGTH, [[0, 0, 0], [0, 0, 0]], second=[[3, 4, 0], [0, 0, 7]], length=[4.5, 7.25])
    (entry,), _ = figures(GANTRY, study(group))
    assert entry.figures["length_error_mean_mm"] == pytest.approx(0.125)
    assert entry.figures["length_error_mean_abs_mm"] == pytest.approx(0.375)


def plate(rng: np.random.Generator, count: int, frame: str = "free") -> Artefact:
    features = {f"s{k}": tuple(point) for k, point in enumerate(rng.uniform(-200, 200, (count, 3)))}
    return Artefact("plate", "points", features, frame=frame)  # type: ignore[arg-type]


def test_coordinate_error_after_the_best_rigid_fit_agrees_with_scipy() -> None:
    rng = np.random.default_rng(3)
    artefact = plate(rng, 9)
    reference = np.array(list(artefact.features.values()))
    tips, feature, placement, expected = [], [], [], []
    for label in "abc":
        index = rng.integers(0, 9, 20)
        moved = Rotation.random(random_state=rng).apply(reference[index]) + rng.uniform(-500, 500, 3)
        touched = moved + rng.normal(0, 0.5, moved.shape)
        tips += touched.tolist()
        feature += index.tolist()
        placement += [label] * 20
        centred, wanted = reference[index] - reference[index].mean(0), touched - touched.mean(0)
        rotation, _ = Rotation.align_vectors(wanted, centred)
        expected.append(np.linalg.norm(wanted - rotation.apply(centred), axis=1))
    entries, overall = figures(GANTRY, study(readings(artefact, tips, feature, placement)))
    for entry, error in zip(entries, expected, strict=True):
        assert entry.figures["coordinate_error_mean_mm"] == pytest.approx(error.mean(), rel=1e-9)
        assert entry.figures["coordinate_error_max_mm"] == pytest.approx(error.max(), rel=1e-9)
    assert overall["coordinate_error_rms_mm"] == pytest.approx(np.sqrt(np.mean(np.square(expected))), rel=1e-9)


def test_a_mirrored_plate_does_not_fit() -> None:
    rng = np.random.default_rng(4)
    artefact = plate(rng, 12)
    tips = np.array(list(artefact.features.values())) * [1, 1, -1]
    (entry,), _ = figures(GANTRY, study(readings(artefact, tips, np.arange(12))))
    assert entry.figures["coordinate_error_rms_mm"] > 10.0
    assert entry.figures["length_error_max_abs_mm"] < 1e-9  # lengths cannot tell a mirror image


def test_features_in_a_line_fit_exactly() -> None:
    artefact = Artefact("ball bar", "points", {f"s{k}": (100.0 * k, 0.0, 0.0) for k in range(5)})
    tips = [[7.0, 3.0 - 100.0 * k, 1.0] for k in range(5)]
    (entry,), _ = figures(GANTRY, study(readings(artefact, tips, np.arange(5))))
    assert entry.figures["coordinate_error_max_mm"] < 1e-9


def test_pairs_of_points_give_lengths() -> None:
    rng = np.random.default_rng(5)
    artefact = plate(rng, 6)
    reference = np.array(list(artefact.features.values()))
    tips = reference * 1.001  # one part in a thousand too long
    (entry,), _ = figures(GANTRY, study(readings(artefact, tips, np.arange(6))))
    pairs = np.linalg.norm(reference[:, None] - reference[None], axis=2)[np.triu_indices(6, 1)]
    assert entry.figures["length_error_mean_mm"] == pytest.approx(0.001 * pairs.mean())
    assert entry.figures["length_error_max_abs_mm"] == pytest.approx(0.001 * pairs.max())


def test_too_many_seats_give_no_lengths() -> None:
    artefact = plate(np.random.default_rng(6), MOST_PAIRED_SEATS + 1)
    tips = np.array(list(artefact.features.values()))
    (entry,), _ = figures(GANTRY, study(readings(artefact, tips, np.arange(len(tips)))))
    assert "length_error_mean_mm" not in entry.figures
    assert entry.figures["coordinate_error_max_mm"] < 1e-9


def test_coordinates_in_the_arms_frame_are_compared_without_a_fit() -> None:
    artefact = plate(np.random.default_rng(7), 8, frame="arm")
    tips = np.array(list(artefact.features.values())) + np.array([0.0, 0.3, 0.4])
    (entry,), _ = figures(GANTRY, study(readings(artefact, tips, np.arange(8))))
    assert entry.figures["coordinate_error_mean_mm"] == pytest.approx(0.5)


@pytest.mark.parametrize("seed", range(5))
def test_no_rigid_motion_of_all_tips_changes_a_figure(seed: int) -> None:
    rng = np.random.default_rng(seed)
    artefact = plate(rng, 7)
    feature = rng.integers(0, 7, 60)
    placement = rng.choice(["p", "r", "s"], 60)
    tips = np.array(list(artefact.features.values()))[feature] + rng.normal(0, 1, (60, 3))
    moved = Rotation.random(random_state=rng).apply(tips) + np.array([300, -200, 100])
    _, still = figures(GANTRY, study(readings(artefact, tips, feature, placement)))
    _, after = figures(GANTRY, study(readings(artefact, moved, feature, placement)))
    assert after == pytest.approx(still, rel=1e-9)


def test_order_of_rows_changes_no_figure() -> None:
    rng = np.random.default_rng(8)
    feature = rng.integers(0, 2, 40)
    placement = rng.choice(["p", "r"], 40)
    tips = rng.normal(0, 30, (40, 3))
    order = rng.permutation(40)
    plain, overall = figures(GANTRY, study(readings(BAR, tips, feature, placement)))
    mixed, mixed_overall = figures(GANTRY, study(readings(BAR, tips[order], feature[order], placement[order])))
    assert mixed_overall == pytest.approx(overall)
    found = {entry.placement: entry.figures for entry in mixed}
    for entry in plain:
        assert found[entry.placement] == pytest.approx(entry.figures)


def test_over_groups_every_group_weighs_the_same() -> None:
    groups = [
        {"seat_scatter_mean_mm": 1.0, "seat_scatter_rms_mm": 3.0, "seat_scatter_max_mm": 5.0},
        {"seat_scatter_mean_mm": 2.0, "seat_scatter_rms_mm": 4.0, "seat_scatter_max_mm": 4.0},
        {"length_error_mean_abs_mm": 7.0},
    ]
    assert over_groups(groups) == pytest.approx(
        {
            "seat_scatter_mean_mm": 1.5,
            "seat_scatter_rms_mm": np.sqrt(12.5),
            "seat_scatter_max_mm": 5.0,
            "length_error_mean_abs_mm": 7.0,
        }
    )
