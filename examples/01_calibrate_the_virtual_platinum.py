"""Calibrate an arm from readings of a bar.

A bar with two conical seats, 443.172 mm apart, stood in 101 places; the arm touched both seats of each once. The arm
file holds what a drawing might say: zero offsets wrong by some 0.1 rad, lengths by up to 45 mm. The fit finds the
rest. Then the calibrated arm is judged on ten bars that the fit has not seen, which is the only judgement that counts.

The readings are virtual, made from the published numbers of a real arm (Cheng, Yu, Fei 2011, Table 4), so for once
the truth is known.
"""

from pathlib import Path

import ulna

HERE = Path(__file__).resolve().parent / "platinum"

study = ulna.Study.load(HERE / "study.toml")
result = ulna.calibrate(study)

fit = result.fit
print(f"{fit.termination} after {fit.iterations} iterations")
print(f"residual, rms: {fit.rms_start_mm:.0f} mm before, {fit.rms_mm:.4f} mm after; chi²/dof {fit.chi2_per_dof:.2f}")

print("\nfour of the 27 parameters, with standard uncertainties (truth: 0.791659, 28.5382, 439.5104, held):")
by_name = {parameter.name: parameter for parameter in result.parameters}
for name in ("joint.2.theta0", "joint.3.a", "joint.3.d", "joint.1.theta0"):
    parameter = by_name[name]
    uncertainty = "held" if parameter.u is None else f"± {parameter.u:.1e} {parameter.unit}"
    print(f"  {name:15s} {parameter.value:11.5f} {uncertainty}")

fresh = ulna.Study.load(HERE / "check.toml")
for words, arm in (("before", study.arm), ("after", result.arm)):
    worst_mm = ulna.evaluate(arm, fresh).overall["length_error_max_abs_mm"]
    print(f"ten fresh bars, {words}: largest length error {worst_mm:.3f} mm")
