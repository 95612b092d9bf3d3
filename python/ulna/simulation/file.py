"""Simulation files: `ulna-simulation/1`, TOML: a true arm, what it touches, and how all of it errs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from ulna.arm.arm import Arm
from ulna.arm.conditions import PAYLOAD, TEMPERATURE
from ulna.arm.payload import NOTHING_CARRIED, joined_payloads, payloads_of
from ulna.arm.stated import encoder_of, one_per_joint, travel_of, volume_of
from ulna.artefacts.kinds import KINDS, check_kinds, made
from ulna.artefacts.tables import Place, TouchedTable
from ulna.formats.models import fill
from ulna.formats.toml import check_format, read_toml
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError
from ulna.simulation.spec import Drawing, Missed, Simulation, Temperature, Touching
from ulna.simulation.tables import DrawingTable, SimulationFile, TemperatureTable
from ulna.study.data import FitOptions
from ulna.study.readings.payloads import check_carried

WHAT = 'a simulation file (TOML, format = "ulna-simulation/1")'


def load_simulation(path: Path) -> Simulation:
    """Read what to simulate, and the true arm that it names. Raises UlnaInputError."""
    document, _ = read_toml(path, WHAT)
    check_format(document, path, "ulna-simulation")
    check_kinds(document, path)
    file = fill(SimulationFile, document, path)
    units, arm_path = file.units, path.parent / file.arm
    arm = _counted(file, Arm.load(arm_path), path)
    arm = replace(arm, payloads=joined_payloads(arm.payloads, payloads_of(file.payload, units, path), path))
    place = Place(path, units, [])
    touching = [_touching(name, table, place) for name, table in file.artefact.items()]
    encoder = file.noise.encoder
    return Simulation(
        arm=arm,
        touching=touching,
        seed=file.seed,
        drawing=_drawing(file.drawing, units),
        encoder_rad=None if encoder is None else encoder_of(encoder, arm, units, path),
        seat_mm=file.noise.seat * units.mm,
        quantised=file.noise.quantise,
        travel_rad=travel_of(file.travel, arm, units, path),
        temperature=_temperature(file.temperature, arm, path),
        carried=_carried(file.carried, arm, path),
        missed=None if file.missed is None else Missed(file.missed.share, file.missed.size * units.mm),
        volume_mm=volume_of(file.volume, units, path),
        fit=FitOptions(**file.fit.model_dump()),
        path=path,
        files=(path, arm_path, *(each.path for each in place.files)),
    )


def _touching(name: str, table: TouchedTable, place: Place) -> Touching:
    kind = KINDS[table.kind]
    kind.check_simulated(table, f"{place.path}: key 'artefact.{name}")
    artefact = made(name, table, place)
    given = () if table.probe is None else (table.probe,) if isinstance(table.probe, str) else tuple(table.probe)
    return Touching(
        artefact=artefact,
        placements=table.placements or (1 if artefact.frame == "arm" else kind.placements),
        touches=table.touches or kind.touches,
        probes=given,
        size_mm=table.size_mm(place.units.mm) or kind.size_mm,
    )


def _drawing(table: DrawingTable | str, units: Units) -> Drawing | None:
    if isinstance(table, str):
        return None
    usual = Drawing()
    return Drawing(
        offset_rad=usual.offset_rad if table.offset is None else table.offset * units.rad,
        length_mm=usual.length_mm if table.length is None else table.length * units.mm,
        twist_rad=None if table.twist is None else table.twist * units.rad,
        effects=table.effects,
    )


def _counted(file: SimulationFile, arm: Arm, path: Path) -> Arm:
    given = file.noise.counts_per_turn
    if given is None:
        return arm
    each = one_per_joint(given, arm, "noise.counts_per_turn", path)
    joints = [replace(joint, counts_per_turn=float(counts)) for joint, counts in zip(arm.joints, each, strict=True)]
    return replace(arm, joints=tuple(joints))


def _temperature(table: TemperatureTable | None, arm: Arm, path: Path) -> Temperature | None:
    if table is None:
        return None
    if TEMPERATURE not in arm.needs:
        raise UlnaInputError(
            f"{path}: key 'temperature': nothing of arm '{arm.name}' grows with temperature; expected expansion (1/K) "
            "of its joints in the arm file. Add it, or remove the key."
        )
    return Temperature(table.mean, table.spread)


def _carried(given: str | list[str] | None, arm: Arm, path: Path) -> tuple[str, ...]:
    names = () if given is None else (given,) if isinstance(given, str) else tuple(given)
    if not names and PAYLOAD not in arm.needs:
        return ()
    if PAYLOAD not in arm.needs:
        gives_way = PAYLOAD in arm.uses
        what = "no load is stated" if gives_way else f"arm '{arm.name}' bends under no load"
        raise UlnaInputError(
            f"{path}: key 'carried': {what}; expected compliance of joints in the arm file, and [payload.NAME] with "
            "mass and centre. Add what is missing, or remove the key."
        )
    if not names:
        raise UlnaInputError(
            f"{path}: key 'carried' is missing: arm '{arm.name}' may carry {', '.join(arm.payloads)}; expected which "
            f"of them it carries, or '{NOTHING_CARRIED}'. Add it: one, or a list of which each placement has one."
        )
    for name in names:
        check_carried(name, arm, f"{path}: key 'carried'")
    return names
