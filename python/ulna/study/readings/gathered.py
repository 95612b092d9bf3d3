"""The readings of all tables of a study, artefact by artefact, checked as a whole."""

from __future__ import annotations

from pathlib import Path

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import InputFile, Readings
from ulna.formats.rows import Rows
from ulna.study.readings.checks import check_limits, check_repeats
from ulna.study.readings.merge import merge
from ulna.study.readings.own_points import has_own_points


def gathered(
    parts: list[Readings],
    label: Path,
    arm: Arm,
    artefacts: dict[str, Artefact],
    files: list[InputFile],
    remarks: list[str],
    rows: Rows,
) -> list[Readings]:
    """One for each artefact that was touched. label: how messages call the study; remarks are added to. Raises
    UlnaInputError."""
    groups = merge(parts, artefacts, files, label)
    for name in artefacts:
        if rows != "check" and all(group.artefact.name != name for group in groups):
            remarks.append(f"{label}: key 'artefact.{name}': no reading touches this artefact.")
    for group in groups:
        kind_of(group.artefact).check_readings(group, files, label)
        check_repeats(group, files, remarks, own_points=has_own_points(artefacts[group.artefact.name]))
        check_limits(group, arm, files, remarks)
    return groups
