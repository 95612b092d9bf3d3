"""Touches of surfaces: distances from a ball or a flat whose place is an explicit unknown."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from .chain import Array, Chain
from .observed import Index

#: longest that a free direction is turned: the two parameters of a plane's normal stay well behaved
_STEP = 1e-30


class _Touched:
    """Touches whose distances from a surface are the residuals."""

    q_rad: Array
    probe: int | Index

    def _off(self, tips: NDArray, unknowns: NDArray) -> NDArray:
        """(N,) tips' distances from where the surface lets them be."""
        raise NotImplementedError

    def unknowns(self, start: Chain) -> Array:
        """Where the surfaces seem to be by the start arm."""
        raise NotImplementedError

    def normals(self, arm: Chain, unknowns: Array) -> Array:
        """(N, 3) unit vectors away from the surface."""
        raise NotImplementedError

    def residuals(self, arm: Chain, unknowns: NDArray) -> NDArray:
        return self._off(arm.tip(self.q_rad, self.probe), unknowns)

    def jacobian(self, arm: Chain, unknowns: Array) -> tuple[Array, Array]:
        of_arm = np.einsum("ni,nik->nk", self.normals(arm, unknowns), arm.jacobian(self.q_rad, self.probe))
        tips = arm.tip(self.q_rad, self.probe)
        columns = np.zeros((len(tips), len(unknowns)))
        for k in range(len(unknowns)):
            moved = unknowns.astype(complex)
            moved[k] += 1j * _STEP
            columns[:, k] = self._off(tips, moved).imag / _STEP
        return of_arm, columns

    def covariance(self, arm: Chain, encoder_rad: Array, seat_mm: float) -> Array:
        """(N, 1, 1) of a distance, mm²: what of a touch's error is across the surface."""
        normals = self.normals(arm, self.unknowns(arm))
        j = np.einsum("ni,nik->nk", normals, arm.encoder_jacobian(self.q_rad, self.probe))
        return ((j**2 * encoder_rad**2).sum(axis=1) + seat_mm**2)[:, None, None]


class _Round:
    """Touched with balls (P,), mm, from outside or from inside."""

    diameter_mm: float
    balls_mm: Array
    q_rad: Array
    probe: int | Index
    inside: bool

    @property
    def radius_mm(self) -> Array:
        """(N,) of what the tip moves on."""
        ball = np.asarray(self.balls_mm)[np.broadcast_to(self.probe, (len(self.q_rad),))]
        return 0.5 * (self.diameter_mm - ball if self.inside else self.diameter_mm + ball)


class _AboutPoints(_Touched):
    """Tips at known distances (N,) ``radius_mm`` from points; unknown: the points."""

    placement: Index
    radius_mm: Array

    def unknowns(self, start: Chain) -> Array:
        tips = start.tip(self.q_rad, self.probe)
        rows = []
        for number in range(self.placement.max() + 1):
            here = self.placement == number
            seen, radius = tips[here], self.radius_mm[here]
            # ‖p‖² - r² = 2 p·c - ‖c‖²
            left = np.column_stack([2 * seen, -np.ones(len(seen))])
            rough = np.linalg.lstsq(left, (seen**2).sum(axis=1) - radius**2, rcond=None)[0][:3]
            rows.append(least_squares(lambda c, p=seen, r=radius: np.linalg.norm(p - c, axis=1) - r, rough).x)
        return np.concatenate(rows)

    def _off(self, tips: NDArray, unknowns: NDArray) -> NDArray:
        apart = tips - unknowns.reshape(-1, 3)[self.placement]
        return np.sqrt((apart**2).sum(axis=1)) - self.radius_mm

    def normals(self, arm: Chain, unknowns: Array) -> Array:
        apart = arm.tip(self.q_rad, self.probe) - unknowns.reshape(-1, 3)[self.placement]
        return apart / np.linalg.norm(apart, axis=1, keepdims=True)


@dataclass(frozen=True)
class Sphere(_Round, _AboutPoints):
    """Touches of a ball of (or hollow with) a diameter, mm, with the probes' balls (P,), mm; unknown: the centre."""

    diameter_mm: float
    balls_mm: Array
    q_rad: Array
    placement: Index
    probe: int | Index = 0
    inside: bool = False


@dataclass(frozen=True)
class Distances(_AboutPoints):
    """(N,) distances of the tip from fixed points, as an instrument reads them; unknown: the points."""

    measured_mm: Array
    q_rad: Array
    placement: Index
    probe: int | Index = 0

    @property
    def radius_mm(self) -> Array:
        return self.measured_mm


