"""What a session leaves: its journal, the touches as readings of a study, and the arm that was calibrated with them.

The journal is there from the first touch on; a session that was interrupted goes on from it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl

from ulna.arm.file import arm_toml
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import InputFile, Readings
from ulna.calibration.calibrate import calibrate
from ulna.calibration.result import Result
from ulna.formats.output import output_folder
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.journal import EVENT, TOUCH, WITHDRAWAL, Journal, Reading
from ulna.live.running import RunningFit
from ulna.live.samples import Hello
from ulna.live.touches import Touch, from_dict, held_out
from ulna.simulation.study_files import names_for, study_toml, write_tables
from ulna.study.study import Study

JOURNAL = "session.journal"
RESULT = "result"
FIT, CHECK = "fit", "held out"
SPLIT = {"column": "set", "fit": FIT, "check": CHECK}
"""How a study tells readings to fit from those held out."""


def begin(folder: Path, hello: Hello, **head: object) -> tuple[Journal, list[Touch], str | None]:
    """The journal of a session in a folder, the touches that are in it already, and what was cut off its end, in words.

    Raises UlnaInputError where a session has ended there, or the folder holds something else.
    """
    path = folder / JOURNAL
    if (folder / "study.toml").exists() or (folder / RESULT).exists():
        raise UlnaInputError(
            f"{folder}: a session has ended there (study.toml); expected a folder that is not there yet, or one whose "
            "session was interrupted. Name another."
        )
    if path.exists():
        touches = touches_in(path)
        journal, cut = Journal.open(path)
        return journal, touches, cut
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UlnaInputError(f"{folder}: cannot be made ({error.strerror}). Choose another place.") from None
    return Journal.create(path, hello, **head), [], None


@contextmanager
def nothing_left(folder: Path, anything: Callable[[], bool]) -> Iterator[None]:
    """Where a session is refused before anything came of it, its journal and its folder go. anything: whether something
    did."""
    try:
        yield
    except UlnaInputError:
        if not anything():
            (folder / JOURNAL).unlink(missing_ok=True)
            with suppress(OSError):  # something else is in it
                folder.rmdir()
        raise


def touches_in(path: Path) -> list[Touch]:
    """The touches of a journal, the withdrawn ones with their reason. Raises UlnaInputError."""
    found: dict[int, Touch] = {}
    for record in Reading(path):
        if record.kind == TOUCH:
            touch = from_dict(record.content)
            found[touch.number] = touch
        elif record.kind == WITHDRAWAL:
            number = int(record.content["number"])
            found[number] = replace(found[number], withdrawn=str(record.content["reason"]))
    return list(found.values())


def fresh_places_in(path: Path) -> int:
    """For how many fresh places a session was holding touches out when its journal ended; 0: it was not. Raises
    UlnaInputError."""
    places = 0
    for record in Reading(path):
        if record.kind == EVENT and "held_out" in record.content:
            places = int(record.content["held_out"])
    return places


def write_study(fit: RunningFit, folder: Path) -> tuple[Path, list[str]]:
    """The touches that count as readings, with the arm where it began and the study that names both; and what was left
    out of it, in words: a place of a bar that was touched at one end alone is no reading of a bar. Touches that were
    held out are rows to check. Raises UlnaInputError where there are none."""
    study, held = fit.whole_study(), {str(touch.number) for touch in held_out(fit.touches)}
    left_out: list[str] = []
    groups = [_telling(group, folder, left_out) for group in study.readings]
    study = replace(study, readings=[group for group in groups if len(group)])
    sets = {group.artefact.name: _sets(group, held) for group in study.readings}
    some = any((each == CHECK).any() for each in sets.values())
    names = [name for name in names_for([group.artefact for group in study.readings]) if not name.startswith("truth")]
    with output_folder(folder, names, force=False) as staged:
        (staged / "arm.toml").write_text(arm_toml(study.arm), encoding="utf-8")
        (staged / "study.toml").write_text(study_toml(study, False, SPLIT if some else None), encoding="utf-8")
        write_tables(study, None, staged, sets if some else {})
    return folder / "study.toml", left_out


def _sets(group: Readings, held: set[str]) -> pl.Series:
    """What each row is for."""
    numbers = [] if group.id is None else group.id.tolist()
    return pl.Series(SPLIT["column"], [CHECK if number in held else FIT for number in numbers])


def _telling(group: Readings, folder: Path, left_out: list[str]) -> Readings:
    """Those places of which a study takes readings."""
    kind, code = kind_of(group.artefact), group.placement_code
    keep = np.ones(len(group), dtype=bool)
    for standing in np.unique(code).tolist():
        own = code == standing
        try:
            kind.check_readings(group.select(own), [InputFile(folder, "", 0)], folder)
        except UlnaInputError:
            keep &= ~own
            numbers = ", ".join(group.select(own).id)  # type: ignore[arg-type]
            place = group.select(own).placement[0]
            left_out.append(
                worded(
                    "Place {place} of {artefact}: not all was touched there that makes a reading; the study does "
                    "without touch {numbers}.",
                    place=str(place),
                    artefact=group.artefact.name,
                    numbers=numbers,
                )
            )
    return group.select(keep)


def write_result(study: Path) -> Result:
    """The calibration of a study, beside it. Raises UlnaInputError."""
    result = calibrate(Study.load(study))
    result.save(study.parent / RESULT)
    return result
