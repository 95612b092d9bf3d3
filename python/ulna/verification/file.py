"""Verify files: `ulna-verify/1`, TOML: an acceptance test as it was measured."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ulna.arm.arm import Arm
from ulna.arm.file import arm_toml, result_file
from ulna.arm.given import ArmLike, as_arm
from ulna.formats.models import check_kind, fill
from ulna.formats.toml import check_format, read_toml
from ulna.formats.toml import sha256 as digest
from ulna.ground.errors import UlnaInputError, nearest
from ulna.verification.bench import Bench
from ulna.verification.budget import Surroundings
from ulna.verification.certified import ARTEFACTS
from ulna.verification.profile import Profile, load_profile
from ulna.verification.tables import State, VerifyFile
from ulna.verification.touches import Setting, Touches, read_touches

WHAT = 'a verify file (TOML, format = "ulna-verify/1")'


@dataclass(frozen=True)
class StatedArm:
    """The arm that turns encoder readings into points."""

    arm: Arm
    path: Path
    sha256: str

    @classmethod
    def load(cls, path: Path) -> StatedArm:
        """From an arm file or a result. Raises UlnaInputError."""
        path = result_file(path)
        arm, sha256 = Arm.load_and_hash(path)
        return cls(arm, path, sha256)

    @classmethod
    def of(cls, given: ArmLike) -> StatedArm:
        """However it is given; one in memory is known by what its arm file would say. Raises UlnaInputError."""
        if isinstance(given, str | os.PathLike):
            return cls.load(Path(given))
        arm = as_arm(given)
        return cls(arm, Path(f"arm '{arm.name}'"), digest(arm_toml(arm).encode()))


@dataclass(frozen=True)
class VerifyPlan:
    """A verify file with all that it names, read."""

    path: Path
    sha256: str
    file: VerifyFile
    profile: Profile
    arms: list[StatedArm]
    """Those that turned encoder readings into points; that of the command first."""
    touches: dict[State, list[Touches]]
    """State → files."""
    warnings: list[str]

    @property
    def bench(self) -> Bench:
        """What the tests stand on, mm."""
        mm, temperature, fixture = self.file.units.mm, self.file.temperature, self.file.fixture
        surroundings = Surroundings(
            None if temperature is None else temperature.value,
            None if temperature is None else temperature.u,
            None if fixture is None else fixture.u * mm,
        )
        range_mm = None if self.file.range is None else self.file.range * mm
        return Bench(self.path, self.file.artefact, mm, surroundings, range_mm)


def load_verify(path: Path, given: ArmLike | None = None) -> VerifyPlan:
    """Read a verify file, its profile and its readings. Raises UlnaInputError."""
    document, sha256 = read_toml(path, WHAT)
    check_format(document, path, "ulna-verify")
    check_artefacts(document, path)
    file = fill(VerifyFile, document, path)
    profile = load_profile(file.profile, path.parent, f"{path}: key 'profile'")
    arms: dict[Path, StatedArm] = {}
    arm_path = None
    if given is not None:
        stated = StatedArm.of(given)
        arm_path, arms[stated.path] = stated.path, stated
    remarks: list[str] = []
    temperature_c = None if file.temperature is None else file.temperature.value
    setting = Setting(path, file.units, None if file.ball is None else file.ball * file.units.mm, temperature_c)
    found: dict[State, list[Touches]] = {}
    used = set()
    for number, entry in enumerate(file.readings, start=1):
        own = arm_path if entry.arm is None else path.parent / entry.arm
        if own is not None and own not in arms:
            arms[own] = StatedArm.load(own)
        reader = None if own is None else arms[own]
        touches = read_touches(
            path.parent / entry.file,
            entry,
            f"readings.{number}",
            setting,
            None if reader is None else reader.arm,
            None if reader is None else own,
            remarks,
        )
        if touches.source == "encoders" and reader is not None:
            used.add(own)
            touches = replace(touches, arm_sha256=reader.sha256)
        check_labels(touches, file, profile, path)
        found.setdefault(entry.state, []).append(touches)
    remarks += [f"{each}: the arm is not used: its readings are coordinates." for each in arms if each not in used]
    return VerifyPlan(path, sha256, file, profile, list(arms.values()), found, remarks)


def check_artefacts(document: dict[str, Any], path: Path) -> None:
    """Whether all are of a known kind. Raises UlnaInputError."""
    artefacts = document.get("artefact")
    for name, table in artefacts.items() if isinstance(artefacts, dict) else ():
        check_kind(table, f"artefact.{name}", list(ARTEFACTS), path)


def check_labels(touches: Touches, file: VerifyFile, profile: Profile, path: Path) -> None:
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
