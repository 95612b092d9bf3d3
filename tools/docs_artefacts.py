"""The table on the page "Which artefact?": the same number of touches on each, by the same virtual arm."""

import math
from dataclasses import dataclass, replace

import numpy as np

import ulna
from docs_running import ROOT
from ulna.arm.reading_noise import UNKNOWN
from ulna.artefacts.artefact import Artefact
from ulna.simulation.spec import Drawing, Simulation, Touching
from ulna.uncertainties.volume import VolumeTask, volume_map

LENGTH_MM = 900.0
"""Of the test lengths."""
ARMS = 10
"""Calibrations of each, with noise of their own."""
ENCODER_RAD, SEAT_MM = 5e-6, 0.008

LINE = {"A": (0.0, 0.0, 0.0), "B": (443.172, 0.0, 0.0)}
LONG = {"A": (0.0, 0.0, 0.0), "B": (900.0, 0.0, 0.0)}
PLATE = {f"{x}{y}": (100.0 * x, 100.0 * y, 0.0) for x in range(4) for y in range(4)}
BAR = Artefact("bar", "bar", LINE, 443.172)


@dataclass(frozen=True)
class Way:
    """A row of the table."""

    words: str
    touching: tuple[Touching, ...]


WAYS = (
    Way("bar of 443 mm, in 140 places", (Touching(BAR, 140),)),
    Way("the same bar, in 10 places", (Touching(BAR, 10, 14),)),
    Way("bar of 900 mm, in 140 places", (Touching(Artefact("bar", "bar", LONG, 900.0), 140),)),
    Way("plate of 16 seats, 300 mm square, in 17 places", (Touching(Artefact("plate", "points", PLATE), 17),)),
    Way("the same plate, in one place", (Touching(Artefact("plate", "points", PLATE), 1, 17),)),
    Way("ball of 30 mm, in 14 places", (Touching(Artefact("ball", "sphere", {}, diameter_mm=30.0), 14, 20),)),
    Way("plane of 200 mm square, in 14 places", (Touching(Artefact("plane", "plane", {}), 14, 20),)),
    Way("one seat, in one place", (Touching(Artefact("cone", "seat", {"seat": (0.0, 0.0, 0.0)}), 1, 280),)),
    Way(
        "one seat 140 times, the bar in 70 places",
        (Touching(Artefact("cone", "seat", {"seat": (0.0, 0.0, 0.0)}), 1, 140), Touching(BAR, 70)),
    ),
)


def _true_arm() -> ulna.Arm:
    """The example's drawing with a ball on its probe and a travel."""
    arm = ulna.Arm.load(ROOT / "examples" / "platinum" / "platinum.toml")
    hinges = {2: 0.49, 4: 0.58, 6: 0.56}
    joints = [
        replace(joint, limits_rad=(hinges[k], hinges[k] + 3.0) if k in hinges else (-3.14, 3.14))
        for k, joint in enumerate(arm.joints, 1)
    ]
    probes = {name: replace(probe, ball_mm=6.0) for name, probe in arm.probes.items()}
    return replace(arm, joints=tuple(joints), probes=probes)


def _row(way: Way, truth: ulna.Arm) -> str:
    travel_rad = np.array([joint.limits_rad for joint in truth.joints])
    low, high = travel_rad[:, 0], travel_rad[:, 1]
    q_rad = np.random.default_rng(3).uniform(low, high, (4000, 2, truth.n))
    true_mm = np.linalg.norm(truth.tip(q_rad[:, 1]) - truth.tip(q_rad[:, 0]), axis=1)
    errors, expected, determined, scale = [], [], 0, False
    for seed in range(1, ARMS + 1):
        simulation = Simulation(
            truth,
            list(way.touching),
            seed=seed,
            encoder_rad=np.full(truth.n, ENCODER_RAD),
            seat_mm=SEAT_MM,
            drawing=Drawing(offset_rad=0.01, length_mm=0.5),
        )
        made = ulna.simulate(simulation)
        result = ulna.calibrate(made.study)
        found = np.linalg.norm(result.arm.tip(q_rad[:, 1]) - result.arm.tip(q_rad[:, 0]), axis=1)
        errors.append(np.sqrt(np.mean((found - true_mm) ** 2)))
        determined = result.identifiability.determined
        task = VolumeTask(travel_rad, next(iter(truth.probes)), "volume", UNKNOWN, (LENGTH_MM,), points=100, bars=400)
        u_mm = volume_map(result.arm, task, seed=1).lengths[LENGTH_MM].u_mm
        scale = scale or bool(np.isnan(u_mm).any())
        expected.append(float(np.median(u_mm)) if not scale else math.nan)
    u_text = "not determined" if scale else f"{1000 * float(np.median(expected)):.1f}"
    wrong = f"{1000 * float(np.sqrt(np.mean(np.square(errors)))):.1f}"
    return f"| {way.words} | {determined} | {u_text} | {wrong} |"


def artefact_table() -> str:
    """Markdown."""
    truth = _true_arm()
    lines = [
        f"| about 280 touches of | determined of {len(truth.parameter_names)} "
        f"| u of {LENGTH_MM:g} mm / µm, median | lengths wrong by / µm, rms |",
        "|---|---:|---:|---:|",
    ]
    return "\n".join([*lines, *(_row(way, truth) for way in WAYS)]) + "\n"


if __name__ == "__main__":
    print(artefact_table())
