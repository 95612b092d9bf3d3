"""A protocol with one table of readings is an acceptance test: here it becomes the plan of one, which is evaluated."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from ulna.checking.tables import ProtocolFile
from ulna.formats.models import fill
from ulna.formats.toml import check_format, read_toml
from ulna.ground.errors import UlnaInputError
from ulna.verification.file import StatedArm, VerifyPlan, check_artefacts, check_labels
from ulna.verification.profile import Profile, check_counts, check_tests
from ulna.verification.profile_tables import ProfileFile
from ulna.verification.tables import VerifyFile, VerifyReadings
from ulna.verification.touches import Setting, read_touches

WHAT = 'a protocol (TOML, format = "ulna-protocol/1")'


@dataclass(frozen=True)
class Protocol:
    """What is touched, and where that was read."""

    file: ProtocolFile
    path: Path
    sha256: str


def load_protocol(path: Path) -> Protocol:
    """Raises UlnaInputError."""
    document, sha256 = read_toml(path, WHAT)
    check_format(document, path, "ulna-protocol")
    check_tests(document, path)
    check_artefacts(document, path)
    file = fill(ProtocolFile, document, path)
    check_counts(file.test, path)
    if file.control.baseline < file.control.fewest:
        raise UlnaInputError(
            f"{path}: key 'control.baseline': got {file.control.baseline}, expected at least 'control.fewest', "
            f"{file.control.fewest}. Correct one of them."
        )
    return Protocol(file, path, sha256)


def plan_of(protocol: Protocol, readings: Path) -> VerifyPlan:
    """The readings of one check, as a test of the protocol's. Raises UlnaInputError."""
    path, file = protocol.path, protocol.file
    reader = None if file.arm is None else StatedArm.load(path.parent / file.arm)
    setting = Setting(
        path,
        file.units,
        None if file.ball is None else file.ball * file.units.mm,
        None if file.temperature is None else file.temperature.value,
        arm_by=f"expected the key 'arm' in {path}. Add it",
        table="[readings]",
    )
    remarks: list[str] = []
    touches = read_touches(
        readings,
        file.readings,
        "readings",
        setting,
        None if reader is None else reader.arm,
        None if reader is None else reader.path,
        remarks,
    )
    arms = []
    if touches.source == "encoders" and reader is not None:
        touches, arms = replace(touches, arm_sha256=reader.sha256), [reader]
    test = VerifyFile(
        format="ulna-verify/1",
        profile=file.name,
        units=file.units,
        arm=file.item or (None if reader is None else reader.arm.name),
        ball=file.ball,
        artefact=file.artefact,
        temperature=file.temperature,
        fixture=file.fixture,
        readings=[VerifyReadings(file=str(readings))],
    )
    profile = ProfileFile(
        format="ulna-profile/1",
        name=file.name,
        standard="",
        statement=f"Check by the protocol '{file.name}'.",
        decision=file.decision,
        test=file.test,
        unit=file.units.length,
        limit=file.limit,
    )
    plan = VerifyPlan(
        path,
        protocol.sha256,
        test,
        Profile(profile, path, protocol.sha256),
        arms,
        {"as-found": [touches]},
        remarks,
    )
    check_labels(touches, test, plan.profile, path)
    return plan
