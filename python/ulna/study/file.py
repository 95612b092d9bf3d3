"""Study files: `ulna-study/1`, TOML: what to fit to what."""

from __future__ import annotations

import warnings as python_warnings
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import numpy as np
from pydantic import Discriminator, Field, Tag

from ulna.arm.effects.effects import Extra
from ulna.arm.file import load_arm_and_hash
from ulna.arm.model import Arm
from ulna.artefacts.kinds import ArtefactTable, check_kinds, make_artefact
from ulna.formats.models import Strict, fill
from ulna.formats.rows import Rows
from ulna.formats.toml import check_format, read_toml
from ulna.formats.units import Units
from ulna.ground.errors import InputWarning, UlnaInputError, nearest
from ulna.study.data import Artefact, FitOptions, InputFile, Loss, Method, Noise, Prior, Readings, Study
from ulna.study.options import with_options
from ulna.study.parameters import check_patterns
from ulna.study.readings.checks import check_bar_ends, check_limits, check_repeats
from ulna.study.readings.columns import ReadingsEntry, Source
from ulna.study.readings.merge import merge
from ulna.study.readings.own_points import has_own_points
from ulna.study.readings.readings import read_readings

WHAT = 'a study file (TOML, format = "ulna-study/1")'

Positive = Annotated[float, Field(gt=0)]


def _noise_kind(encoder: Any) -> str:
    return "<each>" if isinstance(encoder, list) else "<all>"


class NoiseTable(Strict):
    """Standard deviations of the readings."""

    encoder: (
        Annotated[
            Annotated[Positive, Tag("<all>")] | Annotated[list[Positive], Tag("<each>")], Discriminator(_noise_kind)
        ]
        | None
    ) = None
    """In the study's angle unit; one number, or one per joint."""
    seat: Positive | None = None
    """Of a touch, per coordinate, in the study's length unit."""


class PriorTable(Strict):
    """What is known of parameters before any reading."""

    value: float | None = None
    """The arm file's, or the artefact's, where it is not given."""
    u: Positive
    """Standard deviation."""


def _prior_kind(prior: Any) -> str:
    return "<table>" if isinstance(prior, dict | PriorTable) else "<deviation>"


PriorValue = Annotated[
    Annotated[Positive, Tag("<deviation>")] | Annotated[PriorTable, Tag("<table>")], Discriminator(_prior_kind)
]


class FitTable(Strict):
    """What is fitted, and how."""

    hold: list[str] = Field(default_factory=list)
    """Not fitted: shell-style patterns over parameter names."""
    free: list[str] = Field(default_factory=lambda: ["*"])
    """What may be fitted; hold wins."""
    loss: Loss = "none"
    """How residuals count that are far off: by their squares (none), or less."""
    start: Literal["given", "search"] = "given"
    """"search": the zero offsets are not known, find them."""
    extras: list[Extra] = Field(default_factory=list)
    """Blocks of the model beyond geometry; each is judged by readings left out."""
    harmonics: list[Annotated[int, Field(ge=1, le=100)]] = Field(default_factory=lambda: [1, 2], min_length=1)
    """Orders of the encoders' harmonics, where extras ask for them."""
    prior: dict[str, PriorValue] = Field(default_factory=dict)
    """Pattern of parameter names = standard deviation around the arm file's value, or { value, u }, in the study's
    units."""
    judge_extras: bool = True
    """Whether extras are judged by cross-validation; false saves its time."""
    method: Method = "lm"
    """"annealing" or "evolution": first a search of a box around the start without derivatives."""
    budget: Annotated[int, Field(ge=100, le=1_000_000_000)] = 100_000
    """Most evaluations of the sum of squares in that search."""
    box_length: Positive | None = None
    """Half the width of the box for lengths (default 100 mm)."""
    box_angle: Positive | None = None
    """For twists (default 0.2 rad)."""
    box_offset: Positive | None = None
    """For zero offsets (default 1 rad; with start "search" the whole turn)."""
    seed: Annotated[int, Field(ge=0, le=2**63 - 1)] = 0
    max_iterations: Annotated[int, Field(ge=1, le=1_000_000)] = 200
    known_length: Positive | None = None
    """How well lengths are known before any reading (default 1 mm); worse-determined parameters are called weak."""
    known_angle: Positive | None = None
    """The same for angles (default 0.01 rad)."""


class StudyFile(Strict):
    """What to fit to what: `ulna-study/1`."""

    format: Literal["ulna-study/1"]
    arm: str
    """Path of the arm file, relative to the study file."""
    units: Units
    readings: Annotated[list[ReadingsEntry], Field(min_length=1)]
    artefact: Annotated[dict[str, ArtefactTable], Field(min_length=1)]
    noise: NoiseTable | None = None
    fit: FitTable = FitTable()


