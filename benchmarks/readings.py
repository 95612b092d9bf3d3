"""The readings and the arm that every contender is timed on: cheng2011, Tables 2 and 3, seven axes."""

import numpy as np

from benchmarks.lengths import F64, HELD, Lengths

#: cheng2011, Table 2 (truth) and Table 3 (start): theta0 rad, alpha rad, a mm, d mm of joints 1 to 6
TRUTH_LINKS = [
    (0.0, -np.pi / 2, 40.0, 250.0),
    (2.2689, np.pi / 2, -40.0, 0.0),
    (0.0, -np.pi / 2, 30.0, 450.0),
    (2.2689, np.pi / 2, -30.0, 0.0),
    (0.0, -np.pi / 2, 30.0, 450.0),
    (2.2689, np.pi / 2, -30.0, 0.0),
]
START_LINKS = [
    (0.1, -1.57, 35.0, 260.0),
    (2.2, 1.57, -35.0, 0.0),
    (0.1, -1.57, 35.0, 400.0),
    (2.2, 1.57, -35.0, 0.0),
    (0.1, -1.57, 35.0, 400.0),
    (2.2, 1.57, -35.0, 0.0),
]
#: r = 10 mm off the last axis, h = 200 mm; the start has the 0.1 rad and 180 mm of Table 3, and 8 mm for r
TRUTH_TIP_MM = (10.0, 0.0, 200.0)
START_TIP_MM = (8.0 * np.cos(0.1), -8.0 * np.sin(0.1), 180.0)


#: standard deviations of the noise where a task draws noise
ENCODER_NOISE_RAD = 5e-6
#: a fit counts as found when every fitted parameter is this close to the truth (rad or mm)
FOUND = 1e-6


def parameters(links: list[tuple[float, float, float, float]], tip_mm: tuple[float, float, float]) -> F64:
    """Six links and a tip → the 27 parameters in the order of `ulna.Arm.parameter_names`."""
    return np.concatenate([np.asarray(links, np.float64).ravel(), np.asarray(tip_mm, np.float64)])


TRUTH = parameters(TRUTH_LINKS, TRUTH_TIP_MM)
START = parameters(START_LINKS, START_TIP_MM)
#: the start with the held two at their true values, as an assigned base frame has them
START[HELD] = TRUTH[HELD]


def poses(count: int, seed: int) -> F64:
    """(count, 7) encoder angles, rad, uniform in ±π."""
    return np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, 7))


def lengths(count: int, seed: int = 1) -> Lengths:
    """Noise-free lengths between random poses of the true arm."""
    from benchmarks.peers.numpy_map import tips

    q_rad, p_rad = poses(count, seed), poses(count, seed + 1)
    return Lengths(q_rad, p_rad, np.linalg.norm(tips(TRUTH, q_rad) - tips(TRUTH, p_rad), axis=1))


def noisy(exact: Lengths, seed: int) -> Lengths:
    """The same lengths with fresh encoder noise on both poses."""
    rng = np.random.default_rng(seed)
    shape = exact.q_rad.shape
    return Lengths(
        exact.q_rad + rng.normal(0.0, ENCODER_NOISE_RAD, shape),
        exact.p_rad + rng.normal(0.0, ENCODER_NOISE_RAD, shape),
        exact.length_mm,
    )
