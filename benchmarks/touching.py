"""Touching with the guide: how long it takes to know what is known after a touch, and how many touches it saves.

python -m benchmarks.touching [--arms 200] [--page docs/benchmarks/touching.md]

The arm is the paper's (Cheng, Yu and Fei 2011: examples/platinum), the bar its bar, the noise that of its plan. Each
arm of the second table is off that drawing by 0.2 mm and 1.5 mrad (standard deviations), and is touched until a 500 mm
length is known to U (k = 2) = 40 µm by what the touches tell; then 500 fresh bars anywhere are measured with it, beside
the truth.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from fnmatch import fnmatch
from functools import cache, partial
from pathlib import Path

import numpy as np

import ulna
from ulna.ground.arrays import F64
from ulna.live.guide import Guide, Suggestion
from ulna.live.running import RunningFit
from ulna.live.touches import Touch
from ulna.planning.file import load_plan_spec
from ulna.planning.spec import PlanSpec
from ulna.simulation.mover import Mover
from ulna.study.data import FitOptions, Noise

EXAMPLE = Path("examples/platinum")
GOAL_MM = 0.040
MOST = 400
DRAWS = 10
"""Different sets of candidates that the arms take turns with: drawing them is not what is measured."""
COUNTS = (100, 500, 1000, 5000)
REPEATS = 7


@dataclass(frozen=True)
class Case:
    """An arm in a hand."""

    drawing: ulna.Arm
    truth: ulna.Arm
    spec: PlanSpec
    rng: np.random.Generator

    @classmethod
    def of(cls, seed: int) -> Case:
        """The paper's arm, off its drawing."""
        drawing = ulna.Arm.load(EXAMPLE / "platinum.toml")
        spec = replace(load_plan_spec(EXAMPLE / "plan.toml", drawing), test_mm=500.0, placements=None)
        rng = np.random.default_rng([seed, 5])
        units = np.array(drawing.parameter_units)
        off = np.where(units == "mm", 0.2, 0.0015) * rng.standard_normal(len(units))
        off[[any(fnmatch(name, held) for held in spec.hold) for name in drawing.parameter_names]] = 0.0
        return cls(drawing, drawing.with_parameters(drawing.core.parameters + off), spec, rng)

    def begun(self, seed: int = 0, first: bool = False) -> tuple[RunningFit, Guide]:
        """Nothing touched yet. first: candidates are drawn, and not taken from another guide of that seed."""
        noise = Noise(self.spec.encoder_rad, self.spec.seat_mm)
        fit = RunningFit(self.drawing, [self.spec.artefact], noise, FitOptions(hold=list(self.spec.hold)))
        return fit, Guide(fit, self.spec, seed, None if first else drawn(seed).candidates)

    def put(self, suggestion: Suggestion) -> F64:
        """(2, 3) where the ends of the bar are: about where they were asked for."""
        a, b = suggestion.stand.points_mm
        along, middle = (b - a) / np.linalg.norm(b - a), (a + b) / 2.0 + 3.0 * self.rng.standard_normal(3)
        half = 0.5 * float(self.spec.artefact.length_mm or 0.0)
        return np.array([middle - half * along, middle + half * along])

    def touched(self, point_mm: F64, near_rad: F64, travel_rad: F64) -> F64 | None:
        """(n,) angles that are read, near a posture; None where the arm does not reach."""
        at_mm = point_mm + self.spec.seat_mm * self.rng.standard_normal(3)
        none, seed = np.zeros(1, np.int64), int(self.rng.integers(2**60))
        q_rad, reached = Mover(self.truth, travel_rad).nearby(near_rad[None], at_mm[None], none, {}, seed)
        read: F64 = q_rad[0] + self.spec.encoder_rad * self.rng.standard_normal(self.drawing.n)
        return read if reached[0] else None


Choice = Callable[[Guide, object, str | None, np.random.Generator], Suggestion]


def guided(guide: Guide, so_far: object, place: str | None, rng: np.random.Generator) -> Suggestion:
    """As the guide says."""
    return guide.next(so_far, place)  # type: ignore[arg-type]


def at_random(most: int) -> Choice:
    """Any place and any posture, so many touches in a place."""
    return lambda guide, so_far, place, rng: guide.any_touch(rng, place, most)