@dataclass(frozen=True)
class Plane(_Touched):
    """Touches of a flat; unknown: its normal, as the two small turns from where it seemed to be, and its distance."""

    balls_mm: Array
    q_rad: Array
    placement: Index
    normal: Array  # (placements, 3): roughly, towards the arm
    probe: int | Index = 0

    @property
    def radius_mm(self) -> Array:
        return 0.5 * np.asarray(self.balls_mm)[np.broadcast_to(self.probe, (len(self.q_rad),))]

    def unknowns(self, start: Chain) -> Array:
        tips = start.tip(self.q_rad, self.probe)
        rows = []
        for number in range(self.placement.max() + 1):
            here = self.placement == number
            at = float(np.mean(tips[here] @ self.normal[number] - self.radius_mm[here]))
            one = Plane(self.balls_mm, self.q_rad[here], np.zeros(here.sum(), int), self.normal[number : number + 1])
            radius = self.radius_mm[here]
            rows.append(
                least_squares(
                    lambda x, plane=one, p=tips[here], r=radius: plane._off(p, x, r),
                    np.array([0.0, 0.0, at]),
                    x_scale=[1e-3, 1e-3, 1.0],
                    xtol=1e-15,
                    ftol=1e-15,
                    gtol=1e-15,
                ).x
            )
        return np.concatenate(rows)

    def _stands(self, unknowns: NDArray) -> tuple[NDArray, NDArray]:
        """(placements, 3) unit normals and (placements,) distances."""
        two = unknowns.reshape(-1, 3)
        across = np.stack([np.linalg.svd(normal[None])[2][1:] for normal in self.normal])
        turned = self.normal + np.einsum("pk,pkj->pj", two[:, :2], across)
        return turned / np.sqrt((turned**2).sum(axis=1, keepdims=True)), two[:, 2]

    def _off(self, tips: NDArray, unknowns: NDArray, radius_mm: Array | None = None) -> NDArray:
        normals, at = self._stands(unknowns)
        radius_mm = self.radius_mm if radius_mm is None else radius_mm
        return (tips * normals[self.placement]).sum(axis=1) - at[self.placement] - radius_mm

    def normals(self, arm: Chain, unknowns: Array) -> Array:
        return self._stands(unknowns)[0][self.placement]


@dataclass(frozen=True)
class Cylinder(_Round, _Touched):
    """Touches of a shaft of (or bore with) a diameter, mm; unknown: two tilts and two shifts of the axis from where it
    seemed to be."""

    diameter_mm: float
    balls_mm: Array
    q_rad: Array
    placement: Index
    along: Array  # (placements, 3) unit vectors, roughly
    through_mm: Array  # (placements, 3) a point of each axis, roughly
    probe: int | Index = 0
    inside: bool = False

    def unknowns(self, start: Chain) -> Array:
        tips = start.tip(self.q_rad, self.probe)
        rows = []
        for number in range(len(self.along)):
            here = self.placement == number
            one = replace(
                self,
                q_rad=self.q_rad[here],
                placement=np.zeros(here.sum(), int),
                along=self.along[number : number + 1],
                through_mm=self.through_mm[number : number + 1],
                probe=np.broadcast_to(self.probe, (len(self.q_rad),))[here],
            )
            found = least_squares(
                lambda x, cylinder=one, p=tips[here]: cylinder._off(p, x),
                np.zeros(4),
                x_scale=[1e-2, 1e-2, 1.0, 1.0],
                xtol=1e-15,
                ftol=1e-15,
                gtol=1e-15,
            )
            rows.append(found.x)
        return np.concatenate(rows)

    def _away(self, tips: NDArray, unknowns: NDArray) -> NDArray:
        """(N, 3) from the axis to the tip."""
        four = unknowns.reshape(-1, 4)
        across = np.stack([np.linalg.svd(along[None])[2][1:] for along in self.along])
        turned = self.along + np.einsum("pk,pkj->pj", four[:, :2], across)
        turned = turned / np.sqrt((turned**2).sum(axis=1, keepdims=True))
        at = self.through_mm + np.einsum("pk,pkj->pj", four[:, 2:], across)
        arm, along = tips - at[self.placement], turned[self.placement]
        return arm - (arm * along).sum(axis=1, keepdims=True) * along

    def _off(self, tips: NDArray, unknowns: NDArray) -> NDArray:
        return np.sqrt((self._away(tips, unknowns) ** 2).sum(axis=1)) - self.radius_mm

    def normals(self, arm: Chain, unknowns: Array) -> Array:
        away = self._away(arm.tip(self.q_rad, self.probe), unknowns)
        return away / np.linalg.norm(away, axis=1, keepdims=True)


Surface = Sphere | Plane | Cylinder | Distances
