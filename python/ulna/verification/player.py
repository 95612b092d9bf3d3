"""A virtual arm plays a plan: it stands artefacts in its reach and touches them, with noise. mm and rad."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.ground.arrays import F64, Progress
from ulna.ground.errors import UlnaInputError
from ulna.simulation.mover import Mover
from ulna.simulation.reading_errors import ReadingErrors, turns
from ulna.simulation.touches import GOLDEN
from ulna.verification.plan_files import Filled
from ulna.verification.profile import Profile
from ulna.verification.steps import Step, lengths_of, steps_of

Stated = dict[str, dict[str, Any]]

BALL_MM = 25.0
U_MM = {"ball": 0.0003, "length": 0.001}
FIXTURE_MM = 0.001
#: of the sum of the links: what an arm's maker would call its reach
REACHED = 0.8
#: half the width of a gauge's faces
FACE_MM = 4.0
#: places tried at once, and how often
PLACES, ROUNDS = 6, 300
#: shares of the reach at which the seats of a single-point test stand: lowest, highest
SEAT_SHARES = {"near": (0.1, 0.2), "middle": (0.45, 0.55), "far": (0.8, 0.9)}
#: examples, of no maker
MPE: dict[str, Any] = {
    "P_Size": 0.040,
    "P_Form": 0.080,
    "L_Dia": 0.060,
    "E_Uni": {"a": 0.040, "b": 40000.0},
    "E_Bi": {"a": 0.050, "b": 40000.0},
    "Diameter_max": 0.040,
    "SPAT_2S": 0.060,
    "Volumetric_max": 0.080,
    "Volumetric_2S": 0.080,
}


@dataclass(frozen=True)
class Played:
    """What was played."""

    filled: Filled
    """The plan's values, as a certificate states them."""
    q_rad: F64
    """(N, n) readings, a row for each step."""
    truth: dict[str, float]
    """True length or diameter of each artefact, mm."""


def play(
    profile: Profile, truth: Arm, encoder_rad: float, touch_mm: float, seed: int, progress: Progress | None = None
) -> Played:
    """All touches of a profile with a true arm of one probe. Raises UlnaInputError where something is out of reach.

    encoder_rad: standard deviation of each encoder; touch_mm: of a touch, per coordinate. Elbow and wrist are drawn at
    random for each touch, whatever orientation the list asks for.
    """
    if len(truth.probes) != 1:
        raise UlnaInputError(
            f"arm '{truth.name}' has {len(truth.probes)} probes; expected one to play a plan with. Remove the others."
        )
    tip_mm = next(iter(truth.probes.values())).ball_mm
    if tip_mm is None:
        raise UlnaInputError(
            f"arm '{truth.name}': the diameter of its probe's ball is not known; expected it to touch with. Add "
            "ball = … to the probe."
        )
    rng = np.random.default_rng([seed, 12])
    travel = np.array([joint.limits_rad or (-np.pi, np.pi) for joint in truth.joints])
    margin = 6.0 * encoder_rad
    mover = Mover(truth, travel + np.array([margin, -margin]))
    range_mm = round(2.0 * REACHED * truth.core.reach_mm(0), -1)
    artefacts, true_mm = _artefacts(profile, range_mm, rng)
    player = _Player(mover, tip_mm, true_mm, 0.5 * range_mm, touch_mm, rng)
    steps = steps_of(profile.file)
    runs = [list(run) for _, run in groupby(steps, lambda step: (step.test, step.artefact, step.position))]
    parts: list[F64] = []
    done = 0
    for run in runs:
        parts.append(player.run(run))
        done += len(run)
        if progress is not None:
            progress("playing", done, len(steps))
    errors = ReadingErrors(np.full(truth.n, encoder_rad), touch_mm)
    filled = Filled(
        range_mm=range_mm,
        artefacts=artefacts,
        mpe=MPE,
        temperature={"value": 20.0, "u": 0.1},
        fixture_mm=FIXTURE_MM,
    )
    return Played(filled, errors.read(np.concatenate(parts), rng), true_mm)


