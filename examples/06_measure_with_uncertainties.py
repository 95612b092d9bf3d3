"""Measure points with a calibrated arm, and say how well they are known.

A result knows the covariance of its parameters, so every point that the arm measures has a standard uncertainty, in
each coordinate. Where a point depends on something that the calibration could not determine, there is no number, and
a note says why: a probe that was not calibrated is such a case.
"""

import tempfile
from pathlib import Path

import numpy as np

import ulna

HERE = Path(__file__).resolve().parent / "platinum"

result = ulna.calibrate(ulna.Study.load(HERE / "study.toml"))
measured = ulna.measure(result.arm, HERE / "check-bars.csv", encoder_u_rad=np.full(result.arm.n, 5e-6))
assert measured.table is not None
print("the first two touches, mm:")
for row in measured.table.head(2).iter_rows(named=True):
    print("  " + "   ".join(f"{axis} = {row[axis]:8.3f} ± {row['u_' + axis]:.4f}" for axis in "xyz"))

# The same in memory: arrays of encoder angles in rad give arrays of points in mm.
q_rad = np.zeros((3, result.arm.n))
q_rad[:, 1] = [0.2, 0.4, 0.6]
print("three poses:", np.round(result.arm.tip(q_rad), 2).tolist())

# Results survive on disk: an arm loaded from a result.json carries its uncertainty.
with tempfile.TemporaryDirectory() as folder:
    result.save(folder)
    again = ulna.Arm.load(Path(folder) / "result.json")
print("uncertainty kept:", again.uncertainty is not None)
