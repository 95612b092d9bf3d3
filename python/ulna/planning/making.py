"""A plan file for an arm, filled in as far as the arm and a study say it: nothing is typed twice."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.formats.toml_text import toml_key, toml_value
from ulna.planning.from_study import planned, travel_read
from ulna.simulation.study_files import artefact_table, features_file
from ulna.study.data import FitOptions
from ulna.study.study import Study

STANDS = 12
"""Places that a person is glad to put a bar in; a plan of so many is about as good as one of any number."""
AT_ONE_POINT = 5
"""Touches of a seat in one place."""
ABOUT_BAR = 0.4
"""Of the arm's reach: a bar as long is easily put anywhere."""
ENCODER, SEAT = "5e-6", "0.01"


@dataclass(frozen=True)
class Found:
    """What was found of an arm before anybody measured with it."""

    encoder_rad: tuple[float, ...]
    """Standard deviation of each encoder in a touch."""
    known_angle_rad: float | None
    """By how much angles of the arm file may be off; None: as those of a drawing."""


@dataclass(frozen=True)
class Wanted:
    """What somebody states; None and empty: as it is filled in otherwise."""

    artefact: Artefact | None = None
    remark: str = ""
    """Of the artefact: by which certificate."""
    encoder_rad: tuple[float, ...] = ()
    """Standard deviation of each encoder, or one of all."""
    seat_mm: float | None = None
    travel_rad: tuple[tuple[float, float], ...] = ()
    test_mm: float | None = None
    choose: int = 100
    stands: int = STANDS
    touches: int | None = None
    probe: str | None = None
    trials: int | None = None


def plan_toml(
    arm: Arm, study: Study | None, folder: Path, found: Found | None = None, wanted: Wanted | None = None
) -> str:
    """The text of a plan file in a folder; what is not known stands behind '#' or is marked as an example. Raises
    UlnaInputError for a study that does not fit."""
    said = wanted or Wanted()
    probe = next(iter(arm.probes))
    reach_mm = float(arm.core.reach_mm(0))
    lines = [
        f"# A plan for arm {toml_value(arm.name)}, {arm.n} joints, reach {reach_mm:.0f} mm:",
        "# ulna plan ARM THIS -o planned",
        'format = "ulna-plan/1"',
        'units = { length = "mm", angle = "rad" }',
        *_artefact(arm, study, reach_mm, folder, said),
        *_noise(arm, study, found, said),
        *_travel(arm, study, said),
        "",
        "[within] # where a person can put it, mm: heights above the table at z = table, nothing nearer to the axis",
        "table = 0.0",
        "low = 0.0",
        "high = 1000.0",
        "aside = 150.0",
        "",
        "[plan]",
        f"choose = {said.choose} # measurements",
        f"placements = {said.stands} # places of the artefact, at the most",
    ]
    touches = said.touches or (None if said.artefact is None else _touches(said.artefact))
    if touches is not None:
        lines.append(f"touches = {touches} # of each feature in a measurement, each in another posture")
    if said.test_mm is not None:
        lines.append(f"test_length = {toml_value(said.test_mm)}")
    if said.trials is not None:
        lines.append(f"trials = {said.trials} # calibrations, simulated")
    if said.probe is not None:
        lines.append(f"probe = {toml_value(said.probe)}")
    elif len(arm.probes) > 1:
        lines.append(f"probe = {toml_value(probe)} # or {', '.join(list(arm.probes)[1:])}")
    hold = [] if study is None else list(study.fit.hold)
    lines.append(f"hold = {toml_value(hold)}" if hold else '# hold = ["joint.1.*"] # parameters that are not fitted')
    lines += _known(study, found)
    return "\n".join(lines) + "\n"


def _touches(artefact: Artefact) -> int | None:
    """Of a single point: one alone would tell nothing."""
    return AT_ONE_POINT if len(artefact.features) == 1 and not kind_of(artefact).scattered else None


def _known(study: Study | None, found: Found | None) -> list[str]:
    """What the arm file is known by; nothing where that is as usual."""
    usual = FitOptions()
    fit = usual if study is None else study.fit
    angle_rad = fit.known_angle_rad if found is None else found.known_angle_rad or usual.known_angle_rad
    stated = [("known_length", fit.known_length_mm, usual.known_length_mm, "mm, lengths"),
              ("known_angle", angle_rad, usual.known_angle_rad, "rad, angles")]  # fmt: skip
    return [
        f"{key} = {value:.2g} # {what} of the arm file may be off by so much (standard deviation)"
        for key, value, as_usual, what in stated
        if value != as_usual
    ]


