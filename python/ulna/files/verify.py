"""Verify files: `ulna-verify/1`, TOML: an acceptance test as it was measured."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ulna.errors import UlnaInputError, nearest
from ulna.files.arm import load_arm_and_hash
from ulna.files.models import fill
from ulna.files.profile import Profile, load_profile
from ulna.files.toml import check_format, read_toml
from ulna.files.touches import Setting, Touches, read_touches
from ulna.files.verify_tables import ARTEFACT_KINDS, VerifyFile
from ulna.model import Arm

WHAT = 'a verify file (TOML, format = "ulna-verify/1")'


@dataclass(frozen=True)
class StatedArm:
    """The arm that turns encoder readings into points."""

    arm: Arm
    path: Path
    sha256: str


@dataclass(frozen=True)
class VerifyPlan:
    """A verify file with all that it names, read."""

    path: Path
    sha256: str
    file: VerifyFile
    profile: Profile
    arm: StatedArm | None
    touches: dict[str, list[Touches]]
    """State → files."""
    warnings: list[str]


def load_verify(path: Path, arm_path: Path | None = None) -> VerifyPlan:
    """Read a verify file, its profile and its readings. Raises UlnaInputError."""
    document, sha256 = read_toml(path, WHAT)
    check_format(document, path, "ulna-verify")
    _check_kinds(document, path)
    file = fill(VerifyFile, document, path)
    profile = load_profile(file.profile, path.parent, f"{path}: key 'profile'")
    arm = None
    if arm_path is not None:
        loaded, digest = load_arm_and_hash(arm_path)
        arm = StatedArm(loaded, arm_path, digest)
    remarks: list[str] = []
    temperature_c = None if file.temperature is None else file.temperature.value
    ball_mm = None if file.ball is None else file.ball * file.units.mm
    setting = Setting(path, file.units, ball_mm, temperature_c)
    found: dict[str, list[Touches]] = {}
    for number, entry in enumerate(file.readings, start=1):
        touches = read_touches(
            entry, number, setting, None if arm is None else arm.arm, None if arm is None else arm.path, remarks
        )
        _check_labels(touches, file, profile, path)
        found.setdefault(entry.state, []).append(touches)
    if arm is not None and all(each.source == "xyz" for parts in found.values() for each in parts):
        remarks.append(f"{arm_path}: the arm is not used: all readings are coordinates.")
    return VerifyPlan(path, sha256, file, profile, arm, found, remarks)


def _check_kinds(document: dict[str, Any], path: Path) -> None:
    artefacts = document.get("artefact")
    for name, table in artefacts.items() if isinstance(artefacts, dict) else ():
        kind = table.get("kind") if isinstance(table, dict) else None
        if isinstance(table, dict) and kind not in ARTEFACT_KINDS:
            raise UlnaInputError(
                f"{path}: key 'artefact.{name}.kind': got {kind!r}, expected ball or length."
                f"{nearest(str(kind), ARTEFACT_KINDS)} Correct it."
            )


def _check_labels(touches: Touches, file: VerifyFile, profile: Profile, path: Path) -> None:
    """Every test and artefact that rows name must be known; a test may be left out where there is one."""
    tests = list(profile.file.test)
    if len(tests) == 1:
        column = touches.labels["test"]
        column[column == ""] = tests[0]
    for name, known, owner, needed in (
        ("test", tests, f"profile '{profile.file.name}'", True),
        ("artefact", list(file.artefact), str(path), False),
    ):
        for k, label in enumerate(touches.labels[name].tolist()):
            if label in known or (label == "" and not needed):
                continue
            if label == "":
                raise UlnaInputError(
                    f"{touches.path}: row {touches.row[k]}: which test it belongs to is not said; expected one of "
                    f"{', '.join(tests)} in the column 'test', or as the key 'readings.test' of {path}. Add it."
                )
            raise UlnaInputError(
                f"{touches.path}: row {touches.row[k]}, column '{name}': got '{label}', which {owner} does not have."
                f"{nearest(label, known)} Correct the cell, or add the {name}."
            )
