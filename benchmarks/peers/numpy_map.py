"""The forward map and its Jacobian in vectorised NumPy, components first: what a careful user of NumPy would write."""

import numpy as np

from benchmarks.lengths import F64, FREE, Lengths


def tips(x: F64, q_rad: F64) -> F64:
    """(27,) parameters, (N, 7) rad → (N, 3) tips, mm. Works from the probe inwards, so only vectors are turned."""
    px, py, pz = x[24], x[25], x[26]
    cos, sin = np.cos(q_rad[:, 6]), np.sin(q_rad[:, 6])
    px, py = cos * px - sin * py, sin * px + cos * py
    for i in range(5, -1, -1):
        theta0, alpha, a, d = x[4 * i : 4 * i + 4]
        ca, sa = np.cos(alpha), np.sin(alpha)
        px, py, pz = px + a, ca * py - sa * pz, sa * py + ca * pz + d
        cos, sin = np.cos(q_rad[:, i] - theta0), np.sin(q_rad[:, i] - theta0)
        px, py = cos * px - sin * py, sin * px + cos * py
    return np.stack([px, py, pz], axis=1)


def _cross(u: F64, v: F64) -> F64:
    """(3, N), (3, N) → (3, N); several times faster than np.cross."""
    return np.stack([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])


def _dot(u: F64, v: F64) -> F64:
    return np.asarray(u[0] * v[0] + u[1] * v[1] + u[2] * v[2], np.float64)


def residuals(x: F64, data: Lengths) -> F64:
    """(N,) distance minus length, mm."""
    difference = tips(x, data.q_rad) - tips(x, data.p_rad)
    return np.asarray(np.sqrt(np.einsum("nc,nc->n", difference, difference)) - data.length_mm, np.float64)


def residuals_and_jacobian(x: F64, data: Lengths) -> tuple[F64, F64]:
    """(N,) residuals, mm, and their (N, 25) derivatives by the free parameters."""
    rows = len(data.length_mm)
    q_rad = np.concatenate([data.q_rad, data.p_rad]).T
    count = 2 * rows
    zero, one = np.zeros(count), np.ones(count)
    x_axis, y_axis, z_axis = np.stack([one, zero, zero]), np.stack([zero, one, zero]), np.stack([zero, zero, one])
    origin = np.zeros((3, count))
    axes, along, starts, ends = [], [], [], []
    for i in range(6):
        theta0, alpha, a, d = x[4 * i : 4 * i + 4]
        cos, sin = np.cos(q_rad[i] - theta0), np.sin(q_rad[i] - theta0)
        x_axis, y_axis = cos * x_axis + sin * y_axis, cos * y_axis - sin * x_axis
        axes.append(z_axis)
        along.append(x_axis)
        starts.append(origin)
        origin = origin + d * z_axis + a * x_axis
        ends.append(origin)
        ca, sa = np.cos(alpha), np.sin(alpha)
        y_axis, z_axis = ca * y_axis + sa * z_axis, ca * z_axis - sa * y_axis
    cos, sin = np.cos(q_rad[6]), np.sin(q_rad[6])
    x_axis, y_axis = cos * x_axis + sin * y_axis, cos * y_axis - sin * x_axis
    tip = origin + x[24] * x_axis + x[25] * y_axis + x[26] * z_axis

    difference = tip[:, :rows] - tip[:, rows:]
    distance = np.sqrt(_dot(difference, difference))
    toward = np.tile(difference / distance, 2)
    toward[:, rows:] *= -1.0  # the distance grows when the second tip moves the other way
    gradient = np.empty((27, count))
    for i in range(6):
        gradient[4 * i] = -_dot(toward, _cross(axes[i], tip - starts[i]))
        gradient[4 * i + 1] = _dot(toward, _cross(along[i], tip - ends[i]))
        gradient[4 * i + 2] = _dot(toward, along[i])
        gradient[4 * i + 3] = _dot(toward, axes[i])
    for k, axis in enumerate((x_axis, y_axis, z_axis)):
        gradient[24 + k] = _dot(toward, axis)
    return distance - data.length_mm, (gradient[:, :rows] + gradient[:, rows:])[FREE].T
