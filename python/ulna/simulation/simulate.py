"""Simulate: a virtual arm with known truth touches artefacts, and its readings become a study, ready to calibrate."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.attitudes import attitudes
from ulna.arm.effects.effects import without
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import Readings
from ulna.artefacts.touching import Touches
from ulna.formats.output import output_folder, refuse_inputs
from ulna.ground.arrays import F64, Progress
from ulna.ground.errors import UlnaInputError
from ulna.ground.shown import About, Shown
from ulna.simulation.account import account
from ulna.simulation.mover import Mover
from ulna.simulation.reading_errors import ReadingErrors, as_drawn
from ulna.simulation.spec import Simulation, Touching
from ulna.simulation.standing import Standings, stand
from ulna.simulation.study_files import names_for, texts, write_tables
from ulna.simulation.touches import probes_of, touches_of
from ulna.simulation.truth import TrueTouching, Truth
from ulna.study.data import Noise
from ulna.study.given import StandsForStudy
from ulna.study.study import Study


@dataclass(frozen=True, repr=False)
class Simulated(Shown, StandsForStudy):
    """A study, and the truth behind it."""

    simulation: Simulation
    study: Study
    """Ready for `calibrate`: the arm as drawn, the readings, the stated noise."""
    truth: Truth

    def as_dict(self) -> dict[str, Any]:
        """`truth.json`: JSON types only, no NaN."""
        return account(self.simulation, self.study, self.truth)

    def its_study(self) -> Study:
        """The study."""
        return self.study

    def about(self) -> About:
        """The study; the truth is in `.truth`."""
        found = self.study.about()
        return About(
            f"Simulated: {found.title[0].lower()}{found.title[1:]}, seed {self.simulation.seed}",
            found.facts,
            found.tables,
            found.notes,
        )

    @property
    def files(self) -> list[str]:
        """Names of the files that `save` writes."""
        return names_for(group.artefact for group in self.study.readings)

    def save(self, folder: str | Path, force: bool = False) -> None:
        """Write arm.toml, study.toml, the readings of each artefact (NAME.csv; of points NAME-features.csv as well),
        truth.toml (the true arm) and truth.json. Raises UlnaInputError; nothing that was read is overwritten."""
        folder = Path(folder)
        refuse_inputs((folder / name for name in self.files), self.simulation.files)
        with output_folder(folder, self.files, force) as staging:
            for name, text in texts(self.study, self.truth.arm, self.as_dict()).items():
                (staging / name).write_text(text, encoding="utf-8")
            write_tables(self.study, self.simulation.step_rad, staging)


def simulate(simulation: Simulation | str | Path, progress: Progress | None = None) -> Simulated:
    """Simulate what a specification says, or the file `ulna-simulation/1` that holds it.

    `progress` is called with (stage, done, total). The same seed gives the same numbers; each artefact has draws of its
    own. Raises UlnaInputError where probes do not fit or an artefact is out of reach; KeyboardInterrupt.
    """
    if not isinstance(simulation, Simulation):
        from ulna.simulation.file import load_simulation

        simulation = load_simulation(Path(simulation))
    if simulation.arm.unknown_signs.any():
        raise UlnaInputError(
            f"{simulation.label}: arm '{simulation.arm.name}': the sign of a joint is 0 (not known); expected 1 or -1 "
            "of every joint: this arm is the truth. State it."
        )
    _check_names(simulation)
    mover = Mover(simulation.arm, _checked_travel(simulation))
    probes = [probes_of(touching, simulation.arm, simulation.label) for touching in simulation.touching]
    readings, touchings = [], []
    for number, touching in enumerate(simulation.touching):
        stated = touching.artefact
        true = kind_of(stated).drawn(stated, np.random.default_rng([simulation.seed, number, 1]))
        touches = touches_of(touching, true, simulation.arm, probes[number])
        standings = stand(simulation, mover, touching, touches, number, progress)
        rng = np.random.default_rng([simulation.seed, number, 2])
        readings.append(_readings(simulation, touching, true, touches, standings, rng))
        touchings.append(TrueTouching(true, standings))
    u_rad, seat_mm = simulation.reading_u_rad, simulation.seat_mm or None
    noise = None if u_rad is None and seat_mm is None else Noise(u_rad, seat_mm)
    study = Study(None, drawn(simulation), readings, noise, simulation.fit)
    return Simulated(simulation, study, Truth(simulation.arm, touchings))


def drawn(simulation: Simulation) -> Arm:
    """The arm as it is written down."""
    arm, drawing = simulation.arm, simulation.drawing
    if drawing is None:
        return replace(arm, uncertainty=None)
    if not drawing.effects:
        joints = [replace(joint, effects=without(joint.effects)) for joint in arm.joints]
        arm = replace(arm, joints=tuple(joints))
    rng = np.random.default_rng([simulation.seed, 0, 3])
    return as_drawn(arm, rng, drawing.offset_rad, drawing.length_mm, drawing.twist_rad)


def _check_names(simulation: Simulation) -> None:
    """Each artefact gives a file its name. Raises UlnaInputError for two that some disks do not tell apart."""
    seen: dict[str, str] = {}
    for touching in simulation.touching:
        name = touching.artefact.name
        other = seen.setdefault(name.casefold().removesuffix("-features"), name)
        if other != name:
            raise UlnaInputError(
                f"{simulation.label}: artefacts '{other}' and '{name}' would give their files the same name on some "
                "disks; expected names that differ by more. Rename one."
            )


def _checked_travel(simulation: Simulation) -> F64:
    limits_rad = simulation.limits_rad
    for k, (low, high) in enumerate(limits_rad.tolist(), start=1):
        if not low < high:
            raise UlnaInputError(
                f"{simulation.label}: joint {k} of arm '{simulation.arm.name}' has no travel left: the encoder's noise "
                "and one count are as wide as its limits; expected a wider travel or less noise. Correct it."
            )
    return limits_rad


def _readings(
    simulation: Simulation,
    touching: Touching,
    true: Artefact,
    touches: Touches,
    standings: Standings,
    rng: np.random.Generator,
) -> Readings:
    """What the encoders read, row after row."""
    places, per, n = standings.q_rad.shape
    encoder_rad = np.zeros(n) if simulation.encoder_rad is None else simulation.encoder_rad
    read_rad = ReadingErrors(encoder_rad, simulation.seat_mm, simulation.step_rad).read(standings.q_rad, rng)
    kind = kind_of(true)
    each = per // kind.poses  # rows of a placement
    rows, pairs = places * each, kind.poses == 2
    measured_mm = kind.measured_mm(touching.artefact, true, touches, places, rng)
    of_row = slice(None, None, kind.poses)
    labels = np.arange(1, places + 1).astype(str).astype(object)
    seen = _seen(simulation, touching.artefact, true, touches, standings, rng) if kind.turned else None
    return Readings(
        artefact=touching.artefact,
        q_rad=np.ascontiguousarray(read_rad[:, of_row].reshape(rows, n)),
        p_rad=np.ascontiguousarray(read_rad[:, 1::2].reshape(rows, n)) if pairs else None,
        length_mm=measured_mm,
        probe=np.tile(touches.probe[of_row], places),
        feature=np.tile(touches.feature[of_row], places),
        placement=np.repeat(labels, rows // places),
        row=np.arange(1, rows + 1),
        file=np.zeros(rows, np.int64),
        rotation_rad=None if seen is None else seen[0],
        rotation_u_rad=None if seen is None else seen[1],
        **_said(standings, per, kind.poses),
    )


def _seen(
    simulation: Simulation,
    stated: Artefact,
    true: Artefact,
    touches: Touches,
    standings: Standings,
    rng: np.random.Generator,
) -> tuple[F64, F64 | None] | None:
    """What an instrument says of a target on the last link, row after row."""
    places, per, n = standings.q_rad.shape
    q_rad = np.ascontiguousarray(standings.q_rad.reshape(places * per, n))
    conditions = simulation.arm.conditions(places * per, **_said(standings, per, 1))
    held = attitudes(simulation.arm.core, q_rad, np.tile(touches.probe, places), conditions)
    return kind_of(true).seen(stated, true, held, np.repeat(standings.axes, per, axis=0), rng)


def _said(standings: Standings, per: int, poses: int) -> dict[str, Any]:
    """What the readings say of conditions, by their fields; per: touches of a placement."""
    said: dict[str, Any] = {}
    for condition, drawn in standings.drawn.items():
        each = condition.of_touches(drawn, per)
        for pose, name in enumerate(list(condition.fields.values())[:poses]):
            said[name] = np.ascontiguousarray(each[pose::poses])
    return said
