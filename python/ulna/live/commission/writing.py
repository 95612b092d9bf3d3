"""What was found as files: the source, the arm, and the noise to paste; whole or not at all."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from pathlib import Path
from urllib.parse import quote, unquote

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.file import arm_toml
from ulna.arm.frames.links import moved
from ulna.arm.frames.rigid import pose, turn
from ulna.formats.output import output_folder, refuse_inputs
from ulna.formats.toml_text import toml_key, toml_value
from ulna.live.commission.findings import Findings
from ulna.live.mapping import TURN
from ulna.live.source_file import StatedSource, load_source
from ulna.live.still import WINDOWS_S
from ulna.planning.making import Found, plan_toml
from ulna.proposals.arms import Drawn

FILES = ("source.toml", "arm.toml", "noise.toml", "plan.toml")
BY_EYE_DEG = 5.0
"""A posture that is taken by eye."""
_PATHS = ("file", "bag", "virtual")
"""Urls that begin with a path."""


def write(findings: Findings, stated: StatedSource, base: Drawn, folder: Path, force: bool = False) -> None:
    """source.toml, arm.toml, noise.toml and plan.toml into a folder. base: the geometry.

    Raises UlnaInputError where they exist and `force` is not given, or where something is not known that they need.
    """
    findings.check()
    refuse_inputs((folder / name for name in FILES), [stated.path, *base.files])
    with output_folder(folder, FILES, force) as staging:
        (staging / "source.toml").write_text(source_text(findings, stated, folder), encoding="utf-8")
        (staging / "arm.toml").write_text(arm_text(findings, base), encoding="utf-8")
        (staging / "noise.toml").write_text(noise_text(findings), encoding="utf-8")
        load_source(staging / "source.toml")
        arm = Arm.load(staging / "arm.toml")
        (staging / "plan.toml").write_text(plan_text(findings, arm, folder), encoding="utf-8")


def source_text(findings: Findings, stated: StatedSource, folder: Path) -> str:
    """A source file, to stand in a folder."""
    file = stated.file
    mapped: dict[str, object] = {
        "channels": [joint.channel for joint in findings.joints],
        "unit": findings.unit,
    }
    if findings.unit not in TURN:
        each = [_whole(joint.counts_per_turn) for joint in findings.joints]
        mapped["counts_per_turn"] = each[0] if len(set(each)) == 1 else each
    if not file.map.wraps:
        mapped["wraps"] = False
    lines = [
        _comment("Written by ulna live commission: the channels of q1, q2, … from the base to the probe."),
        'format = "ulna-source/1"',
        f"url = {toml_value(_from(stated, folder))}",
    ]
    tables = {
        "decode": None if file.decode is None else file.decode.model_dump(mode="json", exclude_none=True),
        "map": mapped,
        **{name: getattr(file, name).model_dump(exclude_defaults=True) for name in ("limits", "still", "trigger")},
    }
    tables["still"] = {**(tables["still"] or {}), "noise": [float(f"{each.noise:.3g}") for each in findings.joints]}
    for name, table in tables.items():
        if table:
            lines += ["", f"[{name}]", *(f"{toml_key(key)} = {toml_value(value)}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def commissioned(findings: Findings, base: Arm) -> Arm:
    """The arm with what was found: signs, limits, counts per turn, zero offsets where it was put in a posture.

    The rest of its geometry stays that of `base`.
    """
    zeros = [
        joint.theta0_rad if (zero := findings.theta0_rad(k)) is None else round(zero, 6)
        for k, joint in enumerate(base.joints)
    ]
    probes = base.probes
    if not base.full_last_link:  # its zero is the direction in which the probe stands off the last axis
        probes, zeros[-1] = moved(probes, pose(turn("z", -zeros[-1]), np.zeros(3))), 0.0
    joints = [
        replace(
            joint,
            theta0_rad=zeros[k],
            sign=found.sign,
            limits_rad=None if found.endless else findings.limits_rad(k),
            endless=found.endless,
            counts_per_turn=found.counts_per_turn if findings.unit not in TURN else joint.counts_per_turn,
        )
        for k, (joint, found) in enumerate(zip(base.joints, findings.joints, strict=True))
    ]
    return replace(base, joints=tuple(joints), probes=probes, uncertainty=None)


def arm_text(findings: Findings, base: Drawn) -> str:
    """The text of the arm file."""
    lines = [f"Written by ulna live commission; its geometry: {base.said}."]
    if base.guessed:
        lines.append("Lengths and twists are a first guess: put yours in, or let the calibration find what they are.")
    lines.append("Signs, limits and counts per turn were found with the arm in the hand.")
    lines.append(f"{findings.zeros}.")
    if not (findings.zeroed or findings.as_drawn):
        lines.append('In a study: [fit] start = "search".')
    if not all(joint.sign for joint in findings.joints):
        lines.append("sign = 0: nobody could say which way the encoder counts; the calibration finds it.")
    return "".join(_comment(line) + "\n" for line in lines) + "\n" + arm_toml(commissioned(findings, base.arm))


def plan_text(findings: Findings, arm: Arm, folder: Path) -> str:
    """A plan to touch a bar by, whose length is to be filled in."""
    noise_rad = tuple(findings.touch_noise_rad(k) for k in range(len(findings.joints)))
    by_eye_rad = math.radians(BY_EYE_DEG) if findings.zeroed else None
    return plan_toml(arm, None, folder, Found(noise_rad, by_eye_rad))


def noise_text(findings: Findings) -> str:
    """[noise] to paste into a study, a plan or a simulation with units = { angle = "rad" }."""
    count = len(findings.joints)
    noise = [float(f"{findings.touch_noise_rad(k):.3g}") for k in range(count)]
    degrees = ", ".join(f"{math.degrees(findings.noise_rad(k)):.2g}" for k in range(count))
    lines = [
        _comment("Written by ulna live commission. Paste it into a study, a plan or"),
        _comment("a simulation in mm and rad. Standard deviations of a touch, which is the"),
        _comment(f"mean of {WINDOWS_S[0]:g} s at least; of one sample they are, in degrees:"),
        _comment(f"{degrees}."),
        "[noise]",
        f"encoder = {toml_value(noise)}",
        _comment("seat = 0.01    (of a touch, per coordinate; not found here: put yours in)"),
    ]
    in_a_study = _in_a_study(findings)
    if in_a_study:
        lines += ["", *map(_comment, in_a_study)]
    return "\n".join(lines) + "\n"


def _in_a_study(findings: Findings) -> list[str]:
    if findings.as_drawn:
        return []
    if findings.zeroed:
        return [
            "In a study, as the zeros of the encoders are known by eye:",
            "[fit]",
            f"known_angle = {math.radians(BY_EYE_DEG):.2g}    ({BY_EYE_DEG:g} degrees)",
        ]
    return ["In a study, as the zeros of the encoders are not known:", "[fit]", 'start = "search"']


def _whole(counts: float | None) -> float | int | None:
    return counts if counts is None or counts % 1.0 else int(counts)


def _from(stated: StatedSource, folder: Path) -> str:
    """The url as a file in the folder says it: paths in it are relative to that."""
    scheme, _, rest = stated.file.url.partition(":")
    if scheme.lower() not in _PATHS:
        return stated.file.url
    path, question, options = rest.partition("?")
    moved = _moved(unquote(path), stated.folder, folder)
    pairs = [pair.partition("=") for pair in options.split("&")] if options else []
    told = "&".join(
        f"{name}={quote(_moved(unquote(value), stated.folder, folder)) if name == 'poses' else value}"
        for name, _, value in pairs
    )
    return f"{scheme}:{quote(moved)}{question}{told}"


def _moved(path: str, origin: Path, folder: Path) -> str:
    if not path or Path(path).is_absolute():
        return path
    try:
        return Path(os.path.relpath((origin / path).absolute(), folder.absolute())).as_posix()
    except ValueError:  # another drive
        return (origin / path).absolute().as_posix()


def _comment(text: str) -> str:
    """A line that nothing in it can end."""
    return "# " + "".join(c if c.isprintable() else "?" for c in text)
