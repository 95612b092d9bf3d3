"""A probe's tip in both views, Cartesian and cylindrical, with the uncertainty of each."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.ground.arrays import F64


@dataclass(frozen=True)
class ProbeView:
    """One probe: ``x = r cos theta0, y = -r sin theta0, z = h`` (Cheng 2011). u: standard uncertainties.

    None stands for what is not known: an uncertainty of a tip that was held or not determined, and at r = 0 theta0,
    its uncertainty and that of r, where the cylindrical view is singular.
    """

    name: str
    status: str
    """"fitted", "held", "not-determined", or "mixed" where x, y and z differ."""
    x_mm: float
    y_mm: float
    z_mm: float
    u_x_mm: float | None
    u_y_mm: float | None
    u_z_mm: float | None
    theta0_rad: float | None
    r_mm: float
    h_mm: float
    u_theta0_rad: float | None
    u_r_mm: float | None
    u_h_mm: float | None

    @property
    def on_axis(self) -> bool:
        """r = 0: theta0 is undefined."""
        return self.theta0_rad is None

    def as_dict(self) -> dict[str, Any]:
        """As in `result.json`, key `probes`."""
        entry = asdict(self)
        del entry["name"]
        return entry


def probe_views(arm: Arm, status: Mapping[str, str], covariance: ParameterCovariance) -> list[ProbeView]:
    """Of every probe; `status` by parameter name. The cylindrical uncertainties follow by GUM's law, J C Jᵀ."""
    views = []
    for name, probe in arm.probes.items():
        names = [f"probe.{name}.{axis}" for axis in "xyz"]
        states = [status[each] for each in names]
        c = _tip_covariance(names, covariance)
        u_xyz = [_root(float(c[k, k])) if states[k] == "fitted" else None for k in range(3)]
        theta0_rad, r_mm, h_mm = probe.cylindrical
        u_theta0 = u_r = None
        across_known = "not-determined" not in states[:2] and "fitted" in states[:2]
        if r_mm > 0.0 and across_known:
            along_r = np.array([probe.x_mm / r_mm, probe.y_mm / r_mm, 0.0])
            along_theta0 = np.array([probe.y_mm, -probe.x_mm, 0.0]) / r_mm**2
            u_r = _root(float(along_r @ c @ along_r))
            u_theta0 = _root(float(along_theta0 @ c @ along_theta0))
        views.append(
            ProbeView(
                name=name,
                status=states[0] if len(set(states)) == 1 else "mixed",
                x_mm=probe.x_mm,
                y_mm=probe.y_mm,
                z_mm=probe.z_mm,
                u_x_mm=u_xyz[0],
                u_y_mm=u_xyz[1],
                u_z_mm=u_xyz[2],
                theta0_rad=theta0_rad if r_mm > 0.0 else None,
                r_mm=r_mm,
                h_mm=h_mm,
                u_theta0_rad=u_theta0,
                u_r_mm=u_r,
                u_h_mm=u_xyz[2],
            )
        )
    return views


def _tip_covariance(names: list[str], covariance: ParameterCovariance) -> F64:
    """(3, 3) of x, y, z; held coordinates have none."""
    c = np.zeros((3, 3))
    known = [k for k, name in enumerate(names) if name in covariance.names]
    columns = [covariance.names.index(names[k]) for k in known]
    c[np.ix_(known, known)] = covariance.matrix[np.ix_(columns, columns)]
    return c


def _root(variance: float) -> float | None:
    return math.sqrt(max(variance, 0.0)) if math.isfinite(variance) else None