def _artefact(arm: Arm, study: Study | None, reach_mm: float, folder: Path, said: Wanted) -> list[str]:
    if said.artefact is not None:
        remark = [f"# {''.join(c if c.isprintable() else '?' for c in said.remark)}"] if said.remark else []
        table = {"kind": said.artefact.kind, **artefact_table(said.artefact)}
        lines = (f"{key} = {value}" for key, value in _told(said.artefact, table))
        return ["", *remark, f"[artefact.{toml_key(said.artefact.name)}]", *lines]
    if study is None:
        length = max(round(ABOUT_BAR * reach_mm, -1), 10.0)
        return [
            "",
            "[artefact.bar]",
            'kind = "bar"',
            f"length = {length} # an example, {100 * ABOUT_BAR:.0f} % of the reach: yours, as certified",
        ]
    found = planned(study, arm, "option --study: ")
    artefact = found[0]
    table = {"kind": artefact.kind, **artefact_table(artefact)}
    others = [f"# others of that study: {', '.join(each.name for each in found[1:])}"] if found[1:] else []
    head = f"[artefact.{toml_key(artefact.name)}]"
    return ["", *others, head, *(f"{key} = {value}" for key, value in _told(artefact, table))]


def _told(artefact: Artefact, table: dict[str, Any]) -> list[tuple[str, str]]:
    """Keys as TOML; features stand in the file itself, so that no other is needed."""
    if kind_of(artefact).features_file:
        named = ", ".join(f"{toml_key(name)} = {toml_value(list(xyz))}" for name, xyz in artefact.features.items())
        return [(key, f"{{ {named} }}" if value == features_file(artefact) else toml_value(value))
                for key, value in table.items()]  # fmt: skip
    return [(key, toml_value(value)) for key, value in table.items()]


def _noise(arm: Arm, study: Study | None, found: Found | None, said: Wanted) -> list[str]:
    noise = None if study is None else study.noise
    counts = [joint.counts_per_turn for joint in arm.joints]
    if said.encoder_rad:
        each = list(said.encoder_rad)
        encoder = toml_value(each[0] if len(each) == 1 else each) + " # rad, as stated"
    elif noise is not None and noise.encoder_rad is not None:
        encoder = toml_value(noise.encoder_rad.tolist()) + " # as the study has it"
    elif found is not None:
        encoder = (
            toml_value([float(f"{each:.3g}") for each in found.encoder_rad]) + " # rad, of a touch, as found held still"
        )
    elif all(counts):
        # a count is rounded: uniform over its width
        steps = [float(f"{2.0 * np.pi / float(count or 1.0) / np.sqrt(12.0):.3g}") for count in counts]
        encoder = toml_value(steps) + " # one count of each encoder, over the root of 12; more where they are noisy"
    else:
        encoder = f"{ENCODER} # rad, an example: standard deviation of an encoder reading"
    seat = None if noise is None else noise.seat_mm
    if said.seat_mm is not None:
        return ["", "[noise]", f"encoder = {encoder}", f"seat = {toml_value(said.seat_mm)} # mm, as stated"]
    touch = f"seat = {SEAT} # mm, an example" if seat is None else f"seat = {toml_value(seat)} # as the study has it"
    return ["", "[noise]", f"encoder = {encoder}", touch]


def _travel(arm: Arm, study: Study | None, said: Wanted) -> list[str]:
    """Nothing where the arm file has all limits; else a pair for each joint: where it has none as far as the study's
    readings go, without a study an example."""
    if said.travel_rad:
        limits = ", ".join(toml_value(list(ends)) for ends in said.travel_rad)
        return ["", "[travel] # rad, as stated", f"limits = [{limits}]"]
    if all(joint.travel_rad is not None for joint in arm.joints):
        return ["", "# how far joints turn: the arm file says it"]
    why = "an example" if study is None else "as the study's readings go"
    lines = ["", "[travel] # rad", "limits = ["]
    for k, (joint, ends) in enumerate(zip(arm.joints, travel_read(arm, study), strict=True), start=1):
        mark = "" if joint.travel_rad is not None else f": {why}"
        lines.append(f"    {toml_value([float(end) for end in ends])}, # joint {k}{mark}")
    return [*lines, "]"]
