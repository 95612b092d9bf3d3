"""Ulna's core timed in Rust, by its own programs: `cargo run --release -p ulna --example bench`, and `kinds`."""

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

from benchmarks.peers import Contender, MissingPeerError, Times
from benchmarks.tasks import FIT_LENGTHS, FORWARD_POSES, RESIDUAL_LENGTHS

ROOT = Path(__file__).resolve().parents[2]
RUN = ["cargo", "run", "--locked", "--quiet", "--release", "--package", "ulna", "--example"]


def _printed_by(example: str) -> dict[str, Any]:
    """What an example of the core prints. Raises MissingPeerError where it fails."""
    done = subprocess.run([*RUN, example], capture_output=True, text=True, check=False, cwd=ROOT)
    if done.returncode != 0:
        raise MissingPeerError(f"the example {example} failed: {done.stderr.strip()[-300:]}")
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def contender() -> Contender:
    if shutil.which("cargo") is None:
        raise MissingPeerError("cargo is not installed")
    versions = json.loads(
        subprocess.run(
            ["cargo", "metadata", "--locked", "--no-deps", "--format-version", "1"],
            capture_output=True,
            text=True,
            check=True,
            cwd=ROOT,
        ).stdout
    )
    version = next(package["version"] for package in versions["packages"] if package["name"] == "ulna")

    def measure(quick: bool) -> Times:
        found, kinds = _printed_by("bench"), _printed_by("kinds")
        times: Times = {
            "forward": FORWARD_POSES / found["forward_poses_per_s"],
            "residual_jacobian": 2 * RESIDUAL_LENGTHS / found["residual_jacobian_poses_per_s"],
            "recalibrate": found["recalibrate_1000_s"]["1"],
            "recalibrate_2": found["recalibrate_1000_s"]["2"],
        }
        times["peak_1000000_mb"] = found["fit_1000000_memory_beyond_data_mb"]
        times |= {f"judged_{rows}": found["fit_and_judge_ms"][str(rows)] / 1000 for rows in FIT_LENGTHS}
        times |= {f"fit_{rows}": found["fit_ms"][str(rows)] / 1000 for rows in FIT_LENGTHS}
        return times | {f"touch_{name}": nanoseconds * 1e-9 for name, nanoseconds in kinds.items()}

    return Contender(
        "Ulna, core",
        f"ulna {version}",
        "the Rust core called from Rust, one thread, not pinned; a fit counts all from the readings in memory to "
        "the fitted parameters; residuals and derivatives are handed over by blocks and never stored; the repeated "
        "fits come without uncertainties; all 27 parameters are free, the two lost ones found out",
        measure,
    )