def _artefacts(profile: Profile, range_mm: float, rng: np.random.Generator) -> tuple[Stated, dict[str, float]]:
    """As certificates state them, and as they are."""
    u_mm = U_MM["ball"]
    stated: dict[str, dict[str, Any]] = {
        "ball": {"diameter": BALL_MM, "u": u_mm, "form": 0.0005, "expansion": 5.5e-6, "u_expansion": 0.5e-6}
    }
    true_mm = {"ball": BALL_MM + u_mm * float(rng.standard_normal())}
    for length in lengths_of(profile.file):
        nominal, u_mm = float(np.ceil(length.share * range_mm)), U_MM["length"]
        stated[length.name] = {"length": nominal, "u": u_mm, "expansion": 11.5e-6, "u_expansion": 0.5e-6}
        true_mm[length.name] = nominal + u_mm * float(rng.standard_normal())
    return stated, true_mm


@dataclass
class _Player:
    mover: Mover
    tip_mm: float
    true_mm: dict[str, float]
    reach_mm: float
    touch_mm: float
    rng: np.random.Generator

    def run(self, steps: list[Step]) -> F64:
        """(N, n) true postures at the steps of one artefact in one place."""
        local_mm = self._local(steps)
        probe = np.zeros(len(steps) * PLACES, dtype=np.int64)
        warmth_k = np.zeros(len(probe)) if "link-expansion" in self.mover.arm.extras else None
        for _ in range(ROUNDS):
            axes = turns(np.eye(3), PLACES, self.rng)
            origin_mm = self._origins(steps[0], local_mm, axes)
            at_mm = origin_mm[:, None] + local_mm @ axes
            at_mm += self.touch_mm * self.rng.standard_normal(at_mm.shape)
            flat = at_mm.reshape(-1, 3)
            q_rad, reached = self.mover.on_points(flat, probe, warmth_k, int(self.rng.integers(2**63)))
            whole = reached.reshape(PLACES, -1).all(axis=1)
            if whole.any():
                return np.asarray(q_rad.reshape(PLACES, len(steps), -1)[int(np.argmax(whole))])
        first = steps[0]
        raise UlnaInputError(
            f"arm '{self.mover.arm.name}': no place was found where all of {first.artefact or 'a seat'} (test "
            f"'{first.test}', position {first.position or '1'}) is within reach; expected an artefact that fits. Take "
            "a profile with shorter lengths, or an arm with wider limits."
        )

    def _origins(self, step: Step, local_mm: F64, axes: F64) -> F64:
        """(PLACES, 3) such that the middle of the artefact, or its first touch, is where the tip can be."""
        if step.artefact:
            poses = self.mover.anywhere(PLACES, self.rng)
            return np.asarray(self._tips(poses) - local_mm[0] @ axes)
        low, high = SEAT_SHARES.get(step.position, (0.1, 0.9))
        tips = self._tips(self.mover.anywhere(800 * PLACES, self.rng))
        share = np.linalg.norm(tips, axis=1) / self.reach_mm
        away = np.maximum(low - share, share - high)
        return np.asarray(tips[np.argsort(np.maximum(away, 0.0), kind="stable")[:PLACES]])

    def _tips(self, q_rad: F64) -> F64:
        warmth_k = np.zeros(len(q_rad)) if "link-expansion" in self.mover.arm.extras else None
        return np.asarray(self.mover.arm.core.tip(q_rad, 0, warmth_k))

    def _local(self, steps: list[Step]) -> F64:
        """(N, 3) centres of the probe's ball in the artefact's frame."""
        first = steps[0]
        if not first.artefact:
            return np.zeros((len(steps), 3))
        true_mm = self.true_mm[first.artefact]
        if first.artefact == "ball":
            return 0.5 * (true_mm + self.tip_mm) * _half_sphere(steps)
        at_mm = np.zeros((len(steps), 3))
        face = first.artefact.startswith("gauge")
        gap_mm = true_mm + (self.tip_mm if face else 0.0)
        at_mm[:, 0] = [gap_mm if step.feature == "B" else 0.0 for step in steps]
        if face:
            turn = 2.0 * np.pi * np.arange(len(steps)) / 3.0
            at_mm[:, 1], at_mm[:, 2] = FACE_MM * np.cos(turn), FACE_MM * np.sin(turn)
        return at_mm


def _half_sphere(steps: list[Step]) -> F64:
    """(N, 3) unit vectors: each measurement's own spread over the half of the ball that is away from its stem."""
    parts = []
    for _, run in groupby(steps, lambda step: (step.orientation, step.repeat)):
        count = len(list(run))
        number = np.arange(count)
        height = (number + 0.5) / count
        angle, radius = 2.0 * np.pi * number * GOLDEN, np.sqrt(1.0 - height**2)
        parts.append(np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height]))
    return np.concatenate(parts)
