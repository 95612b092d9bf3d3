"""Arm files: `ulna-arm/1`, TOML. Also the arm inside a `result.json`."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from ulna.arm.covariance_file import covariance_of_result
from ulna.arm.frames.modified import Convention, from_modified
from ulna.arm.joint_file import JointTable, joint_document, joint_of
from ulna.arm.model import Arm, Probe
from ulna.arm.modified_file import check_modified
from ulna.formats.models import Strict, fill
from ulna.formats.output import write_file
from ulna.formats.toml import check_format, read_json, read_toml
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError

WHAT = 'an arm file (TOML, format = "ulna-arm/1") or a result.json'


class CartesianTip(Strict):
    """The ball's centre in the frame that turns with the last joint."""

    x: float
    y: float
    z: float


class CylindricalTip(Strict):
    """The same point: x = r cos theta0, y = -r sin theta0, z = h."""

    theta0: float
    r: Annotated[float, Field(ge=0)]
    h: float


def _tip_kind(tip: Any) -> str:
    keys = tip.keys() if isinstance(tip, dict) else vars(tip).keys() if hasattr(tip, "__dict__") else ()
    return "<cylindrical>" if {"theta0", "r", "h"} & set(keys) else "<cartesian>"


Tip = Annotated[
    Annotated[CartesianTip, Tag("<cartesian>")] | Annotated[CylindricalTip, Tag("<cylindrical>")],
    Discriminator(_tip_kind),
]


class ProbeTable(Strict):
    """One probe that the arm can carry."""

    tip: Tip
    ball: Annotated[float, Field(gt=0)] | None = None
    """Diameter of the ball; needed where a surface is touched."""


class ArmFile(Strict):
    """An articulated arm: `ulna-arm/1`."""

    format: Literal["ulna-arm/1"]
    name: str | None = None
    units: Units
    convention: Convention = "dh"
    """In the joint tables alpha and a stand after the joint ("dh") or before it ("modified-dh", Craig)."""
    full_last_link: bool = False
    """The last joint has a link of its own, to whose end the probes are fixed: four parameters more than needed."""
    gravity: Annotated[list[float], Field(min_length=3, max_length=3)] | None = None
    """Where gravity pulls, in the base frame; down along axis 1, [0, 0, -1], where it is not given. For compliance."""
    joint: Annotated[list[JointTable], Field(min_length=2)]
    """One table per encoder, from the base to the probe."""
    probe: Annotated[dict[str, ProbeTable], Field(min_length=1)]
    """By name. The order gives the order of the parameters."""


def load_arm(path: Path) -> Arm:
    """Read an arm from an arm file or a result.json. Raises UlnaInputError."""
    return load_arm_and_hash(path)[0]


def load_arm_and_hash(path: Path) -> tuple[Arm, str]:
    """The same, with the file's SHA-256."""
    if path.suffix.lower() == ".json":
        document, digest = read_json(path, WHAT)
        check_format(document, path, "ulna-result")
        return arm_of_result(document, path), digest
    document, digest = read_toml(path, WHAT)
    check_format(document, path, "ulna-arm")
    _check_tips(document, path)
    return _arm(fill(ArmFile, document, path), path), digest


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


def arm_of_result(document: dict[str, Any], path: Path) -> Arm:
    """The calibrated arm of a result document, with what is known of its parameters. Raises UlnaInputError."""
    # Only these three parts: the residuals of a large study need not be checked to use its arm.
    arm = document.get("arm")
    if not isinstance(arm, dict):
        raise UlnaInputError(f"{path}: key 'arm' is missing or no table; expected the calibrated arm. Calibrate again.")
    whole = {"format": "ulna-arm/1", "units": {"length": "mm", "angle": "rad"}, **arm}
    found = _arm(fill(ArmFile, whole, path), path)
    known = covariance_of_result(document, found, path)
    return dataclasses.replace(found, uncertainty=known.of(found.parameter_names))


def _arm(file: ArmFile, path: Path) -> Arm:
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
    arm = Arm(file.name or path.stem, joints, probes, full_last_link=file.full_last_link, gravity=(x, y, z))
    _check_masses(arm, path)
    return arm


def _check_masses(arm: Arm, path: Path) -> None:
    """Joints that give way give way to something. Raises UlnaInputError."""
    gives = next((k for k, joint in enumerate(arm.joints, 1) if joint.effects.compliance_rad_per_nm), None)
    if gives is not None and not any(joint.effects.mass_kg for joint in arm.joints):
        raise UlnaInputError(
            f"{path}: key 'joint.{gives}.compliance': a joint gives way to the weight of its links, but no joint has a "
            "mass; expected mass (kg) and centre of each. Add them, or remove the key."
        )


def _probe(name: str, table: ProbeTable, units: Units, path: Path) -> Probe:
    check_name(name, f"probe.{name}", path)
    ball_mm = None if table.ball is None else table.ball * units.mm
    tip = table.tip
    if isinstance(tip, CylindricalTip):
        return Probe.from_cylindrical(tip.theta0 * units.rad, tip.r * units.mm, tip.h * units.mm, ball_mm)
    return Probe(tip.x * units.mm, tip.y * units.mm, tip.z * units.mm, ball_mm)


def check_name(name: str, key: str, path: Path) -> None:
    """Names become parts of parameter names and cells of a CSV. Raises UlnaInputError."""
    if not name.strip() or name != name.strip() or re.search(r'[.*?\[\],"/\\\x00-\x1f]', name):
        raise UlnaInputError(
            f"{path}: key '{key}': the name {name!r} cannot be used; expected letters, digits, '-', '_' or inner "
            'spaces (no . , * ? [ ] / \\ "). Rename it.'
        )


def arm_document(arm: Arm) -> dict[str, Any]:
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
    return {**head, "joint": joints, "probe": probes}


def arm_toml(arm: Arm) -> str:
    """The text of an arm file, mm and rad; every number comes back exactly as it was."""
    document = arm_document(arm)
    lines = [
        'format = "ulna-arm/1"',
        f"name = {toml_value(arm.name)}",
        'units = { length = "mm", angle = "rad" }',
    ]
    lines += [f"{key} = {toml_value(document[key])}" for key in ("full_last_link", "gravity") if key in document]
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


def save_arm(arm: Arm, path: Path, force: bool = False) -> None:
    """Write an arm file, whole or not at all. Raises UlnaInputError where it exists and `force` is not given."""
    write_file(path, arm_toml(arm), force=force)


def toml_key(name: str) -> str:
    """A key as TOML writes it."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else toml_value(name)


def toml_value(value: Any) -> str:
    """A value as TOML writes it; numbers come back exactly as they were."""
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return '"' + re.sub(r"[\x00-\x1f\x7f]", lambda match: f"\\u{ord(match[0]):04x}", escaped) + '"'
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{toml_key(key)} = {toml_value(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return "[" + ", ".join(toml_value(inner) for inner in value) + "]"
    return repr(float(value)) if isinstance(value, float) else repr(int(value))
