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

result = ulna.calibrate(HERE / "study.toml")
measured = ulna.measure(result, HERE / "check-bars.csv")
assert measured.table is not None
print("the first two touches, mm:")
for row in measured.table.head(2).iter_rows(named=True):
    print("  " + "   ".join(f"{axis} = {row[axis]:8.3f} ± {row['u_' + axis]:.4f}" for axis in "xyz"))

# The same in memory: an array of encoder angles in rad gives points in mm that know how they err, also together.
q_rad = np.zeros((3, result.arm.n))
q_rad[:, 1] = [0.2, 0.4, 0.6]
points = ulna.measure(result, q_rad)
print("three poses:", np.round(points.points_mm, 2).tolist())
length = points.length(0, 2)
assert length.u_mm is not None
print(f"from the first to the last: {length.value_mm:.4f} mm, u = {length.u_mm:.4f} mm")

# Results survive on disk: every function takes the folder in place of the result.
with tempfile.TemporaryDirectory() as folder:
    result.save(folder, force=True)
    again = ulna.measure(folder, q_rad)
print("the same from the folder:", bool((again.points_mm == points.points_mm).all() and again.length(0, 2) == length))
