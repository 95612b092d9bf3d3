"""Plan files made of what somebody states, and what planning found, as data."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.given import as_arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import KINDS, made
from ulna.artefacts.tables import Place
from ulna.formats.models import check_kind, fill, fill_json
from ulna.formats.toml import check_format, read_json
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.purpose import purpose_of
from ulna.planning.making import Wanted, plan_toml
from ulna.planning.result_file import WHAT, PlanResultFile
from ulna.planning.spec import PlanSpec
from ulna.records.bench import Bench
from ulna.records.lending import lent_by
from ulna.serve.activities.seen import in_degrees
from ulna.serve.beside import usable
from ulna.serve.contract import plans as wire
from ulna.serve.texts import length
from ulna.serve.workshop import Workshop

STATED = Path("artefact")
"""How messages call what somebody states."""


def plan_made(workshop: Workshop, asked: wire.PlanAsked) -> wire.PlanInfo:
    """A plan file on the desk. Raises UlnaInputError, with nothing on the desk, for what cannot be planned with."""
    arm = as_arm(workshop.desk.path(asked.arm))
    artefact, remark = artefact_of(workshop.records.bench, asked.artefact)
    travel = asked.travel_deg
    for ends in travel or []:
        if not ends[0] < ends[1]:
            raise UlnaInputError(f"travel_deg: got {ends[0]:g}° to {ends[1]:g}°; expected low below high. Turn them.")
    wanted = Wanted(
        artefact,
        remark,
        tuple(asked.encoder_rad or ()),
        asked.seat_mm,
        tuple((float(np.radians(low)), float(np.radians(high))) for low, high in travel or ()),
        asked.test_length_mm,
        asked.measurements,
        asked.places,
        asked.touches,
        asked.probe,
        asked.trials,
    )
    text = plan_toml(arm, None, Path(), None, wanted)
    with tempfile.TemporaryDirectory(prefix="ulna-") as folder:
        path = Path(folder) / "plan.toml"
        path.write_text(text, encoding="utf-8")
        try:
            purpose_of(path, arm)
        except UlnaInputError as error:
            raise UlnaInputError(str(error).replace(f"{folder}/", "")) from None
    name = asked.name if asked.name.endswith(".toml") else f"{asked.name}.toml"
    return plan_info(workshop, workshop.desk.put(name, text.encode()).sha256, arm)


def artefact_of(bench: Bench, asked: wire.ArtefactAsked) -> tuple[Artefact, str]:
    """What is stated, or what a certificate of the record says, and by which. Raises UlnaInputError."""
    if asked.record is not None:
        return _of_record(bench, asked.record, asked)
    if asked.kind is None:
        raise UlnaInputError(f"artefact: neither a kind nor one of the record; expected {', '.join(KINDS)}. Name one.")
    stated: dict[str, Any] = {"length": asked.length_mm, "diameter": asked.diameter_mm, "u": asked.u_mm}
    if asked.features is not None:
        stated["features"] = {each.name: list(each.point_mm) for each in asked.features}
    table = {"kind": asked.kind} | {key: value for key, value in stated.items() if value is not None}
    return _made(asked.name or asked.kind, table), ""


def _of_record(bench: Bench, name: str, asked: wire.ArtefactAsked) -> tuple[Artefact, str]:
    if (asked.length_mm, asked.diameter_mm, asked.u_mm, asked.features) != (None, None, None, None):
        raise UlnaInputError(
            f"artefact: '{name}' of the record has its size from its certificate; expected none beside it. Leave out."
        )
    kinds = {kind.name: kind.lent for kind in KINDS.values() if kind.lent and asked.kind in (None, kind.name)}
    if not kinds:
        raise UlnaInputError(f"artefact: kind '{asked.kind}': no certificate says its size. State it here instead.")
    found = lent_by(bench, name, list(dict.fromkeys(str(each) for each in kinds.values())), asked.expired_because)
    kind = next(each for each, quantity in kinds.items() if quantity == found.quantity)
    table = {"kind": kind, found.quantity: found.value_mm, "u": found.u_mm}
    return _made(asked.name or found.name, table), f"'{found.name}' of the record: {found.said}"


def _made(name: str, table: dict[str, Any]) -> Artefact:
    check_kind(table, "artefact", list(KINDS), STATED)
    filled = fill(KINDS[str(table["kind"])].table, table, STATED)
    return made(name, filled, Place(STATED, Units(length="mm", angle="rad"), []))


def plan_info(workshop: Workshop, sha256: str, arm: Arm) -> wire.PlanInfo:
    """A plan file, or a study, for an arm. Raises UlnaInputError."""
    path = usable(workshop.desk, sha256)
    spec = purpose_of(path, arm).spec
    return wire.PlanInfo(
        file=workshop.desk.info(sha256),
        artefact=spec.artefact.name,
        kind=spec.artefact.kind,
        stated=spec.artefact.stated,
        features=list(spec.artefact.features),
        test_length=None if spec.test_mm is None else length(spec.test_mm),
        encoder_rad=spec.encoder_rad.tolist(),
        seat=length(spec.seat_mm),
        travel_deg=_travel(arm, spec),
        measurements=spec.choose,
        places=spec.placements,
        touches=spec.touches,
        probe=spec.probe,
        text=path.read_text(encoding="utf-8"),
    )


def _travel(arm: Arm, spec: PlanSpec) -> list[tuple[float, float]] | None:
    if spec.travel_rad is None:
        return None
    low, high = (in_degrees(arm, each) for each in spec.travel_rad.T)
    return list(zip(low, high, strict=True))


def outcome(sha256: str, path: Path) -> wire.PlanOutcome:
    """What `ulna plan` wrote. Raises UlnaInputError for what is no plan.json."""
    document, _ = read_json(path, WHAT)
    check_format(document, path, "ulna-plan-result")
    found = fill_json(PlanResultFile, document, path)
    return wire.PlanOutcome(
        sha256=sha256,
        arm=found.arm,
        artefact=next(iter(found.asked.artefact)),
        places=[
            wire.Place(
                number=each.stand,
                points_mm=[(x, y, z) for x, y, z in each.points_mm],
                lies=each.lies,
                slope_deg=each.slope_deg,
                azimuth_deg=each.azimuth_deg,
                measurements=each.placements,
            )
            for each in found.places
        ],
        steps=[
            wire.Step(
                number=each.step,
                place=each.stand,
                measurement=each.placement,
                feature=each.feature or each.touch or "",
                q_deg=_angles(each.model_extra or {}, path),
            )
            for each in found.steps
        ],
        expected=[
            wire.Expected(
                measurements=each.measurements,
                planned=length(2.0 * each.u_length_mm),
                random=length(2.0 * each.random_u_length_mm),
            )
            for each in sorted(found.curve, key=lambda each: each.measurements)
        ],
        gains=_gains(found),
        gain=found.gain,
        determined=found.determined,
        parameters=found.parameters,
        candidates=found.candidates,
        sentences=_sentences(found),
    )


def _angles(row: dict[str, Any], path: Path) -> list[float]:
    keys = [f"q{k}_deg" for k in range(1, 17) if f"q{k}_deg" in row]
    angles = [row[key] for key in keys]
    if not keys or not all(isinstance(each, float | int) for each in angles):
        raise UlnaInputError(f"{path.name}: a step has no angles; expected q1_deg, q2_deg, … Plan again.")
    return [float(each) for each in angles]


_FIGURES = {"length": "u_length_mm", "length-worst": "u_length_worst_mm", "point": "u_point_mm"}


def _gains(found: PlanResultFile) -> list[wire.Gain]:
    pairs = [(name, found.planned.get(key), found.random.get(key)) for name, key in _FIGURES.items()]
    gains = [
        wire.Gain(figure=name, planned=length(2.0 * own), random=length(2.0 * other))  # type: ignore[arg-type]
        for name, own, other in pairs
        if isinstance(own, float) and isinstance(other, float)
    ]
    if found.trial is not None:
        planned, random = length(found.trial.planned_mm), length(found.trial.random_mm)
        gains.append(wire.Gain(figure="simulated", planned=planned, random=random))
    return gains


def _sentences(found: PlanResultFile) -> list[str]:
    said = []
    if found.gain is not None:
        less = f"{100 * found.gain:.0f}"
        said.append(worded("The expected length uncertainty is {less} % less than by random choice.", less=less))
    if found.trial is not None:
        less = f"{100 * found.trial.gain:.0f}"
        said.append(worded("By {runs} simulated calibrations it is {less} % less.", runs=found.trial.runs, less=less))
    if found.determined is not None and found.parameters is not None:
        said.append(
            worded(
                "{determined} of {all} free parameters' directions are determined.",
                determined=found.determined,
                all=found.parameters,
            )
        )
    return said
