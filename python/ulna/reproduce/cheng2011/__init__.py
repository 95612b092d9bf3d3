"""Cheng, Yu, Fei: Kinematic model and calibration of a seven-axis articulated arm coordinate measuring machine.

J. Univ. Sci. Tech. China 41(5), 2011, doi 10.3969/j.issn.0253-2778.2011.05.010. Rerun here: the simulation of its
Tables 2 and 3 with and without a bend of the probe; how wrong the zero offsets may start; and its experiment, on a
virtual arm with the parameters of its Table 4.
"""

from __future__ import annotations

from pathlib import Path

from ulna.ground.arrays import Progress
from ulna.ground.extras import need
from ulna.reproduce.cheng2011.convergence import study_convergence
from ulna.reproduce.cheng2011.experiment import repeat_experiment, rerun_experiment
from ulna.reproduce.cheng2011.rerun import Rerun
from ulna.reproduce.cheng2011.simulation import rerun_simulation

#: called with (stage, done, total)

#: all random numbers of a run come from it
SEED = 2011


def run(
    out: Path | None, progress: Progress | None, *, starts: int = 200, repeats: int = 100, force: bool = True
) -> Rerun:
    """Rerun the study. `starts`: wrong starts per size of error; `repeats`: of the whole virtual experiment, new noise.

    With a folder `out`, pictures (SVG and PNG) and `cheng2011.json` are written there, all or none; `force` False
    refuses to overwrite them. Raises UlnaInputError where they cannot be written, KeyboardInterrupt.
    """
    if out is not None:
        need("the pictures of a rerun", "matplotlib")
    found = Rerun(
        simulation=rerun_simulation(SEED),
        convergence=study_convergence(SEED, starts, progress),
        experiment=rerun_experiment(SEED),
        repeated=repeat_experiment(SEED, repeats, progress),
    )
    if out is not None:
        found.save(out, force=force)
    return found
