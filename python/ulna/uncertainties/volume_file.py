"""Volume files: `ulna-volume/1`, TOML: where, and of what lengths, a map of the uncertainty is asked for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from ulna.arm.arm import Arm
from ulna.arm.stated import Box, TravelTable, VolumeTable, travel_of, volume_of
from ulna.formats.models import Strict, fill
from ulna.formats.numbers import Coverage, Positive
from ulna.formats.toml import check_format, read_toml
from ulna.formats.units import Units
from ulna.ground.arrays import F64
from ulna.study.data import Noise
from ulna.study.file import noise_of_table
from ulna.study.readings.checks import named_probe
from ulna.study.readings.payloads import check_carried
from ulna.study.tables import NoiseTable
from ulna.uncertainties.task_file import WHAT as WHAT_TASK
from ulna.uncertainties.task_file import TemperatureTable, check_temperature

WHAT = 'a volume file (TOML, format = "ulna-volume/1")'

Count = Annotated[int, Field(ge=100, le=1_000_000)]


class VolumeFile(Strict):
    """A map of the uncertainty of points and lengths."""

    format: Literal["ulna-volume/1"]
    units: Units
    probe: str | None = None
    """Which probe is on, where the arm has several."""
    lengths: Annotated[list[Positive], Field(min_length=1, max_length=20)] | None = None
    """Five from a tenth to 1.3 of the arm's reach where they are not given."""
    points: Count = 20_000
    """How many points are looked at."""
    bars: Count = 2000
    """How many places of each length."""
    volume: VolumeTable | None = None
    """Where; all that the arm reaches where it is not given."""
    travel: TravelTable | None = None
    """How far joints turn, where the arm has no limits or they shall turn less."""
    noise: NoiseTable | None = None
    """In place of what the calibration's study stated."""
    temperature: TemperatureTable | None = None
    payload: str | None = None
    """What is carried: the name of a [payload] of the arm, or "none"."""
    p: Coverage = 0.95
    """Coverage probability."""


@dataclass(frozen=True)
class StatedVolume:
    """The same in rad and mm."""

    path: Path
    file: VolumeFile
    probe: str
    lengths_mm: tuple[float, ...] | None
    box_mm: Box | None
    travel_rad: F64 | None
    """(n, 2)"""
    noise: Noise | None


def is_volume(path: Path) -> bool:
    """Whether a file says that it is one. Raises UlnaInputError where it cannot be read."""
    document, _ = read_toml(path, f"{WHAT_TASK}, or {WHAT}")
    return str(document.get("format", "")).startswith("ulna-volume")


def read_volume(path: Path, arm: Arm) -> StatedVolume:
    """Raises UlnaInputError."""
    document, _ = read_toml(path, WHAT)
    check_format(document, path, "ulna-volume")
    file = fill(VolumeFile, document, path)
    check_temperature(file.temperature, arm, path)
    check_carried(file.payload, arm, f"{path}: key 'payload'")
    units = file.units
    return StatedVolume(
        path=path,
        file=file,
        probe=named_probe(file.probe, arm, path),
        lengths_mm=None if file.lengths is None else tuple(sorted({length * units.mm for length in file.lengths})),
        box_mm=volume_of(file.volume, units, path),
        travel_rad=travel_of(file.travel, arm, units, path),
        noise=noise_of_table(file.noise, units, arm, path),
    )
