"""What a study says of a plan: what is touched, how noisy readings are, how far joints turn, what is held."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError, nearest
from ulna.planning.spec import PlanSpec
from ulna.study.data import Noise
from ulna.study.study import Study


def planned(study: Study, arm: Arm, said: str = "") -> list[Artefact]:
    """Artefacts of the study that a plan can put somewhere, as they are certified. said: by which option it was given.
    Raises UlnaInputError where there are none, or it is of another arm."""
    if study.arm.n != arm.n:
        raise UlnaInputError(
            f"{said}{study.label} is of an arm with {study.arm.n} joints, ARM has {arm.n}; expected as many. Name "
            "another."
        )
    artefacts = {group.artefact.name: replace(group.artefact, fitted=False) for group in study.readings}
    found = [each for each in artefacts.values() if each.kind != "length"]
    if not found:
        raise UlnaInputError(
            f"{said}{study.label} has no artefact that a plan can put somewhere; expected a bar, a seat, points or a "
            f"surface. {'Leave the option out' if said else 'Name another'}."
        )
    return found


def travel_read(arm: Arm, study: Study | None) -> list[tuple[float, float]]:
    """Of each joint its limits; where it has none as far as the study's readings go, without any ±3.14 rad."""
    groups = [] if study is None else study.readings
    read = [q_rad for group in groups for q_rad in (group.q_rad, group.p_rad) if q_rad is not None and len(q_rad)]
    read_rad = np.concatenate(read) if read else np.array([[-3.14] * arm.n, [3.14] * arm.n])
    ends = zip(read_rad.min(axis=0).tolist(), read_rad.max(axis=0).tolist(), strict=True)
    return [joint.travel_rad or each for joint, each in zip(arm.joints, ends, strict=True)]


def spec_of_study(study: Study, arm: Arm, artefact: str | None = None, probe: str | None = None) -> PlanSpec:
    """What to touch with an arm, as a study has it; all that it does not say is as in a plan file that says nothing.
    artefact: which, where there are several; probe: of a study without readings. Raises UlnaInputError."""
    chosen = _chosen(study, planned(study, arm), artefact)
    noise = _stated(study)
    kind = kind_of(chosen)
    return PlanSpec(
        artefact=chosen,
        encoder_rad=noise[0],
        seat_mm=noise[1],
        # one touch of one feature tells nothing: its place is unknown
        touches=kind.touches if kind.scattered else 1 if len(chosen.features) > 1 else 2,
        candidates=10_000 if kind.scattered else 100_000,
        hold=list(study.fit.hold),
        known_length_mm=study.fit.known_length_mm,
        known_angle_rad=study.fit.known_angle_rad,
        probe=_probe(study, arm, chosen, probe),
        travel_rad=_travel(study, arm),
        label=study.label,
        files=tuple(file.path for file in study.files),
    )


def _chosen(study: Study, artefacts: Sequence[Artefact], name: str | None) -> Artefact:
    names = [each.name for each in artefacts]
    if name is None and len(artefacts) > 1:
        raise UlnaInputError(
            f"{study.label}: has {len(artefacts)} artefacts, {', '.join(names)}; expected one to touch. Say which with "
            f"--artefact {names[0]}, or make a plan file of it: ulna plan ARM --make-plan PLAN --study {study.label}."
        )
    if name is not None and name not in names:
        raise UlnaInputError(
            f"option --artefact: got '{name}'; expected one of {', '.join(names)}, as {study.label} has them."
            f"{nearest(name, names)}"
        )
    return artefacts[0 if name is None else names.index(name)]


def _stated(study: Study) -> tuple[F64, float]:
    """(n,) rad of the encoders, and mm of a touch: without them nobody knows what a touch tells."""
    noise = study.noise or Noise()
    lacking = [key for key, value in (("encoder", noise.encoder_rad), ("seat", noise.seat_mm)) if value is None]
    if noise.encoder_rad is None or noise.seat_mm is None:
        raise UlnaInputError(
            f"{study.label}: key 'noise.{lacking[0]}' is missing; expected the standard deviation of the readings to "
            "come, [noise] encoder and seat, by which touches are judged. State it."
        )
    return noise.encoder_rad, noise.seat_mm


def _travel(study: Study, arm: Arm) -> F64:
    """(n, 2) rad."""
    endless = [k for k, joint in enumerate(arm.joints, start=1) if joint.travel_rad is None]
    if endless and not any(len(group) for group in study.readings):
        raise UlnaInputError(
            f"{study.label}: has no readings yet, and joint {endless[0]} of arm '{arm.name}' has no limits; expected "
            "how far each joint turns. Add limits to the arm file, or make a plan file: ulna plan ARM --make-plan PLAN."
        )
    return np.array(travel_read(arm, study))


def _probe(study: Study, arm: Arm, artefact: Artefact, said: str | None) -> str | None:
    """The probe that touched it, or the one said where nothing was; None: the arm's only one."""
    codes = [group.probe for group in study.readings if group.artefact.name == artefact.name]
    names = list(study.arm.probes)
    used: list[str] = [names[code] for code in np.unique(np.concatenate(codes)).tolist()]
    if not used:
        return said
    if len(used) > 1:
        raise UlnaInputError(
            f"{study.label}: artefact '{artefact.name}' was touched with probes {', '.join(used)}; expected one. Make "
            f"a plan file and say which there, plan.probe: ulna plan ARM --make-plan PLAN --study {study.label}."
        )
    if len(arm.probes) == 1:
        return None
    if used[0] not in arm.probes:
        raise UlnaInputError(
            f"{study.label}: artefact '{artefact.name}' was touched with probe '{used[0]}', which arm '{arm.name}' has "
            f"not; expected one of {', '.join(arm.probes)}.{nearest(used[0], arm.probes)} Rename it in the study."
        )
    return used[0]
