"""Study files: `ulna-study/1`, TOML: what to fit to what."""

from __future__ import annotations

import warnings as python_warnings
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar, get_args

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.payload import joined_payloads, payloads_of
from ulna.arm.stated import check_alike
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import check_kinds, made
from ulna.artefacts.lent import LentTable, stated
from ulna.artefacts.readings import InputFile, Readings
from ulna.artefacts.tables import Place
from ulna.formats.models import fill
from ulna.formats.rows import Rows
from ulna.formats.toml import check_format, read_toml
from ulna.formats.units import Units
from ulna.ground.errors import InputWarning, UlnaInputError, nearest
from ulna.study.data import AUTO, FitOptions, Noise, Prior, StudyData
from ulna.study.options import with_options
from ulna.study.parameters import check_patterns, remark_vain_payloads
from ulna.study.readings.columns import Source
from ulna.study.readings.gathered import gathered
from ulna.study.readings.payloads import check_carried
from ulna.study.readings.readings import read_readings
from ulna.study.tables import FitTable, NoiseTable, PriorTable, StudyFile

WHAT = 'a study file (TOML, format = "ulna-study/1")'


AnyStudy = TypeVar("AnyStudy", bound=StudyData)


def load_study(path: Path, rows: Rows, make: type[AnyStudy]) -> AnyStudy:
    """Read a study and all that it names. Raises UlnaInputError for the first thing that cannot be used.

    rows: of files with the key `split` those to fit, those to check, or both; a file without it is there to fit.

    What can be used with a remark is in `Study.warnings`, and is issued as InputWarning.
    """
    document, digest = _document(path)
    file = fill(StudyFile, document, path)
    split = _check_rows(file, path, rows)
    study, artefacts = _stated(file, path, digest, make)
    arm, remarks = study.arm, study.warnings
    study.readings = _readings(file, path, arm, path.parent / file.arm, artefacts, study.files, remarks, rows)
    study.rows = rows if split else None
    remark_vain_payloads(study)
    with_options(study)  # what cannot be asked is told now, not after the work
    check_patterns(study)
    for remark in remarks:
        python_warnings.warn(remark, InputWarning, stacklevel=3)
    return study


def load_waiting(path: Path, make: type[AnyStudy]) -> AnyStudy:
    """A study of readings to come: all that it says beside them, and of each artefact none. Raises UlnaInputError."""
    document, digest = _document(path)
    study, artefacts = _stated(fill(StudyFile, document, path), path, digest, make)
    study.readings = [Readings.none(artefact, study.arm.n) for artefact in artefacts.values()]
    return study


def _stated(file: StudyFile, path: Path, digest: str, make: type[AnyStudy]) -> tuple[AnyStudy, dict[str, Artefact]]:
    """A study without its readings, and all artefacts that it knows. Raises UlnaInputError."""
    arm_path = path.parent / file.arm
    arm, arm_digest = Arm.load_and_hash(arm_path)
    payloads = joined_payloads(arm.payloads, payloads_of(file.payload, file.units, path), path)
    arm = replace(arm, payloads=payloads)
    check_carried(file.carried, arm, f"{path}: key 'carried'")
    fit = _fit(file.fit, file.units)
    noise = noise_of_table(file.noise, file.units, arm, path)
    remarks: list[str] = []
    files = [InputFile(path, digest, 0), InputFile(arm_path, arm_digest, 0)]
    artefacts: dict[str, Artefact] = {}
    place = Place(path, file.units, remarks, files)
    for name, table in file.artefact.items():
        artefacts[name] = made(name, stated(name, table, place), place)
        if isinstance(table, LentTable):
            artefacts[name] = replace(artefacts[name], record=table.record)
    return make(path, arm, [], noise, fit, files, remarks), artefacts


def study_file(path: Path) -> StudyFile:
    """The file alone, nothing that it names. Raises UlnaInputError."""
    return fill(StudyFile, _document(path)[0], path)


def rows_to_judge(path: Path) -> Rows:
    """The rows with which an arm is judged where nobody says otherwise: those to check where the study has a split,
    else all. Raises UlnaInputError."""
    file = study_file(path)
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
        source = Source(path, f"readings.{number}", entry, len(files), arm_path, file.carried)
        read, used = read_readings(source, arm, artefacts, file.units, remarks, rows)
        files.append(used)
        parts += read
    return gathered(parts, path, arm, artefacts, files, remarks, rows)


def noise_of_table(table: NoiseTable | None, units: Units, arm: Arm, path: Path) -> Noise | None:
    """What a file states of noise, in rad and mm. Raises UlnaInputError."""
    if table is None or (table.encoder is None and table.seat is None):
        return None
    encoder_rad = None
    if table.encoder is not None:
        check_alike(not isinstance(table.encoder, list), arm, "noise.encoder", path, "in the unit of lengths")
        each = table.encoder if isinstance(table.encoder, list) else [table.encoder] * arm.n
        if len(each) != arm.n:
            raise UlnaInputError(
                f"{path}: key 'noise.encoder': got {len(each)} numbers, expected one, or {arm.n}: one per joint of arm "
                f"'{arm.name}'. Correct it."
            )
        encoder_rad = np.array(each) * arm.each(units.rad, units.mm)
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
        extras=table.extras if isinstance(table.extras, list) else [],
        auto=table.extras == AUTO,
        harmonics=list(table.harmonics),
        prior={pattern: prior(given) for pattern, given in table.prior.items()},
        judge_extras=table.judge_extras,
        judge=table.judge,
        method=table.method,
        budget=table.budget,
        box_length_mm=mm(table.box_length, usual.box_length_mm),
        box_angle_rad=rad(table.box_angle, usual.box_angle_rad),
        box_offset_rad=rad(table.box_offset, usual.box_offset_rad),
        seed=table.seed,
        max_iterations=table.max_iterations,
        known_length_mm=mm(table.known_length, usual.known_length_mm),
        known_angle_rad=rad(table.known_angle, usual.known_angle_rad),
        poor_above_mm=None if table.poor_above is None else table.poor_above * units.mm,
    )
