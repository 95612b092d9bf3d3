"""What the tests of simulations share: a true arm, specifications on disk, and how far off a calibration is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from tests.cli_runs import platinum

import ulna
from ulna import Arm, Effects, Probe, Study

BENT = Probe.from_cylindrical(0.431148, 39.4321, 223.8773, 6.0)
NOISE = "noise = { encoder = 5e-6, seat = 0.008 }"
BAR = '[artefact.bar]\nkind = "bar"\nlength = 443.172\nu = 0.001\n'
PLATE = """[artefact.plate]
kind = "points"
features = { a = [0.0, 0.0, 0.0], b = [300.0, 0.0, 0.0], c = [0.0, 200.0, 0.0], d = [300.0, 200.0, 40.0] }
u = 0.001
"""
BALL = '[artefact.ball]\nkind = "sphere"\ndiameter = 25.0\nu = 0.002\n'


def true_arm(probes: dict[str, Probe] | None = None) -> Arm:
    """The Platinum with limits: swivels nearly a turn, hinges from -0.3 to 2.7 rad of bend."""
    arm = platinum(probes or {"bent": BENT})
    limits = [
        (-3.1, 3.1) if k % 2 == 0 else (joint.theta0_rad - 0.3, joint.theta0_rad + 2.7)
        for k, joint in enumerate(arm.joints)
    ]
    return replace(
        arm, joints=tuple(replace(joint, limits_rad=own) for joint, own in zip(arm.joints, limits, strict=True))
    )


def write(folder: Path, artefacts: str, more: str = NOISE, arm: Arm | None = None) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (arm or true_arm()).save(folder / "true.toml", force=True)
    spec = folder / "spec.toml"
    head = 'format = "ulna-simulation/1"\narm = "true.toml"\nunits = { length = "mm", angle = "rad" }\n'
    spec.write_text(f"{head}{more}\n{artefacts}")
    return spec


def saved(spec: Path, name: str = "out") -> tuple[ulna.Simulated, Study]:
    """Simulated, and the study as a user loads it."""
    simulated = ulna.simulate(spec)
    simulated.save(spec.parent / name)
    return simulated, Study.load(spec.parent / name / "study.toml")


def off_over_u(simulated: ulna.Simulated, result: ulna.Result) -> np.ndarray:
    """Errors of fitted parameters against the truth, in their standard uncertainties."""
    arm = simulated.truth.arm
    true = dict(zip(arm.parameter_names, arm.parameters.tolist(), strict=True))
    rows = [row for row in result.parameters if row.status == "fitted" and row.name in true]
    return np.array([(row.value - true[row.name]) / row.u for row in rows])


def with_effects() -> Arm:
    arm = true_arm()
    own = [
        Effects(
            {1: (2e-5 * (k + 1), -3e-5), 2: (1e-5, 2e-5)}, 1.2e-5 + 1e-6 * k, 2e-6 * (k + 1), 0.8, (0.0, 10.0, -60.0)
        )
        for k in range(7)
    ]
    return replace(arm, joints=tuple(replace(joint, effects=each) for joint, each in zip(arm.joints, own, strict=True)))


def standing(account: dict[str, Any], artefact: str) -> tuple[np.ndarray, np.ndarray]:
    own = [entry for entry in account["placements"] if entry["artefact"] == artefact]
    return np.array([entry["origin_mm"] for entry in own]), np.array([entry["axes"] for entry in own])
