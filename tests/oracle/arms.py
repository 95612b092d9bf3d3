"""Arms of every kind: measuring arms, an industrial robot with parallel axes, the smallest, a long one."""

import numpy as np

from .chain import Chain, chain
from .published import PI2, six_axes, table_2, table_4


def parallel_axes() -> Chain:
    """A UR10-like arm: axes 2, 3 and 4 parallel, so two Hayati joints; two encoders count backwards."""
    links = [
        [0.02, PI2, 0.0, 128.0],
        [-0.01, 0.003, -612.7, -0.002],
        [0.03, -0.002, -571.6, 0.004],
        [0.0, PI2, 0.0, 163.9],
        [-0.04, -PI2, 0.0, 115.7],
    ]
    return chain(links, [12.0, -7.0, 201.0], (False, True, True, False, False), (1, -1, 1, 1, -1, 1))


def elbow() -> Chain:
    """Two joints: the smallest arm that the model allows."""
    return chain([[0.3, 1.2, 200.0, 50.0]], [150.0, 20.0, 30.0], sign=(1, -1))


def snake(joints: int = 9, seed: int = 5) -> Chain:
    """A long arm of mixed joints and signs with two probes."""
    rng = np.random.default_rng(seed)
    hayati = tuple(bool(i % 3 == 1) for i in range(joints - 1))
    links = rng.uniform(-1, 1, (joints - 1, 4)) * [3.0, 1.5, 300.0, 200.0]
    links[:, 3] = np.where(hayati, links[:, 3] / 2000.0, links[:, 3])
    sign = tuple(int(s) for s in rng.choice([-1, 1], joints))
    return chain(links, rng.uniform(-100, 250, (2, 3)), hayati, sign)


ALL = {
    "seven axes": table_2,
    "seven axes, as calibrated": table_4,
    "six axes": six_axes,
    "parallel axes": parallel_axes,
    "two joints": elbow,
    "nine joints": snake,
}
