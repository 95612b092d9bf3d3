"""``python -m benchmarks.front``: what files, checks, tables and commands add to what the core does, in one run.

Writes docs/benchmarks/front.md: a calibration from Python beside the core's fit of the same readings; the command by
a process that loads NumPy and Polars and ends; the command on 10⁵ bars beside the core's fit of them. Options: --quick
(10⁴ bars, nothing written), --million (10⁶ bars too).
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

import ulna
import ulna._core as _core
from benchmarks.machine import describe
from benchmarks.many_bars import PLATINUM, write
from benchmarks.readings import START, TRUTH, lengths
from ulna.study.assembly import assemble
from ulna.study.study import Study

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "benchmarks" / "front.md"
HOLD = ["joint.1.theta0", "joint.1.d"]

#: a command's time and largest memory, told by the process that ran it
_WAITS = (
    "import json, resource, subprocess, sys, time\n"
    "since = time.perf_counter()\n"
    "subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)\n"
    "spent = time.perf_counter() - since\n"
    "print(json.dumps([spent, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024]))"
)


def arm() -> ulna.Arm:
    """The arm that the other benchmarks fit, at its start."""
    links = TRUTH[:24].reshape(6, 4)
    joints = [ulna.Joint(theta0, alpha, a, d) for theta0, alpha, a, d in links.tolist()]
    there = ulna.Arm("benchmark", (*joints, ulna.Joint()), {"bent": ulna.Probe(*TRUTH[24:27].tolist())})
    return there.with_parameters(START)


def study_of_lengths(count: int) -> Study:
    """So many lengths in memory."""
    data = lengths(count)
    artefact = ulna.Artefact("lengths", "length", {})
    whole, zero = np.arange(1, count + 1), np.zeros(count, dtype=np.int64)
    labels = np.full(count, "1", dtype=object)
    readings = ulna.Readings(artefact, data.q_rad, data.p_rad, data.length_mm, zero, zero, labels, whole, zero)
    return Study(path=None, arm=arm(), readings=[readings], fit=ulna.FitOptions(hold=HOLD))


def best_s(work: Callable[[], object], tries: int) -> float:
    """The shortest of some tries."""
    found = []
    for _ in range(tries):
        since = time.perf_counter()
        work()
        found.append(time.perf_counter() - since)
    return min(found)


def fit_s(study: Study, tries: int) -> float:
    """The core's fit and judgement alone, of readings that are in it."""
    there = assemble(study)
    return best_s(lambda: _core.fit(there.problem, there.hold), tries)


def process(*command: str, tries: int) -> tuple[float, float]:
    """Seconds and MB of a process from its start to its end; the least of some tries."""
    found = []
    for _ in range(tries):
        done = subprocess.run(
            [sys.executable, "-c", _WAITS, *command], capture_output=True, text=True, check=True, cwd=ROOT
        )
        found.append(json.loads(done.stdout))
    seconds, memory_mb = np.min(found, axis=0)
    return float(seconds), float(memory_mb)


def many(folder: Path, bars: int, tries: int) -> list[str]:
    """Rows of the page about so many bars."""
    study = write(folder / f"bars-{bars}", bars)
    out = folder / f"out-{bars}"
    command = [sys.executable, "-m", "ulna", "calibrate", str(study), "-o", str(out), "--force"]
    spent, memory_mb = process(*command, tries=tries)
    alone = fit_s(Study.load(study), tries)
    named = f"{bars:,}".replace(",", " ")
    written_mb = sum(path.stat().st_size for path in out.iterdir()) / 1e6
    return [
        f"| {named} bars: the core's fit | {alone:.3g} s | 1 |",
        f"| {named} bars: `ulna calibrate`, {memory_mb:.0f} MB of memory, {written_mb:.1f} MB written "
        f"| {spent:.3g} s | {spent / alone:.2f} |",
    ]


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.front", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few bars, nothing written")
    parser.add_argument("--million", action="store_true", help="10⁶ bars too")
    arguments = parser.parse_args()
    study = study_of_lengths(101)
    core_s = fit_s(study, 300)
    front_s = best_s(lambda: ulna.calibrate(study), 300)
    read_s = best_s(lambda: replace(ulna.calibrate(study)), 30)  # makes every table and figure
    loaded_s, _ = process(sys.executable, "-c", "import numpy, polars", tries=7)
    command = [sys.executable, "-m", "ulna", "calibrate", str(PLATINUM / "study.toml")]
    whole_s, memory_mb = process(*command, tries=7)
    rows = [
        f"| 101 lengths: the core's fit | {core_s * 1e3:.3g} ms | 1 |",
        f"| 101 lengths: `ulna.calibrate(study)` | {front_s * 1e3:.3g} ms | {front_s / core_s:.2f} |",
        f"| 101 lengths: the same, and all that it says is read | {read_s * 1e3:.3g} ms | {read_s / core_s:.2f} |",
        f"| a process that imports NumPy and Polars | {loaded_s:.3g} s | 1 |",
        f"| 101 bars: `ulna calibrate study.toml`, {memory_mb:.0f} MB | {whole_s:.3g} s | {whole_s / loaded_s:.2f} |",
    ]
    with tempfile.TemporaryDirectory() as folder:
        rows += many(Path(folder), 10_000 if arguments.quick else 100_000, tries=1 if arguments.quick else 2)
        if arguments.million:
            rows += many(Path(folder), 1_000_000, tries=1)
    machine = ", ".join(describe().values())
    text = "\n".join(
        [
            "<!-- Generated by `python -m benchmarks.front`; do not edit. -->",
            "",
            "| what | time | of the row with 1 above it |",
            "|---|---:|---:|",
            *rows,
            "",
            f"On {machine}; {os.cpu_count()} threads.",
            "",
        ]
    )
    print(text)
    if not arguments.quick:
        PAGE.write_text(text, encoding="utf-8")
        print(f"written: {PAGE}", file=sys.stderr)


if __name__ == "__main__":
    main()
