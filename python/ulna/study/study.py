"""The study as everybody above uses it: what it is, and the door to its files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Self

from numpy.typing import ArrayLike

from ulna.arm.given import ArmLike
from ulna.arm.payload import Payload
from ulna.ground.shown import About, Shown
from ulna.study.about import about_study
from ulna.study.data import StudyData
from ulna.study.file import load_study, load_waiting
from ulna.study.frames import Asked, study_of_frame


@dataclass(repr=False)
class Study(Shown, StudyData):
    """What to fit to what."""

    @classmethod
    def load(cls, path: str | Path, rows: Literal["fit", "check", "all"] = "fit") -> Self:
        """Read a study file (`ulna-study/1`) and all that it names. Raises UlnaInputError; warns with InputWarning.

        rows: where the study has a split, the rows to fit, the rows kept to check the fit, or both.
        """
        return load_study(Path(path), rows, cls)

    @classmethod
    def waiting(cls, path: str | Path) -> Self:
        """A study file whose readings are still to come: of each of its artefacts there is none. Raises
        UlnaInputError."""
        return load_waiting(Path(path), cls)

    @classmethod
    def from_frame(
        cls,
        arm: ArmLike,
        frame: Any,
        artefacts: Any,
        *,
        angle: Literal["rad", "deg", "counts"] | None = None,
        length_unit: Literal["mm", "m", "in"] | None = None,
        columns: Mapping[str, str] | None = None,
        names: Mapping[str, Mapping[str, str | Sequence[str]]] | None = None,
        guess: bool = False,
        artefact: str | None = None,
        probe: str | None = None,
        placement: str | None = None,
        feature: str | None = None,
        payload: str | None = None,
        approach: Literal["column", "order"] | None = None,
        ignore: Sequence[str] | None = None,
        where: Mapping[str, Any] | None = None,
        split: Mapping[str, Any] | None = None,
        rows: Literal["fit", "check", "all"] = "fit",
        encoder_u_rad: ArrayLike | None = None,
        seat_u_mm: float | None = None,
        payloads: Mapping[str, Payload] | None = None,
        **fit: Any,
    ) -> Self:
        """A study of readings in memory; the same numbers in a file give the same study, to the last digit.

        arm: an arm, a result, or a path of one.
        frame: a row for each touch, columns as of a readings file (``q1 … qn``, ``feature``, ``placement``, …): a
        pandas or polars DataFrame, an Arrow table, a dict of arrays (an array (N, n) under ``q`` makes ``q1 … qn``), a
        structured array or a list of dicts.
        artefacts: what was touched, by name, as tables with the keys of a study file, ``{"bar": {"kind": "bar",
        "length_mm": 443.172}}``, or as `Artefact`; a single table may stand alone.
        angle, length_unit: where the names do not say them (``q1_deg``, ``"q1 [deg]"``, ``x_mm``); never guessed.
        columns: Ulna's name = the frame's; names: of a column with labels, Ulna's name = what stands in the cells.
        guess: recognise columns by their headings and what stands in them, as `ulna new` does; what each was taken for,
        and why, is in `taken` and in how the study shows itself. What leaves a doubt is an error that asks.
        artefact, probe, placement, feature, payload: of all rows, where there is no such column. approach, ignore,
        where, split: as in a study's ``[[readings]]``; rows: which side of the split.
        encoder_u_rad: standard deviation of an encoder's reading, one or (n,); seat_u_mm: of a touch, per coordinate.
        payloads: what the arm carried beside its own masses, by name, ``{"gripper": Payload(2.5, (0, 0, 80))}``, beside
        the arm's own.
        fit: fields of `FitOptions`, such as ``hold=["joint.1.d"]``.

        Raises UlnaInputError naming the row and column of what cannot be used; TypeError for what is no table; warns
        with InputWarning.
        """
        said: dict[str, Any] = {
            "columns": columns,
            "names": names,
            "artefact": artefact,
            "probe": probe,
            "placement": placement,
        }
        said |= {"feature": feature, "payload": payload, "approach": approach, "where": where, "split": split}
        said |= {"ignore": None if ignore is None else list(ignore), "angle": angle}
        keys = {key: value for key, value in said.items() if value is not None}
        asked = Asked(angle, length_unit, guess, rows, keys, encoder_u_rad, seat_u_mm, payloads or {}, fit)
        return study_of_frame(arm, frame, artefacts, asked, cls)

    def about(self) -> About:
        """What is fitted to what."""
        return about_study(self)
