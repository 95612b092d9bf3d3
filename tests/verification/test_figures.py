"""The figures of acceptance tests, each against arithmetic written out here, and the laws that all must obey."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ulna.ground.errors import UlnaInputError
from ulna.verification.figures.asme_b89_4_22 import effective_diameter, single_point, volumetric
from ulna.verification.figures.faro import half_ranges
from ulna.verification.figures.iso_10360_12 import articulation, length_error, probing
from ulna.verification.figures.lengths import length_between

F64 = NDArray[np.float64]


def octahedron(radius: float, stretch: float = 0.0, at: tuple[float, float, float] = (0, 0, 0)) -> F64:
    """±x, ±y at `radius`, ±z at `radius + stretch`: the least-squares sphere has radius + stretch / 3."""
    points = radius * np.concatenate([np.eye(3), -np.eye(3)])
    points[2, 2] += stretch
    points[5, 2] -= stretch
    return np.asarray(points + np.array(at))


def test_p_size_and_p_form_by_hand() -> None:
    """Probe centres at 15.5 mm, and 15.53 along z. Sphere: (4·15.5 + 2·15.53)/6 = 15.51, D = 31.02; tip 6: 25.02.
    Against a ball of 25.005: P_Size = 0.015; P_Form = 15.53 - 15.5 = 0.03."""
    size, form = probing(octahedron(15.5, 0.03, (300, 400, 500)), 25.005, tip_diameter_mm=6.0)
    assert size.value == pytest.approx(0.015, abs=1e-12)
    assert form.value == pytest.approx(0.03, abs=1e-12)
    assert (size.definition.name, form.definition.name) == (
        "P_Size.Sph.1x25:Tact.AArm",
        "P_Form.Sph.1x25:Tact.AArm",
    )


def test_p_size_of_a_hollow_by_hand() -> None:
    """Probe centres at 9.51 mm within a hollow of 25 mm: D = 19.02 + 6 = 25.02."""
    size, _ = probing(octahedron(9.51), 25.0, tip_diameter_mm=6.0, inside=True)
    assert size.value == pytest.approx(0.02, abs=1e-12)


def test_l_dia_by_hand() -> None:
    """Five centres: (0,0,0), (30,40,0) µm, and three within: the two are a diameter, √(30² + 40²) = 50 µm."""
    centres = np.array([[0, 0, 0], [30, 40, 0], [15, 20, 10], [20, 20, 5], [10, 25, -8]]) * 1e-3
    points = np.stack([octahedron(15.5)[:5] + centre for centre in centres])
    assert articulation(points).value == pytest.approx(0.050, abs=1e-11)


def test_l_dia_of_a_triangle_by_hand() -> None:
    """Centres on a regular triangle of side 60 µm: its circumscribed circle has 2·60/√3 = 69.28 µm."""
    corners = np.array([[0, 0, 0], [60, 0, 0], [30, 30 * sqrt(3), 0], [30, 10, 1], [30, 20, -1]]) * 1e-3
    points = np.stack([octahedron(12.0) + corner for corner in corners])
    assert articulation(points).value == pytest.approx(0.060 * 2 / sqrt(3), abs=1e-11)


def test_lengths_by_hand() -> None:
    """Seats: means (0,0,0) and (300,400,0.0): 500. Faces 100 apart and a tip of 6: from outside 106 - 6 = 100."""
    a = np.array([[0.01, 0, 0], [-0.01, 0, 0]])
    b = np.array([[300, 400.01, 0], [300, 399.99, 0]])
    length = length_between(a, b, "seats")
    assert length == pytest.approx(500.0, abs=1e-12)
    assert length_error(length, 499.98).value == pytest.approx(0.02, abs=1e-12)
    face = np.array([[0, 0, 0], [9, 0, 0], [0, 9, 0], [9, 9, 0.0]])
    other = np.add(face, [1, 2, 106])
    assert length_between(face, other, "opposite-faces", 6.0) == pytest.approx(100.0, abs=1e-12)
    assert length_between(face, other, "faces") == pytest.approx(106.0, abs=1e-12)
    assert length_between(face[:1], np.add(face[:1], [0, 0, 106.0]), "opposite-faces", 6.0) == pytest.approx(100.0)
    assert length_between(octahedron(15), octahedron(15, 0, (0, 600, 800)), "balls") == pytest.approx(1000.0)
    bi = length_error(100.012, 100.0, opposing=True)
    assert bi.value == pytest.approx(0.012, abs=1e-12)
    assert bi.definition.name == "E_Bi:Tact.AArm"


def test_opposite_faces_need_the_tip() -> None:
    with pytest.raises(UlnaInputError, match="diameter of the probe's ball is not known"):
        length_between(np.zeros((1, 3)), np.ones((1, 3)), "opposite-faces")


def test_effective_diameter_by_hand() -> None:
    """D_i - D_cal = +10, -20, +40 µm: mean 10, s = √((0² + 30² + 30²)/2) = 30, the largest 40 µm."""
    points = np.stack([octahedron(15.0 + e / 2000) for e in (10, -20, 40)])
    mean, worst, spread = effective_diameter(points, 24.0, 6.0)
    assert mean.value == pytest.approx(0.010, abs=1e-12)
    assert worst.value == pytest.approx(0.040, abs=1e-12)
    assert spread.value == pytest.approx(0.030, abs=1e-12)


SPAT = np.array([[3, 0, 0], [-3, 0, 0], [0, 4, 0], [0, -4, 0.0]]) * 1e-3


def test_spat_by_hand() -> None:
    """Mean 0; δ = 3, 3, 4, 4 µm: max 4; S = √((9+9+16+16)/3) = 4.0825, 2S = 8.165 µm. FARO: (3, 4, 0) µm."""
    worst, twice = single_point(np.add(SPAT, [100, 200, 300]))
    assert worst.value == pytest.approx(0.004, abs=1e-12)
    assert twice.value == pytest.approx(2 * sqrt(50 / 3) * 1e-3, abs=1e-12)
    assert [float(each.value) for each in half_ranges(np.add(SPAT, [100, 200, 300]))] == pytest.approx(
        [0.003, 0.004, 0.0], abs=1e-12
    )
    names = {each.definition.name for each in (worst, twice, *half_ranges(SPAT))}
    assert len(names) == 5, "names are never mixed"


def test_volumetric_by_hand() -> None:
    """e = 10, -30, 20, 20 µm: largest -30; mean 5, s = √((25 + 1225 + 225 + 225)/3) = 23.805, 2s = 47.61;
    half the range (20 + 30)/2 = 25; RMS √((100 + 900 + 400 + 400)/4) = 21.213, 2·RMS = 42.43 µm."""
    worst, twice, half, rms = volumetric(np.array([10, -30, 20, 20]) * 1e-3)
    assert worst.value == pytest.approx(-0.030)
    assert twice.value == pytest.approx(2 * sqrt(1700 / 3) * 1e-3)
    assert half.value == pytest.approx(0.025)
    assert rms.value == pytest.approx(2 * sqrt(450) * 1e-3)


def test_noise_gives_what_the_specification_says() -> None:
    """Isotropic noise σ and ten touches: 2·S about 3.4 σ, FARO's half range about 1.5 σ an axis."""
    touches = np.random.default_rng(0).standard_normal((20_000, 10, 3))
    assert float(single_point(touches)[1].value.mean()) == pytest.approx(3.43, abs=0.03)
    assert float(half_ranges(touches)[0].value.mean()) == pytest.approx(1.54, abs=0.02)