def reached(seed: int, choice: Choice) -> tuple[int, int, float, float]:
    """Touches and places to the goal, U then (mm), and the root mean square error of fresh lengths (mm)."""
    case = Case.of(seed)
    fit, guide = case.begun(seed % DRAWS)
    assert case.spec.travel_rad is not None
    so_far, place, bar_mm, count = fit.so_far(), 0, None, 0
    while count < MOST:
        u_mm = guide.worth(so_far).u_mm
        if fit.fitted is not None and 2.0 * u_mm <= GOAL_MM:
            break
        suggestion = choice(guide, so_far, str(place) if place else None, case.rng)
        if not suggestion.here or bar_mm is None:
            place, bar_mm = place + 1, case.put(suggestion)
        read = case.touched(bar_mm[suggestion.feature], suggestion.q_rad, case.spec.travel_rad)
        if read is None:
            place += 1  # nobody reaches it: the bar is put elsewhere
            continue
        count += 1
        fit.add(Touch(count, case.spec.artefact.name, str(place), suggestion.feature, 0, read))
        if count >= 10 and count % 2 == 0:
            with suppress(ulna.UlnaInputError):  # too few for a fit
                fit.refit()
        so_far = fit.so_far()
    errors = fresh(case, fit.arm)
    return count, len({touch.standing for touch in fit.touches}), 2.0 * u_mm, float(np.sqrt((errors**2).mean()))


def fresh(case: Case, found: ulna.Arm) -> F64:
    """(500,) errors of 500 mm bars anywhere that no touch has seen, exactly touched, mm."""
    flat = fresh_rad().reshape(-1, found.n)
    ends = [arm.core.tip(flat, 0).reshape(-1, 2, 3) for arm in (case.truth, found)]
    true, read = (np.linalg.norm(each[:, 1] - each[:, 0], axis=1) for each in ends)
    errors: F64 = read - true
    return errors


@cache
def fresh_rad() -> F64:
    """(500, 2, 7) postures at their ends."""
    return drawn(DRAWS).test_rad


@cache
def drawn(seed: int) -> Guide:
    """A guide whose candidates others take as well."""
    return Case.of(0).begun(seed, first=True)[1]


def times_ms(count: int) -> dict[str, float]:
    """After so many touches, six in a place: medians."""
    case = Case.of(0)
    fit, guide = case.begun()
    assert case.spec.travel_rad is not None
    place = 0
    touches: list[Touch] = []
    while len(touches) < count + REPEATS:
        suggestion = guide.any_touch(case.rng, None, 6)
        place, bar_mm = place + 1, case.put(suggestion)
        for k in range(6):
            read = case.touched(
                bar_mm[k % 2], suggestion.q_rad + 0.3 * case.rng.standard_normal(7), case.spec.travel_rad
            )
            if read is not None:
                touches.append(Touch(len(touches) + 1, case.spec.artefact.name, str(place), k % 2, 0, read))
    fit.touches.extend(touches[:count])
    fit.refit()
    guide.next(fit.so_far())
    found: dict[str, list[float]] = {"meter": [], "next": [], "next in place": [], "refit": []}

    def timed(name: str, work: Callable[[], object]) -> None:
        begin = time.perf_counter()
        work()
        found[name].append(1e3 * (time.perf_counter() - begin))

    for touch in touches[count : count + REPEATS]:

        def known(touch: Touch = touch) -> None:
            fit.add(touch)
            guide.worth(fit.so_far())

        timed("meter", known)
        timed("next", partial(guide.next, fit.so_far()))
        timed("next in place", partial(guide.next, fit.so_far(), touch.standing))
    for _ in range(REPEATS):
        timed("refit", fit.refit)
    return {name: float(np.median(each)) for name, each in found.items()}


def page(arms: int) -> str:
    """Both tables."""
    timed = {count: times_ms(count) for count in COUNTS}
    lines = [
        "| touches | one more: what is known, ms | best of 20 000 elsewhere, ms | and in place, ms | refit, ms |",
        "|---:|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {count} | {each['meter']:.1f} | {each['next']:.1f} | {each['next in place']:.1f} | {each['refit']:.1f} |"
        for count, each in timed.items()
    ]
    lines += [
        "",
        f"| {arms} arms to U(500 mm) = 40 µm | touches | of these | places | U then, µm | rms of fresh |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    ways: dict[str, Choice] = {
        "pairs at random, a place each": at_random(2),
        "at random, six in a place": at_random(6),
        "guided": guided,
    }
    base = None
    for name, choice in ways.items():
        each = np.array([reached(seed, choice) for seed in range(arms)])
        touches = float(each[:, 0].mean())
        base = touches if base is None else base
        rms = float(np.sqrt((each[:, 3] ** 2).mean()))
        lines.append(
            f"| {name} | {touches:.1f} | {100 * touches / base:.0f} % | {each[:, 1].mean():.1f} | "
            f"{1e3 * each[:, 2].mean():.1f} | {1e3 * rms:.1f} |"
        )
    today = datetime.now(UTC).date().isoformat()
    lines += ["", f"`python -m benchmarks.touching --arms {arms}`, {today}, {os.cpu_count()} cores."]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Measure, print, and write the page where one is named."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arms", type=int, default=200)
    parser.add_argument("--page", type=Path, default=None)
    asked = parser.parse_args()
    text = page(asked.arms)
    print(text)
    if asked.page is not None:
        asked.page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
