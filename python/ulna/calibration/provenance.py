"""From what, with what and when a result was made."""

from __future__ import annotations

import dataclasses
from datetime import datetime
from typing import Any

from ulna.ground.version import VERSION
from ulna.study.data import Noise
from ulna.study.study import Study


def provenance(study: Study, when: datetime, seconds: float | None = None) -> dict[str, Any]:
    """Program version, input files with SHA-256, which rows where there is a split, options, noise, seed, time; JSON
    types only."""
    options = dataclasses.asdict(study.fit)
    noise = None if study.noise is None else stated_noise(study.noise)
    return {
        "program": "ulna",
        "version": VERSION,
        "study": None if study.path is None else str(study.path),
        **({} if study.rows is None else {"rows": study.rows}),
        "files": [{"path": str(file.path), "sha256": file.sha256, "rows": file.rows} for file in study.files],
        "options": options,
        "seed": options["seed"],
        "noise": noise,
        "warnings": list(study.warnings),
        "time": when.isoformat(timespec="seconds"),
        **({} if seconds is None else {"duration_s": round(seconds, 6)}),
    }


def stated_noise(noise: Noise) -> dict[str, Any]:
    """As results have it."""
    encoder_rad = noise.encoder_rad
    return {"encoder_rad": None if encoder_rad is None else encoder_rad.tolist(), "seat_mm": noise.seat_mm}
