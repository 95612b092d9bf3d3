"""Arm files: `ulna-arm/1`, TOML. Also the arm inside a `result.json`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag
from pydantic_core import PydanticCustomError

from ulna.errors import UlnaInputError
from ulna.files.covariance import covariance_of_result
from ulna.files.models import Strict, fill
from ulna.files.modified import check_modified
from ulna.files.output import write_file
from ulna.files.toml import check_format, read_json, read_toml
from ulna.files.units import Units
from ulna.frames.modified import Convention, from_modified
from ulna.model import Arm, Joint, Probe

WHAT = 'an arm file (TOML, format = "ulna-arm/1") or a result.json'


def _no_truth(value: Any) -> Any:
    """Python takes true for 1."""
    if isinstance(value, bool):
        raise PydanticCustomError("sign", "1 or -1")
    return value


class JointTable(Strict):
    """One joint, from the base to the probe: `turn = sign * encoder - theta0`, then the link to the next axis."""

    theta0: float | None = None
    """Zero offset. Required, except of the last joint, which carries the probe and has no geometry of its own."""
    alpha: float | None = None
    """Twist to the next axis. Required, except of the last joint."""
    a: float | None = None
    """Length of the link. Required, except of the last joint."""
    d: float | None = None
    """Offset along the axis. Required of a DH joint, except the last."""
    beta: float | None = None
    """Required of a Hayati joint, instead of d."""
    sign: Annotated[Literal[1, -1], BeforeValidator(_no_truth)] = 1
    model: Literal["dh", "hayati"] = "dh"
    name: str | None = None
    limits: Annotated[list[float], Field(min_length=2, max_length=2)] | None = None
    """Lowest and highest encoder angle, in the file's angle unit."""
    counts_per_turn: Annotated[float, Field(gt=0)] | None = None
    """Needed for readings in counts."""


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
    return Arm(found.name, found.joints, found.probes, covariance_of_result(document, found, path))


def _arm(file: ArmFile, path: Path) -> Arm:
    modified = file.convention == "modified-dh"
    if modified:
        check_modified(file.joint, path)
    last = 0 if modified else len(file.joint)  # in the modified form the last joint has geometry as well
    joints = tuple(_joint(table, k, k == last, file.units, path) for k, table in enumerate(file.joint, start=1))
    probes = {name: _probe(name, table, file.units, path) for name, table in file.probe.items()}
    if modified:
        joints, probes, _ = from_modified(joints, probes)
    return Arm(file.name or path.stem, joints, probes)


def _joint(table: JointTable, number: int, last: bool, units: Units, path: Path) -> Joint:
    geometry = {"theta0": table.theta0, "alpha": table.alpha, "a": table.a, "d": table.d, "beta": table.beta}
    missing, foreign = ("d", "beta") if table.model == "dh" else ("beta", "d")
    for key, value in geometry.items():
        name = f"joint.{number}.{key}"
        if last and value:
            raise UlnaInputError(
                f"{path}: key '{name}': got {value:g}, but the last joint has no geometry of its own: it is part of "
                "the probe's tip. Remove the key; turn the tip by theta0 instead (tip = { theta0, r, h })."
            )
        if not last and key == foreign and value:
            other = "hayati" if key == "beta" else "dh"
            raise UlnaInputError(
                f"{path}: key '{name}': got {value:g}, but a joint of model '{table.model}' has '{missing}' instead. "
                f'Remove the key or set model = "{other}".'
            )
        if not last and key != foreign and value is None:
            raise UlnaInputError(
                f"{path}: key '{name}' is missing; expected theta0, alpha, a and {missing} of every joint but the "
                "last. Add it (0 where the drawing says nothing)."
            )
    if table.limits is not None and not table.limits[0] < table.limits[1]:
        raise UlnaInputError(
            f"{path}: key 'joint.{number}.limits': got {table.limits}, expected the lower limit first. Swap them."
        )
    return Joint(
        theta0_rad=(table.theta0 or 0.0) * units.rad,
        alpha_rad=(table.alpha or 0.0) * units.rad,
        a_mm=(table.a or 0.0) * units.mm,
        d_mm=(table.d or 0.0) * units.mm,
        beta_rad=(table.beta or 0.0) * units.rad,
        sign=table.sign,
        model=table.model,
        name=table.name,
        limits_rad=None if table.limits is None else (table.limits[0] * units.rad, table.limits[1] * units.rad),
        counts_per_turn=table.counts_per_turn,
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
    joints: list[dict[str, Any]] = []
    for k, joint in enumerate(arm.joints):
        table: dict[str, Any] = {} if joint.name is None else {"name": joint.name}
        if k < arm.n - 1:
            table |= {"theta0": joint.theta0_rad, "alpha": joint.alpha_rad, "a": joint.a_mm}
            table |= {"beta": joint.beta_rad} if joint.model == "hayati" else {"d": joint.d_mm}
        table |= {"sign": joint.sign}
        if joint.model != "dh":
            table |= {"model": joint.model}
        if joint.limits_rad is not None:
            table |= {"limits": list(joint.limits_rad)}
        if joint.counts_per_turn is not None:
            table |= {"counts_per_turn": joint.counts_per_turn}
        joints.append(table)
    probes: dict[str, Any] = {}
    for name, probe in arm.probes.items():
        probes[name] = {"tip": {"x": probe.x_mm, "y": probe.y_mm, "z": probe.z_mm}}
        if probe.ball_mm is not None:
            probes[name]["ball"] = probe.ball_mm
    return {"name": arm.name, "joint": joints, "probe": probes}


def arm_toml(arm: Arm) -> str:
    """The text of an arm file, mm and rad; every number comes back exactly as it was."""
    document = arm_document(arm)
    lines = [
        'format = "ulna-arm/1"',
        f"name = {_toml(arm.name)}",
        'units = { length = "mm", angle = "rad" }',
    ]
    for table in document["joint"]:
        lines += ["", "[[joint]]", *(f"{key} = {_toml(value)}" for key, value in table.items())]
    for name, table in document["probe"].items():
        theta0_rad, r_mm, h_mm = arm.probes[name].cylindrical
        lines += [
            "",
            f"[probe.{_key(name)}]",
            f"# the same point: theta0 = {theta0_rad:.9g}, r = {r_mm:.9g}, h = {h_mm:.9g}",
            *(f"{key} = {_toml(value)}" for key, value in table.items()),
        ]
    return "\n".join(lines) + "\n"


def save_arm(arm: Arm, path: Path, force: bool = False) -> None:
    """Write an arm file, whole or not at all. Raises UlnaInputError where it exists and `force` is not given."""
    write_file(path, arm_toml(arm), force=force)


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _toml(name)


def _toml(value: Any) -> str:
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return '"' + re.sub(r"[\x00-\x1f\x7f]", lambda match: f"\\u{ord(match[0]):04x}", escaped) + '"'
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_toml(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(_toml(inner) for inner in value) + "]"
    return repr(float(value)) if isinstance(value, float) else repr(int(value))
