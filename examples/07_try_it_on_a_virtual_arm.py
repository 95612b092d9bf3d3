"""Try a measurement on a virtual arm before anybody takes it: what do a few missed seats do, and what helps?

A bar stands in 80 places; of all touches one in a hundred was none, the ball half a millimetre beside its seat. The
truth is known, so the arms that are found can be held to it: how wrong are the lengths that they measure?
"""

from dataclasses import replace

import numpy as np

import ulna
from ulna.simulation.spec import Missed, Simulation, Touching
from virtual_lengths import JOINTS

BAR = ulna.Artefact("bar", "bar", {"A": (0.0, 0.0, 0.0), "B": (443.172, 0.0, 0.0)}, length_mm=443.172, u_mm=0.001)
SIMULATION = Simulation(
    arm=ulna.Arm("seven axes", JOINTS, {"bent": ulna.Probe(40.0, 0.0, 200.0)}),
    touching=[Touching(BAR, placements=80, touches=2)],
    seed=7,
    encoder_rad=np.full(7, 5e-6),
    seat_mm=0.008,
    missed=Missed(share=0.01, size_mm=0.5),
)


def wrong_by_mm(found: ulna.Arm, truth: ulna.Arm) -> float:
    """Root mean square error of distances between random poses that the found arm measures."""
    q_rad = np.random.default_rng(1).uniform(-2.5, 2.5, (2000, 2, truth.n))
    of_found, of_truth = (np.linalg.norm(arm.tip(q_rad[:, 1]) - arm.tip(q_rad[:, 0]), axis=1) for arm in (found, truth))
    return float(np.sqrt(np.mean((of_found - of_truth) ** 2)))


if __name__ == "__main__":
    missed = ulna.simulate(SIMULATION)
    touched = ulna.simulate(replace(SIMULATION, missed=None))
    rows = missed.truth.touchings[0].missed
    print(f"{len(rows)} touches, {rows.sum()} of them missed: rows {', '.join(map(str, np.flatnonzero(rows) + 1))}")
    for words, simulated, loss in (
        ("none missed", touched, "none"),
        ("some missed", missed, "none"),
        ("some missed, loss tukey", missed, "tukey"),
    ):
        result = ulna.calibrate(simulated.study, loss=loss)
        wrong_mm = wrong_by_mm(result.arm, simulated.truth.arm)
        far = sorted(reading["row"] for reading in result.outliers)
        print(f"{words}: chi²/dof {result.fit.chi2_per_dof:.2f}, lengths wrong by {wrong_mm:.4f} mm, far off: {far}")