def every_figure(ball: F64, orientations: F64, seat: F64, bars: F64) -> list[float]:
    """All figures that no frame may change."""
    size, form = probing(ball, 0.0)
    length = length_between(bars[:, 0], bars[:, 1], "seats")
    figures = [size, form, articulation(orientations), *single_point(seat), *effective_diameter(orientations, 0.0)]
    return [float(each.value) for each in figures] + np.asarray(length).tolist()


def touches(seed: int) -> tuple[F64, F64, F64, F64]:
    rng = np.random.default_rng(seed)
    return (
        octahedron(15) + 0.05 * rng.standard_normal((6, 3)),
        octahedron(15) + 0.05 * rng.standard_normal((5, 6, 3)),
        0.05 * rng.standard_normal((10, 3)),
        rng.uniform(-300, 300, (4, 2, 1, 3)),
    )


@settings(max_examples=30, deadline=None)
@given(
    turn=st.tuples(*(st.floats(-3, 3) for _ in range(3))),
    shift=st.tuples(*(st.floats(-1500, 1500) for _ in range(3))),
    scale=st.floats(0.05, 20),
    seed=st.integers(0, 10_000),
)
def test_rigid_motion_changes_nothing_and_scaling_scales(
    turn: tuple[float, ...], shift: tuple[float, ...], scale: float, seed: int
) -> None:
    matrix = Rotation.from_rotvec(turn).as_matrix()
    before = every_figure(*touches(seed))
    after = every_figure(*(scale * each @ matrix.T + shift for each in touches(seed)))
    assert after == pytest.approx([scale * each for each in before], rel=1e-6, abs=1e-8)


@given(seed=st.integers(0, 10_000))
@settings(max_examples=20, deadline=None)
def test_the_order_of_touches_does_not_matter(seed: int) -> None:
    ball, orientations, seat, bars = touches(seed)
    order = np.random.default_rng(seed)
    mixed = (
        order.permutation(ball),
        order.permutation(order.permutation(orientations, axis=1), axis=0),
        order.permutation(seat),
        bars,
    )
    assert every_figure(*mixed) == pytest.approx(every_figure(ball, orientations, seat, bars), rel=1e-7, abs=1e-10)
    e = order.standard_normal(20)
    assert [float(f.value) for f in volumetric(order.permutation(e))] == pytest.approx(
        [float(f.value) for f in volumetric(e)], rel=1e-12
    )


@given(turn=st.floats(0.3, 1.2))
@settings(max_examples=10)
def test_faros_figure_depends_on_the_axes_and_says_so(turn: float) -> None:
    matrix = Rotation.from_rotvec([0, 0, turn]).as_matrix()
    x, _, _ = half_ranges(SPAT @ matrix.T)
    assert abs(float(x.value) - 0.003) > 1e-5
    assert "depends on the directions of the axes" in x.definition.formula
    moved, _, _ = half_ranges(np.add(SPAT, [5, 6, 7]))
    assert moved.value == pytest.approx(0.003, abs=1e-12)


def test_many_tests_at_once_are_as_each_alone() -> None:
    many = np.stack([touches(seed)[1] for seed in range(6)])
    assert articulation(many).value == pytest.approx([float(articulation(each).value) for each in many], abs=1e-12)
    balls = many[:, 0]
    assert probing(balls, 30.0, 0.0)[0].value.shape == (6,)


def test_too_little_is_told() -> None:
    with pytest.raises(UlnaInputError, match="1 touch; expected 2"):
        single_point(np.zeros((1, 3)))
    with pytest.raises(UlnaInputError, match="standard deviation needs 2"):
        volumetric([0.01])
    with pytest.raises(UlnaInputError, match="3 points; expected 4"):
        probing(np.eye(3), 25.0)
