"""Under what circumstances the readings were taken, as far as they say it themselves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ulna.study.study import Study


@dataclass(frozen=True)
class Environment:
    """Under what circumstances."""

    temperature_c: tuple[float, float, float] | None
    """Lowest, mean and highest of the readings; None where the readings do not say."""
    encoder_rad: list[float] | None
    """Stated standard deviation of each encoder."""
    seat_mm: float | None
    """Stated standard deviation of a touch, per coordinate."""


def environment(made: Mapping[str, Any], study: Study | None) -> Environment:
    """made: the result's provenance."""
    noise = made.get("noise") or {}
    warm = [] if study is None else [group.temperature_c for group in study.readings if group.temperature_c is not None]
    known = np.concatenate([each[np.isfinite(each)] for each in warm]) if warm else np.zeros(0)
    spread = (float(known.min()), float(known.mean()), float(known.max())) if len(known) else None
    return Environment(spread, noise.get("encoder_rad"), noise.get("seat_mm"))
