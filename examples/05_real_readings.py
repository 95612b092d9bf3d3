"""Calibrate a real arm from readings that others published.

A Franka Panda robot held a ball in two printed sockets, 50 mm apart, in several places of its volume
(platonics-delft/kinematics_calibration, MIT). The importer turns that folder into an Ulna study; cross-validation
leaves out one place at a time and judges each fit on the place that it has not seen.

The data set is not part of Ulna. Give its folder as the first argument; by default it is looked for in
`../shared/data/mukca`, seen from the project's root.
"""

import sys
import tempfile
from pathlib import Path

import ulna
from ulna.exchange.importers.mukca import import_mukca

ROOT = Path(__file__).resolve().parents[1]
data = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT.parent / "shared" / "data" / "mukca"
if not data.is_dir():
    print(f"skipped: {data} is not there; the readings of kinematics_calibration are needed", file=sys.stderr)
    sys.exit(77)

for robot in ("panda_1", "panda_2_clean"):
    with tempfile.TemporaryDirectory() as folder:
        counts = import_mukca(data / robot, Path(folder) / robot)
        study = ulna.Study.load(Path(folder) / robot / "study.toml")
    found = ulna.cross_validate(study, by="placement")
    print(f"{robot}: {sum(counts.values())} readings, {len(counts)} places, each left out once")
    for name, words in (
        ("seat_scatter_mean_mm", "distance of a touch to its socket's mean, mean"),
        ("length_error_mean_abs_mm", "error of the 50 mm between the sockets, mean"),
    ):
        print(f"  {words}: {found.before[name]:.2f} → {found.after[name]:.3f} mm")
