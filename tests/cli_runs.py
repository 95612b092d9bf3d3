"""What the tests of the commands share: a virtual Platinum, studies of it on disk, and runs of the program."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from tests.warm import Warm, needs_fresh

from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.reproduce.cheng2011.arms import BENT_PROBE, TABLE_4

BENT = Probe.from_cylindrical(*BENT_PROBE)
STRAIGHT = Probe(0.0, 0.0, 238.5596)


def platinum(probes: dict[str, Probe] | None = None, wrong: float = 0.0) -> Arm:
    rng = np.random.default_rng(9)
    joints = [Joint(*(np.array(row) + wrong * rng.uniform(-1, 1, 4) * [0.02, 0.01, 5, 5])) for row in TABLE_4]
    return Arm("virtual Platinum", (*joints, Joint()), probes or {"bent": BENT})


def write_lengths(
    folder: Path, rows: int = 101, probes: dict[str, Probe] | None = None, noise: str = "", fit: str = ""
) -> Path:
    """A study of length rows in two placements, its start arm a little wrong."""
    rng = np.random.default_rng(2)
    truth = platinum(probes)
    q, p = rng.uniform(-2.5, 2.5, (2, rows, 7))
    probe = next(iter(truth.probes))
    length = np.linalg.norm(truth.tip(q, probe) - truth.tip(p, probe), axis=1) + rng.normal(0, 0.01, rows)
    columns: dict[str, Any] = {f"q{k + 1}": q[:, k] for k in range(7)} | {f"p{k + 1}": p[:, k] for k in range(7)}
    columns |= {"length": length, "placement": np.where(np.arange(rows) % 2, "left", "right")}
    folder.mkdir(parents=True, exist_ok=True)
    pl.DataFrame(columns).write_csv(folder / "rows.csv")
    platinum(probes, wrong=1.0).save(folder / "start.toml", force=True)
    study = folder / "study.toml"
    study.write_text(
        'format = "ulna-study/1"\narm = "start.toml"\nunits = { length = "mm", angle = "rad" }\n'
        f'[[readings]]\nfile = "rows.csv"\nartefact = "rows"\nprobe = "{probe}"\n[artefact.rows]\nkind = "length"\n'
        f"{noise}\n[fit]\n{fit}\n"
    )
    return study


def run(*arguments: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """The program, as a process of its own: forked from one that has imported what it needs, where nothing it is asked
    depends on that."""
    env = {**os.environ, "COLUMNS": "80", "TERM": "dumb", **environment}
    warm = None if needs_fresh(env) else _warm()
    if warm is None or not warm.busy.acquire(blocking=False):
        return fresh(*arguments, **environment)
    try:
        return warm.run([*map(str, arguments)], env, 60)
    finally:
        warm.busy.release()


def fresh(*arguments: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """The same in a process that begins with nothing: what it takes and imports is what a user's does."""
    return subprocess.run(
        [sys.executable, "-m", "ulna", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=60,
        env=os.environ | {"COLUMNS": "80", "TERM": "dumb"} | environment,
        check=False,
    )


@cache
def _warm() -> Warm:
    return Warm()


def assert_bad_input(done: subprocess.CompletedProcess[str], *expected: str) -> None:
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    for each in expected:
        assert each in done.stderr


def strict_json(text: str) -> Any:
    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    return json.loads(text, parse_constant=refuse)
