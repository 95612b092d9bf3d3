"""Arms of the desk: drawings and calibrated ones, and how they look."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Literal

import numpy as np
from fastapi import APIRouter, Request

from ulna.arm.arm import Arm
from ulna.arm.given import as_arm
from ulna.calibration.result import Result
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.live.sources.virtual import UNSAID_RAD
from ulna.pictures.scene import scene
from ulna.serve.activities.seen import bodies_of, from_degrees, in_degrees
from ulna.serve.contract import arms as wire
from ulna.serve.contract.files import FileKind
from ulna.serve.desk import Desk
from ulna.serve.routes.common import Digest, workshop
from ulna.serve.texts import valued

router = APIRouter(prefix="/arms", tags=["arms"])
KEPT, LONGEST = 32, 1000
Status = Literal["drawing", "fitted", "held", "not determined"]


@router.get("")
def arms(request: Request) -> wire.Arms:
    """All of them, the newest first; what cannot be used is left to the list of files."""
    desk = workshop(request).desk
    found = []
    for each in desk.all(FileKind.ARM, FileKind.RESULT):
        with suppress(UlnaInputError):
            found.append(_info(desk, each.sha256))
    return wire.Arms(arms=found)


@router.get("/{sha256}")
def arm(request: Request, sha256: Digest, probe: str | None = None) -> wire.ArmWhole:
    """One, with its parameters and its picture."""
    desk = workshop(request).desk
    found = _arm(desk, sha256)
    return wire.ArmWhole(arm=_info(desk, sha256), parameters=_parameters(found), scene=_scene(found, probe))


@router.post("/{sha256}/bodies")
def bodies(request: Request, sha256: Digest, posture: wire.Posture) -> wire.Bodies:
    """Where it is in a posture."""
    found = _arm(workshop(request).desk, sha256)
    if len(posture.q_deg) != found.n or not all(map(math.isfinite, posture.q_deg)):
        raise UlnaInputError(f"q_deg: got {len(posture.q_deg)} angles; expected {found.n}. Give one for each joint.")
    return bodies_of(found, from_degrees(found, posture.q_deg), found.probe_index(posture.probe))


def _arm(desk: Desk, sha256: str) -> Arm:
    return _read(desk.path(sha256), sha256)


@lru_cache(maxsize=KEPT)
def _read(path: Path, sha256: str) -> Arm:
    """sha256: what is in it; the same content is the same arm."""
    return as_arm(path)


def _info(desk: Desk, sha256: str) -> wire.ArmInfo:
    file, found = desk.info(sha256), _arm(desk, sha256)
    return wire.ArmInfo(
        sha256=sha256,
        name=found.name[:LONGEST],
        file=file.name,
        joints=_joints(found),
        probes=list(found.probes),
        calibration=_calibration(desk.path(sha256), sha256) if file.kind is FileKind.RESULT else None,
    )


@lru_cache(maxsize=KEPT)
def _calibration(path: Path, sha256: str) -> wire.Calibration:
    found = Result.load(path)
    at = found.provenance.get("time")
    return wire.Calibration(
        at=at if isinstance(at, str) else None,
        converged=found.fit.converged,
        verdict=found.fit.termination[:LONGEST],
        readings=found.fit.readings,
        u_length=None,
    )


def _travel(found: Arm) -> F64:
    low_high = [joint.travel_rad or joint.limits_rad or UNSAID_RAD for joint in found.joints]
    return np.array(low_high, dtype=np.float64)


def _joints(found: Arm) -> list[wire.Joint]:
    low, high = (in_degrees(found, each) for each in _travel(found).T)
    return [
        wire.Joint(
            number=k + 1,
            name=joint.name,
            slides=joint.slides,
            sign=joint.sign,  # type: ignore[arg-type]  # -1, 0 or 1
            low_deg=low[k],
            high_deg=high[k],
            endless=joint.endless,
            counts_per_turn=joint.counts_per_turn,
        )
        for k, joint in enumerate(found.joints)
    ]


def _parameters(found: Arm) -> list[wire.Parameter]:
    known = found.uncertainty
    names, units = found.parameter_names, found.parameter_units
    u = {} if known is None else dict(zip(known.names, np.sqrt(np.diag(known.matrix)).tolist(), strict=True))
    lost = set() if known is None else {name for direction in known.lost for name in direction["combination"]}
    return [
        wire.Parameter(
            name=name,
            value=valued(value, unit, u.get(name)),
            status=_status(name, known is not None, u, lost),
        )
        for name, unit, value in zip(names, units, found.core.parameters.tolist(), strict=True)
    ]


def _status(name: str, calibrated: bool, u: Mapping[str, float], lost: Collection[str]) -> Status:
    if not calibrated:
        return "drawing"
    if name in lost:
        return "not determined"
    return "fitted" if name in u else "held"


def _scene(found: Arm, probe: str | None) -> wire.Scene:
    drawn = scene(found, probe)
    q_rad = _travel(found).mean(axis=1)
    return wire.Scene(
        shapes=[
            wire.Shape(
                kind=each.kind,
                body=each.body,
                group=each.group,
                role=each.role,
                points_mm=np.round(each.points_mm, 3).tolist(),
                joint=each.joint,
                text=each.text,
                radius_mm=each.radius_mm,
            )
            for each in drawn.shapes
        ],
        reach_mm=drawn.reach_mm,
        step_mm=drawn.step_mm,
        q_deg=in_degrees(found, q_rad),
        bodies=bodies_of(found, q_rad, found.probe_index(drawn.probe)),
    )
