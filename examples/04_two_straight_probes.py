"""Calibrate with two straight probes of different lengths, and no bent one.

One straight probe leaves a family of parameters around joint 6 undetermined (example 03). A second straight probe of
another length, measured in the same fit, finds them: 28 of 30 parameters, all but the two that say where the base
frame lies.
"""

import numpy as np

import ulna
from virtual_lengths import JOINTS, lengths_between_random_poses

PROBES = {"short": ulna.Probe(0.0, 0.0, 200.0), "long": ulna.Probe(0.0, 0.0, 250.0)}
truth = ulna.Arm("two straight probes", JOINTS, PROBES)
study = lengths_between_random_poses(truth, rows=200, seed=2)

found = ulna.identify(study)
print(f"determined: {found.determined} of {found.parameters}")
print(f"lost: {', '.join(found.not_determined)}")

rng = np.random.default_rng(3)
wrong = np.where(np.array(truth.parameter_units) == "rad", 0.05, 5.0) * rng.uniform(-1.0, 1.0, len(truth.parameters))
result = ulna.calibrate(study.with_arm(truth.with_parameters(truth.parameters + wrong)))

error = np.abs(result.arm.parameters - truth.parameters)
determined = np.array([parameter.status == "fitted" for parameter in result.parameters])
angle = np.array(truth.parameter_units) == "rad"
print(f"start off by up to 0.05 rad and 5 mm; {result.fit.termination} after {result.fit.iterations} iterations")
print(f"angles recovered within 1e-9 rad: {bool(np.all(error[determined & angle] < 1e-9))}")
print(f"lengths recovered within 1e-6 mm: {bool(np.all(error[determined & ~angle] < 1e-6))}")
