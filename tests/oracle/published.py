"""Arms of the literature and of the catalogues, as chains. Angles rad, lengths mm."""

import numpy as np

from .chain import Chain, chain, cylindrical_tip

PI2 = np.pi / 2

#: Cheng, Yu, Fei 2011, Table 2: the assumed truth; r = 0 or 10 mm.
TABLE_2 = [
    [0.0, -PI2, 40.0, 250.0],
    [2.2689, PI2, -40.0, 0.0],
    [0.0, -PI2, 30.0, 450.0],
    [2.2689, PI2, -30.0, 0.0],
    [0.0, -PI2, 30.0, 450.0],
    [2.2689, PI2, -30.0, 0.0],
]

#: Table 3: where the fit starts.
TABLE_3 = [
    [0.1, -1.57, 35.0, 260.0],
    [2.2, 1.57, -35.0, 0.0],
    [0.1, -1.57, 35.0, 400.0],
    [2.2, 1.57, -35.0, 0.0],
    [0.1, -1.57, 35.0, 400.0],
    [2.2, 1.57, -35.0, 0.0],
]

#: Table 4: a real arm with its bent probe.
TABLE_4 = [
    [1.521927, -1.572781, 42.4754, 149.7000],
    [0.791659, 1.567756, -42.0588, -0.9472],
    [0.022211, -1.570242, 28.5382, 439.5104],
    [0.879434, 1.568061, -28.5351, -0.8421],
    [0.032396, -1.574439, 28.5535, 439.4015],
    [0.860088, 1.572594, -28.5478, -0.9604],
]
BENT_4 = (0.431148, 39.4321, 223.8773)
STRAIGHT_4 = (-1.8676, 0.0965, 238.5596)


def table_2(r_mm: float = 10.0, h_mm: float = 200.0) -> Chain:
    return chain(TABLE_2, cylindrical_tip(0.0, r_mm, h_mm))


def table_3(r_mm: float = 10.0, h_mm: float = 180.0) -> Chain:
    """The paper gives no r to start from; that of the truth is the plain choice, 0.1 its angle."""
    return chain(TABLE_3, cylindrical_tip(0.1, r_mm, h_mm))


def table_4(straight: bool = False) -> Chain:
    return chain(TABLE_4, cylindrical_tip(*(STRAIGHT_4 if straight else BENT_4)))


def six_axes(x_mm: float = 30.0) -> Chain:
    """A six-axis arm (2-2-2): Table 2 without its fifth pair, tip ``x_mm`` off the last axis."""
    return chain([*TABLE_2[:3], [2.2689, PI2, -30.0, 0.0], [0.0, -PI2, 25.0, 450.0]], [x_mm, 0.0, 200.0])
