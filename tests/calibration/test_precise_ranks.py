"""What touches of surfaces and distances determine, counted in sixty digits: arm, dimensions and placements as explicit
unknowns, nothing scaled, weighed or eliminated."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import mpmath as mp
import numpy as np
import pytest
from tests.oracle import precise, virtual
from tests.oracle.chain import Chain
from tests.oracle.core import core_arm
from tests.oracle.precise import Objects, length, numbers
from tests.oracle.published import table_2
from tests.oracle.surfaces import Cylinder, Distances, Plane, Sphere, Surface

import ulna._core as _core

#: an unknown of the residual for each dimension, and those of each standing
Residual = Callable[[Objects, Objects, Objects], Objects]


@dataclass(frozen=True)
class Case:
    """Readings, what is unknown of the artefact, and the count that is expected beside the arm's base."""

    make: Callable[[Chain, np.random.Generator], Surface]
    kind: str
    free: tuple[str, ...] = ()
    lost: int = 2
    straight: bool = False


CASES = {
    "ball": Case(lambda arm, rng: virtual.spheres(arm, rng, 4, 14), "sphere"),
    "ball of unknown diameter": Case(lambda arm, rng: virtual.spheres(arm, rng, 4, 14), "sphere", ("diameter",), 3),
    "flat": Case(lambda arm, rng: virtual.planes(arm, rng, 4, 14), "plane", (), 3),
    "shaft": Case(lambda arm, rng: virtual.cylinders(arm, rng, 4, 16), "cylinder"),
    "shaft, straight probe": Case(lambda arm, rng: virtual.cylinders(arm, rng, 4, 16), "cylinder", (), 4, True),
    "bore": Case(lambda arm, rng: virtual.cylinders(arm, rng, 4, 16, inside=True), "cylinder"),
    "shaft of unknown diameter": Case(
        lambda arm, rng: virtual.cylinders(arm, rng, 4, 16), "cylinder", ("diameter",), 3
    ),
    "wire": Case(lambda arm, rng: virtual.distances(arm, rng, 3, 20), "distance"),
    "wire, straight probe": Case(lambda arm, rng: virtual.distances(arm, rng, 3, 20), "distance", (), 4, True),
    "wire of unknown offset": Case(lambda arm, rng: virtual.distances(arm, rng, 3, 20), "distance", ("offset",)),
    "wire of unknown scale": Case(lambda arm, rng: virtual.distances(arm, rng, 3, 20), "distance", ("scale",), 3),
    "wire of which nothing is known": Case(
        lambda arm, rng: virtual.distances(arm, rng, 3, 20), "distance", ("offset", "scale"), 3
    ),
}


def _across(along: np.ndarray) -> Objects:
    return np.stack([numbers(np.linalg.svd(each[None])[2][1:]) for each in along])


def _residual(group: Surface) -> tuple[Residual, dict[str, float], np.ndarray]:
    """The residuals by tips, dimensions and standings; where dimensions and standings are, each standing a row."""
    of = group.placement
    if isinstance(group, Plane):
        normal, across = numbers(group.normal), _across(group.normal)

        def flat(tips: Objects, sizes: Objects, stands: Objects) -> Objects:
            turned = normal + stands[:, :1] * across[:, 0] + stands[:, 1:2] * across[:, 1]
            turned = turned / length(turned)[:, None]
            return (tips * turned[of]).sum(axis=1) - stands[of, 2] - numbers(group.radius_mm)

        arm = table_2(r_mm=40.0)
        return flat, {}, group.unknowns(arm).reshape(-1, 3)
    if isinstance(group, Cylinder):
        along, through, across = numbers(group.along), numbers(group.through_mm), _across(group.along)
        side = -1 if group.inside else 1
        ball = numbers(group.balls_mm[0])

        def shaft(tips: Objects, sizes: Objects, stands: Objects) -> Objects:
            turned = along + stands[:, :1] * across[:, 0] + stands[:, 1:2] * across[:, 1]
            turned = turned / length(turned)[:, None]
            at = through + stands[:, 2:3] * across[:, 0] + stands[:, 3:4] * across[:, 1]
            arm = tips - at[of]
            away = arm - (arm * turned[of]).sum(axis=1)[:, None] * turned[of]
            return length(away) - (sizes[0] + side * ball) / 2

        return shaft, {"diameter": group.diameter_mm}, np.zeros((len(along), 4))
    if isinstance(group, Sphere):
        ball = numbers(group.balls_mm[0])

        def around(tips: Objects, sizes: Objects, stands: Objects) -> Objects:
            return length(tips - stands[of]) - (sizes[0] + ball) / 2

        return around, {"diameter": group.diameter_mm}, group.unknowns(table_2(r_mm=40.0)).reshape(-1, 3)
    read = numbers(group.measured_mm)

    def apart(tips: Objects, sizes: Objects, stands: Objects) -> Objects:
        return length(tips - stands[of]) - sizes[0] - sizes[1] * read

    return apart, {"offset": 0.0, "scale": 1.0}, group.unknowns(table_2(r_mm=40.0)).reshape(-1, 3)


def _counted(arm: Chain, group: Surface, free: tuple[str, ...]) -> int:
    """Independent directions of arm and free dimensions: of all unknowns, less those of the standings."""
    with mp.workdps(precise.DIGITS):
        residual, dimensions, stands = _residual(group)
        sizes, standing = numbers(list(dimensions.values())), numbers(stands)
        exact = precise.on_surface(arm, group.q_rad, lambda tips: residual(tips, sizes, standing))
        open_sizes = [number for number, name in enumerate(dimensions) if name in free]
        parameters = numbers(arm.parameters)
        tips = precise.tips(arm, parameters, exact)

        def by_artefact(x: Objects) -> Objects:
            own = sizes.copy()
            own[open_sizes] = x[: len(open_sizes)]
            return residual(tips, own, x[len(open_sizes) :].reshape(standing.shape))

        of_arm = precise.derivatives(lambda x: residual(precise.tips(arm, x, exact), sizes, standing), parameters)
        of_artefact = precise.derivatives(by_artefact, np.concatenate([sizes[open_sizes], standing.ravel()]))
        both = np.column_stack([of_arm, of_artefact])
        return precise.rank(both) - precise.rank(of_artefact[:, len(open_sizes) :])


@pytest.mark.parametrize("name", CASES)
def test_ranks_are_those_of_sixty_digits(name):
    case = CASES[name]
    arm = table_2(r_mm=0.0 if case.straight else 40.0)
    group = case.make(arm, np.random.default_rng(list(CASES).index(name)))
    if isinstance(group, Sphere | Distances):
        group = replace(group, placement=np.asarray(group.placement))
    problem = _core.Problem(core_arm(arm))
    stated = [(size, value, 0.0, size in case.free) for size, value in _residual(group)[1].items()]
    rows = {"q_rad": group.q_rad, "probe": np.zeros(len(group.q_rad), np.int64), "placement": group.placement}
    if isinstance(group, Distances):
        rows["measured_mm"] = group.measured_mm
    else:
        rows["balls_mm"] = group.balls_mm
    problem.add(case.kind, "thing", dimensions=stated, inside=getattr(group, "inside", False), **rows)
    unknowns = len(problem.parameter_names)
    found = _core.identify(problem, np.zeros(unknowns, bool))
    assert unknowns == len(arm.parameters) + len(case.free)
    assert _counted(arm, group, case.free) == unknowns - case.lost
    assert found.determined == unknowns - case.lost
