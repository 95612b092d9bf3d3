"""The models of the literature that have more parameters than needed, asked the same readings."""

from __future__ import annotations

from dataclasses import replace

from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.calibration.identify import identify
from ulna.reproduce.ways.trial import Trial, study_of


def determined_of_full_link(trial: Trial, hold: tuple[str, ...] = ()) -> tuple[int, int]:
    """Parameters, and how many the trial's readings determine, where the last joint has a whole link before the tip."""
    start = trial.start
    (tip,) = start.probes.values()
    link = Joint(theta0_rad=0.3, alpha_rad=0.7, a_mm=25.0, d_mm=80.0)  # any will do: link and tip are one rigid body
    probe = Probe(0.0, 0.0, tip.z_mm) if hold else tip
    arm = replace(start, joints=(*start.joints[:-1], link), probes={"bent": probe}, full_last_link=True)
    found = identify(study_of(arm, trial.readings, hold=list(hold)))
    return found.parameters, found.determined
