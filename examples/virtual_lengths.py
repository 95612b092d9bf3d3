"""An arm of seven axes (Cheng 2011, Table 2) and lengths between random poses of it: shared by examples 03 and 04."""

import numpy as np

import ulna

JOINTS = (
    ulna.Joint(theta0_rad=0.0, alpha_rad=-np.pi / 2, a_mm=40.0, d_mm=250.0),
    ulna.Joint(theta0_rad=2.2689, alpha_rad=np.pi / 2, a_mm=-40.0, d_mm=0.0),
    ulna.Joint(theta0_rad=0.0, alpha_rad=-np.pi / 2, a_mm=30.0, d_mm=450.0),
    ulna.Joint(theta0_rad=2.2689, alpha_rad=np.pi / 2, a_mm=-30.0, d_mm=0.0),
    ulna.Joint(theta0_rad=0.0, alpha_rad=-np.pi / 2, a_mm=30.0, d_mm=450.0),
    ulna.Joint(theta0_rad=2.2689, alpha_rad=np.pi / 2, a_mm=-30.0, d_mm=0.0),
    ulna.Joint(name="wrist roll"),
)


def lengths_between_random_poses(arm: ulna.Arm, rows: int, seed: int) -> ulna.Study:
    """A study of `rows` lengths, each between two random poses."""
    rng = np.random.default_rng(seed)
    q_rad, p_rad = rng.uniform(-np.pi, np.pi, (2, rows, arm.n))
    probe = np.arange(rows) % len(arm.probes)
    distance_mm = np.linalg.norm(arm.core.tip(q_rad, probe) - arm.core.tip(p_rad, probe), axis=1)
    readings = ulna.Readings(
        artefact=ulna.Artefact("lengths", "length", {}),
        q_rad=q_rad,
        p_rad=p_rad,
        length_mm=distance_mm,
        probe=probe,
        feature=np.zeros(rows, np.int64),
        placement=np.full(rows, "1", dtype=object),
        row=np.arange(1, rows + 1),
        file=np.zeros(rows, np.int64),
    )
    return ulna.Study(path=None, arm=arm, readings=[readings])
