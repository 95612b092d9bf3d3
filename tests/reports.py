"""What the tests of reports share: small calibrations on disk, their names as hostile as wanted."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import polars as pl
from tests.cli_runs import platinum

import ulna

HOSTILE = (
    "<script>alert(1)</script>",
    "</script><img src=x onerror=alert(2)>",
    "<!-- --> & \"quotes\" 'single'",
    "ذراع القياس",
    "\u202eevil\u202c",
)


def seats_study(
    folder: Path, names: tuple[str, ...] = ("here", "there"), arm: str = "platinum", more: str = ""
) -> Path:
    """Seats touched many times each, in several placements, with one touch far off."""
    rng = np.random.default_rng(5)
    truth = platinum()
    limits = np.tile([-3.0, 3.0], (7, 1))
    columns: dict[str, list[object]] = {f"q{k}": [] for k in range(1, 8)} | {"placement": [], "temperature": []}
    for number, name in enumerate(names):
        at = np.tile(rng.uniform([-300, -300, 0], [300, 300, 600]), (40, 1)) + rng.normal(0, 0.02, (40, 3))
        at[7] += [0.0, 0.9, 0.0] if number == 0 else [0.0, 0.0, 0.0]
        q, reached = truth.core.pose_for_points(np.ascontiguousarray(at), limits, 11 + number)
        for row in q[reached].tolist():
            for k, angle in enumerate(row, start=1):
                columns[f"q{k}"].append(angle)
            columns["placement"].append(name)
            columns["temperature"].append(20.0 + number)
    folder.mkdir(parents=True, exist_ok=True)
    pl.DataFrame(columns).write_csv(folder / "touches.csv")
    truth.save(folder / "start.toml", force=True)
    text = (folder / "start.toml").read_text(encoding="utf-8")
    quoted = arm.replace("\\", "\\\\").replace('"', '\\"')
    named = re.sub(r"^name = .*$", lambda _: f'name = "{quoted}"', text, count=1, flags=re.M)
    (folder / "start.toml").write_text(named, encoding="utf-8")
    (folder / "study.toml").write_text(
        'format = "ulna-study/1"\narm = "start.toml"\nunits = { length = "mm", angle = "rad" }\n'
        '[[readings]]\nfile = "touches.csv"\nartefact = "cone"\n[artefact.cone]\nkind = "seat"\n'
        f'[fit]\nfree = ["joint.*.theta0"]\nhold = ["joint.1.theta0"]\n{more}',
        encoding="utf-8",
    )
    return folder / "study.toml"


def calibrated(study: Path) -> Path:
    """Its result.json, in a folder beside it."""
    out = study.parent / "out"
    ulna.calibrate(ulna.Study.load(study)).save(out, force=True)
    return out / "result.json"
