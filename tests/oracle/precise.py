"""Ranks in sixty digits: the chain, residuals of surfaces and distances, and a rank that no rounding blurs.

Numbers are `mpmath` ones in NumPy arrays of objects. Derivatives are central differences with a step of 1e-20, right to
some 35 digits; the rank is that of Gram–Schmidt with pivoting, and what is left of a dependent column is below 1e-25 of
what it was.
"""

from collections.abc import Callable

import mpmath as mp
import numpy as np
from numpy.typing import NDArray

from .chain import Chain

DIGITS = 60
STEP = "1e-20"
DEPENDENT = "1e-12"
"""Of a column of length one. Dependent ones come to 1e-17 or less, where touches lie on their surface to 1e-25; the
weakest that is none lies above 1e-6."""

Objects = NDArray[np.object_]

_number = np.frompyfunc(mp.mpf, 1, 1)
_sin, _cos, _root = (np.frompyfunc(function, 1, 1) for function in (mp.sin, mp.cos, mp.sqrt))


def numbers(values: object) -> Objects:
    """As sixty digits have them."""
    return np.asarray(_number(np.asarray(values)), dtype=object)


def length(vectors: Objects) -> Objects:
    """(N, 3) → (N,)"""
    return np.asarray(_root((vectors**2).sum(axis=1)), dtype=object)


def tips(arm: Chain, parameters: Objects, q_rad: Objects) -> Objects:
    """(N, 3) mm; from the tip inwards, one joint after the other. Joints are those of Denavit and Hartenberg."""
    assert not any(arm.hayati)
    links = parameters[: 4 * (arm.joints - 1)].reshape(-1, 4)
    x, y, z = (np.full(len(q_rad), value, dtype=object) for value in parameters[4 * (arm.joints - 1) :][:3])
    for i in reversed(range(arm.joints)):
        theta = q_rad[:, i] * arm.sign[i]
        if i < len(links):
            theta0, alpha, a, d = links[i]
            # arrays first: a number times an array is tried, in vain and at length, as a number
            y, z = y * mp.cos(alpha) - z * mp.sin(alpha), y * mp.sin(alpha) + z * mp.cos(alpha)
            x, z, theta = x + a, z + d, theta - theta0
        cos, sin = _cos(theta), _sin(theta)
        x, y = cos * x - sin * y, sin * x + cos * y
    return np.column_stack([x, y, z])


def on_surface(arm: Chain, q_rad: NDArray, off: Callable[[Objects], Objects]) -> Objects:
    """(N, n) poses near those given whose tips have no residual: one joint turned until there is none (secant)."""
    exact, parameters = numbers(q_rad), numbers(arm.parameters)
    # the joint that moves each tip off its surface most
    slopes = []
    here = off(tips(arm, parameters, exact))
    for joint in range(arm.joints):
        turned = exact.copy()
        turned[:, joint] += mp.mpf("1e-8")
        slopes.append((off(tips(arm, parameters, turned)) - here) / mp.mpf("1e-8"))
    each = np.array(slopes)
    joint = np.abs(each.astype(float)).argmax(axis=0)
    rows = np.arange(len(exact))
    slope = each[joint, rows]
    for _ in range(6):
        step = -here / slope
        exact[rows, joint] += step
        there = off(tips(arm, parameters, exact))
        moved = np.array([abs(value) > mp.mpf("1e-45") for value in step])
        slope[moved] = ((there - here) / np.where(moved, step, mp.mpf(1)))[moved]
        here = there
    return exact


def derivatives(residuals: Callable[[Objects], Objects], at: Objects) -> Objects:
    """(M, K) of residuals (M,) with respect to unknowns (K,)."""
    step, columns = mp.mpf(STEP), []
    for k in range(len(at)):
        up, down = at.copy(), at.copy()
        up[k], down[k] = at[k] + step, at[k] - step
        columns.append((residuals(up) - residuals(down)) / (2 * step))
    return np.column_stack(columns)


def rank(columns: Objects) -> int:
    """How many of the columns are independent."""
    with mp.workdps(DIGITS):
        norms = length(columns.T)
        left = columns[:, [norm > 0 for norm in norms]] / norms[[norm > 0 for norm in norms]]
        found = 0
        while left.shape[1]:
            sizes = length(left.T)
            pivot = int(np.argmax(sizes.astype(float)))
            if sizes[pivot] < mp.mpf(DEPENDENT):
                break
            unit = left[:, pivot] / sizes[pivot]
            left = np.delete(left, pivot, axis=1)
            left = left - np.outer(unit, unit @ left)
            found += 1
        return found
