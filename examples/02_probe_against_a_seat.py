"""Find a new probe's tip from one seat, the joints held.

An arm is calibrated once, with a bent probe. When another probe is put on, its tip is found in a minute: touch one
conical seat from many sides, hold all joint parameters, fit the probe's three numbers. Where the seat stands is not
needed. This is the second step of Cheng, Yu, Fei (2011).
"""

from pathlib import Path

import ulna

HERE = Path(__file__).resolve().parent / "platinum"

study = ulna.Study.load(HERE / "seat.toml")
print(f"held: {', '.join(study.fit.hold)}; fitted: the three numbers of {', '.join(study.arm.probes)}")

result = ulna.calibrate(study)
for parameter in result.parameters:
    if parameter.status == "fitted":
        print(f"  {parameter.name:17s} {parameter.value:9.4f} ± {parameter.u:.4f} mm (drawing: {parameter.start:.0f})")
theta0_rad, r_mm, h_mm = result.arm.probes["straight"].cylindrical
print(f"  in the literature's form: theta0 = {theta0_rad:.3f} rad, r = {r_mm:.4f} mm, h = {h_mm:.4f} mm")

fresh = ulna.Study.load(HERE / "check-straight.toml")
for words, arm in (("before", study.arm), ("after", result.arm)):
    worst_mm = ulna.evaluate(arm, fresh).overall["length_error_max_abs_mm"]
    print(f"ten fresh bars with this probe, {words}: largest length error {worst_mm:.3f} mm")