def load_study(path: Path, rows: Rows = "fit") -> Study:
    """Read a study and all that it names. Raises UlnaInputError for the first thing that cannot be used.

    rows: of files with the key `split` those to fit, those to check, or both; a file without it is there to fit.

    What can be used with a remark is in `Study.warnings`, and is issued as InputWarning.
    """
    document, digest = _document(path)
    file = fill(StudyFile, document, path)
    split = _check_rows(file, path, rows)
    arm_path = path.parent / file.arm
    arm, arm_digest = load_arm_and_hash(arm_path)
    fit = _fit(file.fit, file.units)
    noise = noise_of_table(file.noise, file.units, arm, path)
    remarks: list[str] = []
    files = [InputFile(path, digest, 0), InputFile(arm_path, arm_digest, 0)]
    artefacts: dict[str, Artefact] = {}
    for name, table in file.artefact.items():
        artefacts[name], features_file = make_artefact(name, table, file.units, path, remarks)
        if features_file is not None:
            files.append(features_file)
    readings = _readings(file, path, arm, arm_path, artefacts, files, remarks, rows)
    study = Study(path, arm, readings, noise, fit, files, remarks, rows if split else None)
    with_options(study)  # what cannot be asked is told now, not after the work
    check_patterns(study)
    for remark in remarks:
        python_warnings.warn(remark, InputWarning, stacklevel=3)
    return study


def rows_to_judge(path: Path) -> Rows:
    """The rows with which an arm is judged where nobody says otherwise: those to check where the study has a split,
    else all. Raises UlnaInputError."""
    file = fill(StudyFile, _document(path)[0], path)
    return "check" if any(entry.split is not None for entry in file.readings) else "all"


def _document(path: Path) -> tuple[dict[str, Any], str]:
    document, digest = read_toml(path, WHAT)
    check_format(document, path, "ulna-study")
    check_kinds(document, path)
    return document, digest


def _check_rows(file: StudyFile, path: Path, rows: str) -> bool:
    """Whether the study has a split. Raises UlnaInputError for rows that it does not tell apart."""
    split = any(entry.split is not None for entry in file.readings)
    if rows not in get_args(Rows):
        raise UlnaInputError(f"{path}: rows '{rows}'; expected fit, check or all.{nearest(rows, get_args(Rows))}")
    if rows == "check" and not split:
        raise UlnaInputError(
            f"{path}: the rows to check were asked for, but no [[readings]] has the key 'split'; expected, say, "
            'split = { column = "set", fit = "train", check = "test" }. Add it, or ask for all rows.'
        )
    return split


def _readings(
    file: StudyFile,
    path: Path,
    arm: Arm,
    arm_path: Path,
    artefacts: dict[str, Artefact],
    files: list[InputFile],
    remarks: list[str],
    rows: Rows,
) -> list[Readings]:
    parts: list[Readings] = []
    for number, entry in enumerate(file.readings, start=1):
        if rows == "check" and entry.split is None:
            continue
        source = Source(path, f"readings.{number}", entry, len(files), arm_path)
        read, used = read_readings(source, arm, artefacts, file.units, remarks, rows)
        files.append(used)
        parts += read
    groups = merge(parts, artefacts, files, path)
    for name in artefacts:
        if rows != "check" and all(group.artefact.name != name for group in groups):
            remarks.append(f"{path}: key 'artefact.{name}': no reading touches this artefact.")
    for group in groups:
        check_bar_ends(group, files, path)
        check_repeats(group, files, remarks, own_points=has_own_points(artefacts[group.artefact.name]))
        check_limits(group, arm, files, remarks)
    return groups


def noise_of_table(table: NoiseTable | None, units: Units, arm: Arm, path: Path) -> Noise | None:
    """What a file states of noise, in rad and mm. Raises UlnaInputError."""
    if table is None or (table.encoder is None and table.seat is None):
        return None
    encoder_rad = None
    if table.encoder is not None:
        each = table.encoder if isinstance(table.encoder, list) else [table.encoder] * arm.n
        if len(each) != arm.n:
            raise UlnaInputError(
                f"{path}: key 'noise.encoder': got {len(each)} numbers, expected one, or {arm.n}: one per joint of arm "
                f"'{arm.name}'. Correct it."
            )
        encoder_rad = np.array(each) * units.rad
    return Noise(encoder_rad, None if table.seat is None else table.seat * units.mm)


def _fit(table: FitTable, units: Units) -> FitOptions:
    usual = FitOptions()

    def prior(given: float | PriorTable) -> Prior:
        u, value = (given.u, given.value) if isinstance(given, PriorTable) else (given, None)
        return Prior(u, value, units.mm, units.rad)

    def mm(given: float | None, usually: float) -> float:
        return usually if given is None else given * units.mm

    def rad(given: float | None, usually: float) -> float:
        return usually if given is None else given * units.rad

    return FitOptions(
        hold=list(table.hold),
        free=list(table.free),
        loss=table.loss,
        start=table.start,
        extras=list(table.extras),
        harmonics=list(table.harmonics),
        prior={pattern: prior(given) for pattern, given in table.prior.items()},
        judge_extras=table.judge_extras,
        method=table.method,
        budget=table.budget,
        box_length_mm=mm(table.box_length, usual.box_length_mm),
        box_angle_rad=rad(table.box_angle, usual.box_angle_rad),
        box_offset_rad=rad(table.box_offset, usual.box_offset_rad),
        seed=table.seed,
        max_iterations=table.max_iterations,
        known_length_mm=mm(table.known_length, usual.known_length_mm),
        known_angle_rad=rad(table.known_angle, usual.known_angle_rad),
    )
