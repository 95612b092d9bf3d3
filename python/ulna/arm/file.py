"""Arm files: `ulna-arm/1`, TOML. Also the arm inside a `result.json`."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any, TypeVar

from ulna.arm.covariance_file import covariance_of_result
from ulna.arm.data import ArmData
from ulna.arm.frames.modified import from_modified
from ulna.arm.joint_file import joint_document, joint_of
from ulna.arm.modified_file import check_modified
from ulna.arm.parameters_file import check_parameters
from ulna.arm.payload import payload_documents, payloads_of
from ulna.arm.probe import Probe
from ulna.arm.tables import ArmFile, CylindricalTip, ProbeTable
from ulna.formats.models import fill
from ulna.formats.names import check_name
from ulna.formats.output import write_file
from ulna.formats.toml import check_format, read_json, read_toml
from ulna.formats.toml_text import toml_key, toml_value
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError

WHAT = 'an arm file (TOML, format = "ulna-arm/1") or a result.json'
RESULT = "result.json"


AnyArm = TypeVar("AnyArm", bound=ArmData)


def result_file(path: Path) -> Path:
    """Of a folder with one the result.json in it; any other path as it is."""
    inside = path / RESULT
    return inside if path.is_dir() and inside.is_file() else path


def load_arm(path: Path, make: type[AnyArm]) -> tuple[AnyArm, str]:
    """Read an arm from an arm file, a result.json or the folder with one; and the file's SHA-256. Raises
    UlnaInputError."""
    path = result_file(path)
    if path.suffix.lower() == ".json":
        document, digest = read_json(path, WHAT)
        check_format(document, path, "ulna-result")
        return arm_of_result(document, path, make), digest
    document, digest = read_toml(path, WHAT)
    check_format(document, path, "ulna-arm")
    _check_tips(document, path)
    return _arm(fill(ArmFile, document, path), path, make), digest


def _check_tips(document: dict[str, Any], path: Path) -> None:
    """One point is written in one way: an extra key alone would be a riddle. Raises UlnaInputError."""
    probes = document.get("probe")
    for name, probe in probes.items() if isinstance(probes, dict) else ():
        tip = probe.get("tip") if isinstance(probe, dict) else None
        keys = set(tip) if isinstance(tip, dict) else set()
        if keys & {"x", "y", "z"} and keys & {"theta0", "r", "h"}:
            raise UlnaInputError(
                f"{path}: key 'probe.{name}.tip': got {', '.join(tip or ())}, two ways of writing a point mixed; "
                "expected x, y, z or theta0, r, h. Keep one of them."
            )


def arm_of_result(document: dict[str, Any], path: Path, make: type[AnyArm]) -> AnyArm:
    """The calibrated arm of a result document, with what is known of its parameters. Raises UlnaInputError."""
    # Only these three parts: the residuals of a large study need not be checked to use its arm.
    arm = document.get("arm")
    if not isinstance(arm, dict):
        raise UlnaInputError(f"{path}: key 'arm' is missing or no table; expected the calibrated arm. Calibrate again.")
    whole = {"format": "ulna-arm/1", "units": {"length": "mm", "angle": "rad"}, **arm}
    found = _arm(fill(ArmFile, whole, path), path, make)
    known = covariance_of_result(document, found, path)
    check_parameters(document, found, known, path)
    return dataclasses.replace(found, uncertainty=known.of(found.parameter_names))


def _arm(file: ArmFile, path: Path, make: type[AnyArm]) -> AnyArm:
    modified = file.convention == "modified-dh"
    if modified:
        check_modified(file, path)
    # in the modified form the last joint has geometry as well
    bare = 0 if modified or file.full_last_link else len(file.joint)
    joints = tuple(joint_of(table, k, k == bare, file.units, path) for k, table in enumerate(file.joint, start=1))
    probes = {name: _probe(name, table, file.units, path) for name, table in file.probe.items()}
    if modified:
        joints, probes, _ = from_modified(joints, probes)
    x, y, z = file.gravity or (0.0, 0.0, -1.0)
    if not (x or y or z):
        raise UlnaInputError(f"{path}: key 'gravity': got {file.gravity}, no direction; expected, say, [0, 0, -1].")
    arm = make(
        file.name or path.stem,
        joints,
        probes,
        full_last_link=file.full_last_link,
        gravity=(x, y, z),
        payloads=payloads_of(file.payload, file.units, path),
    )
    for effect in arm.effects:
        effect.check_joints([joint.effects for joint in joints], path, arm.heaviest_kg)
    return arm


def _probe(name: str, table: ProbeTable, units: Units, path: Path) -> Probe:
    check_name(name, f"probe.{name}", path)
    ball_mm = None if table.ball is None else table.ball * units.mm
    tip = table.tip
    if isinstance(tip, CylindricalTip):
        return Probe.from_cylindrical(tip.theta0 * units.rad, tip.r * units.mm, tip.h * units.mm, ball_mm)
    return Probe(tip.x * units.mm, tip.y * units.mm, tip.z * units.mm, ball_mm)


def arm_document(arm: ArmData) -> dict[str, Any]:
    """The arm with the keys of an arm file, in mm and rad, tips as x, y, z: the `arm` of a result.json."""
    bare = None if arm.full_last_link else arm.n - 1
    joints = [joint_document(joint, k == bare) for k, joint in enumerate(arm.joints)]
    probes: dict[str, Any] = {}
    for name, probe in arm.probes.items():
        probes[name] = {"tip": {"x": probe.x_mm, "y": probe.y_mm, "z": probe.z_mm}}
        if probe.ball_mm is not None:
            probes[name]["ball"] = probe.ball_mm
    head: dict[str, Any] = {"name": arm.name}
    if arm.full_last_link:
        head["full_last_link"] = True
    if arm.gravity != (0.0, 0.0, -1.0):
        head["gravity"] = list(arm.gravity)
    if arm.payloads:
        head["payload"] = payload_documents(arm.payloads)
    return {**head, "joint": joints, "probe": probes}


def arm_toml(arm: ArmData) -> str:
    """The text of an arm file, mm and rad; every number comes back exactly as it was. Raises UlnaInputError for an arm
    with numbers that its joints' models do not use: they have no place in the file."""
    _ = arm.core  # which refuses it
    document = arm_document(arm)
    lines = [
        'format = "ulna-arm/1"',
        f"name = {toml_value(arm.name)}",
        'units = { length = "mm", angle = "rad" }',
    ]
    lines += [f"{key} = {toml_value(document[key])}" for key in ("full_last_link", "gravity") if key in document]
    for name, table in document.get("payload", {}).items():
        lines += ["", f"[payload.{toml_key(name)}]", *(f"{key} = {toml_value(value)}" for key, value in table.items())]
    for table in document["joint"]:
        lines += ["", "[[joint]]", *(f"{key} = {toml_value(value)}" for key, value in table.items())]
    for name, table in document["probe"].items():
        theta0_rad, r_mm, h_mm = arm.probes[name].cylindrical
        lines += [
            "",
            f"[probe.{toml_key(name)}]",
            f"# the same point: theta0 = {theta0_rad:.9g}, r = {r_mm:.9g}, h = {h_mm:.9g}",
            *(f"{key} = {toml_value(value)}" for key, value in table.items()),
        ]
    return "\n".join(lines) + "\n"


def save_arm(arm: ArmData, path: Path, force: bool = False) -> None:
    """Write an arm file, whole or not at all. Raises UlnaInputError where it exists and `force` is not given, and as
    `arm_toml`."""
    write_file(path, arm_toml(arm), force=force)
