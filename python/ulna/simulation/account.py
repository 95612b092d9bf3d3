"""The account of the truth behind simulated readings: `truth.json`, `ulna-truth/1`. mm, rad, °C."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ulna.arm.payload import Payload
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import Readings
from ulna.simulation.spec import Simulation
from ulna.simulation.truth import TrueTouching, Truth
from ulna.study.study import Study

FORMAT = "ulna-truth/1"


def account(simulation: Simulation, study: Study, truth: Truth) -> dict[str, Any]:
    """JSON types only, no NaN: true and drawn parameters, true dimensions and placements, missed touches."""
    drawn = dict(zip(study.arm.parameter_names, study.arm.parameters.tolist(), strict=True))
    arm = truth.arm
    parameters = [
        {"name": name, "unit": unit, "true": value, "drawn": drawn.get(name)}
        for name, unit, value in zip(arm.parameter_names, arm.parameter_units, arm.parameters.tolist(), strict=True)
    ]
    pairs = list(zip(study.readings, truth.touchings, strict=True))
    return {
        "format": FORMAT,
        "seed": simulation.seed,
        "arm": "truth.toml",
        "reads_counts": simulation.step_rad is not None,
        "parameters": parameters,
        "artefacts": [_artefact(group, true) for group, true in pairs],
        "placements": [placement for group, true in pairs for placement in _placements(group, true, arm.payloads)],
        "missed": [missed for group, true in pairs for missed in _missed(group, true)],
    }


def account_json(document: dict[str, Any]) -> str:
    """The text of truth.json: one line for each parameter, artefact, placement and missed touch."""

    def text(value: Any) -> str:
        return json.dumps(value, ensure_ascii=False, allow_nan=False)

    def lines(value: Any) -> str:
        if not isinstance(value, list) or not value:
            return text(value)
        return "[\n  " + ",\n  ".join(map(text, value)) + "\n ]"

    return "{\n " + ",\n ".join(f"{text(key)}: {lines(value)}" for key, value in document.items()) + "\n}\n"


def _artefact(group: Readings, true: TrueTouching) -> dict[str, Any]:
    return {
        "artefact": group.artefact.name,
        "kind": group.artefact.kind,
        "file": f"{group.artefact.name}.csv",
        "readings": len(group),
        **_dimensions(group.artefact, true.artefact),
    }


def _placements(group: Readings, true: TrueTouching, payloads: Mapping[str, Payload]) -> Iterator[dict[str, Any]]:
    """Where the artefact's origin is and how its axes (rows) stand in the base frame."""
    standings = true.standings
    origins_mm, axes = standings.origin_mm.tolist(), standings.axes.tolist()
    told = {each.said: each.of_places(drawn, payloads) for each, drawn in standings.drawn.items()}
    of_places = {said: each for said, each in told.items() if each is not None}
    for k, (origin_mm, own) in enumerate(zip(origins_mm, axes, strict=True)):
        placement = {"artefact": group.artefact.name, "placement": str(k + 1), "origin_mm": origin_mm, "axes": own}
        yield placement | {said: values[k] for said, values in of_places.items()}


def _dimensions(stated: Artefact, true: Artefact) -> dict[str, Any]:
    found: dict[str, Any] = {}
    kind = kind_of(stated)
    for own, really in zip(kind.dimensions(stated), kind.dimensions(true), strict=True):
        key = f"{own.name}_{own.unit}" if own.unit != "1" else own.name
        found |= {key: really.value, f"stated_{key}": own.value}
    if kind.features_file:
        found["features_mm"] = {name: list(xyz) for name, xyz in true.features.items()}
    return found


def _missed(group: Readings, true: TrueTouching) -> list[dict[str, Any]]:
    names = list(group.artefact.features)
    distance_mm = np.linalg.norm(true.standings.off_mm, axis=2)
    per_row = distance_mm.reshape(-1, kind_of(group.artefact).poses).max(axis=1)
    found = []
    for k in np.flatnonzero(true.missed).tolist():
        entry: dict[str, Any] = {
            "file": f"{group.artefact.name}.csv",
            "row": int(group.row[k]),
            "artefact": group.artefact.name,
            "placement": group.placement[k],
        }
        if names:
            entry["feature"] = names[int(group.feature[k])]
        found.append(entry | {"off_mm": float(per_row[k])})
    return found
