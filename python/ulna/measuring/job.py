"""One run over a file of readings: columns checked first, then piece by piece angles, points, uncertainties."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ulna.arm.conditions import CONDITIONS, PAYLOAD, Condition, Conditions, some_of
from ulna.arm.given import ArmLike, arm_and_noise
from ulna.arm.payload import NOTHING_CARRIED
from ulna.formats.header import Header, Piece
from ulna.formats.layout import AS_EXPECTED, Layout
from ulna.formats.table import count_rows, named_header, read_header, stream
from ulna.formats.tables.coming import ComingTable
from ulna.formats.units import MM_PER
from ulna.ground.arrays import F64, I64, Progress
from ulna.ground.errors import InputWarning, UlnaInputError, nearest
from ulna.measuring.tip_uncertainty import COVARIANCE, DIAGONAL, TipUncertainty
from ulna.measuring.units import rad_per
from ulna.study.readings.checks import Outside, check_scale
from ulna.study.readings.columns import check_columns, known_columns
from ulna.study.readings.conditions import check_values, columns_of, doubt_values
from ulna.study.readings.readings import WHAT as WHAT_READINGS


@dataclass(frozen=True)
class Whole:
    """Readings of N poses, all of them."""

    q_rad: F64
    """(N, n)"""
    probe: I64
    """(N,) index into the arm's probes."""
    conditions: Conditions
    texts: dict[str, pl.Series]
    """`id` and `probe`, where the table has them."""


class MeasureJob:
    """One run of `measure`: knows the columns before the first row is read."""

    def __init__(
        self,
        arm: ArmLike,
        readings: Path | Header,
        probe: str | None = None,
        angle: str = "rad",
        units: str = "mm",
        encoder_u_rad: F64 | None = None,
        layout: Layout = AS_EXPECTED,
        temperature_c: float | None = None,
        covariance: bool = False,
        unused: Collection[str] = (),
        payload: str | None = None,
    ) -> None:
        """readings: a file, or a table that is open already; unused: its own names of columns of which nothing is said.
        Raises UlnaInputError for whatever is wrong before the first row."""
        self.arm, noise = arm_and_noise(arm)
        if units not in MM_PER:
            raise UlnaInputError(f"measure: unit '{units}'; expected mm, m or in.{nearest(units, MM_PER)}")
        self.unit = units
        known = known_columns(self.arm.n, False)
        self.header: Header = (
            named_header(readings, layout, known)
            if isinstance(readings, Header)
            else read_header(readings, WHAT_READINGS, layout, known)
        )
        self._angle = angle
        self._rad_per = rad_per(self.arm, angle, self.header)
        self._q = [f"q{k + 1}" for k in range(self.arm.n)]
        remarks: list[str] = []
        asked = [column for column in map(self.header.find, unused) if column is not None]
        check_columns(self.header, self.arm.n, self.arm.name, remarks, asked=asked)
        self._given = {"temperature_c": temperature_c, "payload": payload}
        self._columns = self._needed(remarks)
        said = [(each.text, column) for each, columns in self._columns.items() for column in columns]
        self._numbers = [*self._q, *(column for text, column in said if not text)]
        self._texts: list[str] = [name for name in ("id", "probe") if name in self.header.columns]
        self._names = [*self._texts, *(column for text, column in said if text)]
        self._probe = self._fixed_probe(probe, remarks)
        if "p1" in self.header.columns:
            remarks.append(f"{self.header.path}: two poses a row: only those of q1 … q{self.arm.n} are measured.")
        for remark in remarks:
            warnings.warn(remark, InputWarning, stacklevel=2)
        self._covariance = covariance
        self._uncertainty: TipUncertainty | None = None
        if self.arm.uncertainty is not None:
            self._uncertainty = TipUncertainty(self.arm, noise.stated(encoder_u_rad))
        elif covariance:
            raise UlnaInputError(
                f"{arm if isinstance(arm, str | Path) else self.arm.name}: no uncertainty is known of this arm, so its "
                "points have no covariance; expected the result.json of a calibration. Name it, or leave --covariance "
                "out."
            )
        self._outside = Outside(self.arm, "q")
        self._seen: set[Condition] = set()
        self.rows = 0

    @property
    def columns(self) -> list[str]:
        """Of the output."""
        u = [] if self._uncertainty is None else ["u_x", "u_y", "u_z"]
        matrix = list(COVARIANCE) if self._covariance else []
        return [*self._texts, "x", "y", "z", *u, *matrix]

    @property
    def coming(self) -> bool:
        """Whether the readings come as they are made, so that none can be read twice."""
        return isinstance(self.header, ComingTable)

    def check(self) -> None:
        """Read all readings once without measuring. Raises UlnaInputError for the first bad cell: for outputs that
        cannot be taken back."""
        for piece in self._pieces():
            self._angles(piece)
            self._probes(piece)
            self._conditions(piece)
        self._outside = Outside(self.arm, "q")

    def frames(self, progress: Progress | None = None) -> Iterator[pl.DataFrame]:
        """The output in pieces. Warns with InputWarning of readings outside the joints' limits."""
        total = count_rows(self.header)
        for piece in self._pieces():
            yield self._measured(piece)
            self.rows += len(piece)
            if progress is not None:
                progress("measure", self.rows, total)
        if not self.rows:
            raise UlnaInputError(f"{self.header.path}: the table has no rows; expected a reading in each.")
        self._warn_of_limits()

    def whole(self) -> Whole:
        """All readings at once. Raises UlnaInputError; warns as `frames`."""
        pieces = list(self._pieces())
        parts = [(self._angles(each), self._probes(each), self._conditions(each)) for each in pieces]
        if not parts:
            raise UlnaInputError(f"{self.header.path}: the table has no rows; expected a reading in each.")
        self._warn_of_limits()
        probe = np.concatenate([np.broadcast_to(np.asarray(own, dtype=np.int64), len(q)) for q, own, _ in parts])
        conditions = Conditions()
        for key in parts[0][2]:
            conditions[key] = np.concatenate([said[key] for _, _, said in parts])  # type: ignore[literal-required]
        texts: dict[str, pl.Series] = {name: pl.concat([each.texts[name] for each in pieces]) for name in self._texts}
        return Whole(np.concatenate([q for q, _, _ in parts]), probe, conditions, texts)

    def _warn_of_limits(self) -> None:
        for remark in self._outside.remarks(self.header.path):
            warnings.warn(f"{remark} They are measured all the same.", InputWarning, stacklevel=3)

    @property
    def notes(self) -> list[str]:
        """Why uncertainties were left empty; complete when `frames` are used up."""
        return [] if self._uncertainty is None else self._uncertainty.notes

    def _pieces(self) -> Iterator[Piece]:
        return stream(self.header, self._numbers, self._names)

    def _measured(self, piece: Piece) -> pl.DataFrame:
        q_rad = self._angles(piece)
        probe = self._probes(piece)
        conditions = self._conditions(piece)
        p_mm = self.arm.core.tip(q_rad, probe, **conditions)
        values = [p_mm / MM_PER[self.unit]]
        if self._uncertainty is not None:
            c_mm2 = np.empty((len(p_mm), 6))
            for k in np.unique(probe):
                rows = slice(None) if isinstance(probe, int) else np.flatnonzero(probe == k)
                at = some_of(conditions, rows)
                c_mm2[rows] = self._uncertainty.covariance(np.ascontiguousarray(q_rad[rows]), int(k), at)
            values.append(np.sqrt(np.maximum(c_mm2[:, DIAGONAL], 0.0)) / MM_PER[self.unit])
            if self._covariance:
                values.append(c_mm2 / MM_PER[self.unit] ** 2)
        numbers = np.concatenate(values, axis=1)
        columns = {name: piece.texts[name] for name in self._texts}
        for k, name in enumerate(self.columns[len(self._texts) :]):
            columns[name] = pl.Series(name, np.ascontiguousarray(numbers[:, k]), nan_to_null=True)
        return pl.DataFrame(columns)

    def _angles(self, piece: Piece) -> F64:
        q = np.ascontiguousarray(piece.numbers[:, : self.arm.n])
        q_rad = q if (self._rad_per == 1.0).all() else q * self._rad_per
        row = np.arange(piece.before + 1, piece.before + len(q) + 1)
        check_scale(q_rad, "q", self.arm, self._rad_per, self._angle, self.header, row, "Say the unit with --angle.")
        self._outside.add(q_rad, row)
        return q_rad

    def _conditions(self, piece: Piece) -> Conditions:
        """Raises UlnaInputError for a cell that says what cannot be."""
        said: dict[str, Any] = dict(self._given)
        row = np.arange(piece.before + 1, piece.before + 1 + len(piece))
        for condition, columns in self._columns.items():
            if condition.text:
                said[condition.said] = self._loads(piece, columns[0])
                continue
            at = self._numbers.index(columns[0])
            values = np.ascontiguousarray(piece.numbers[:, at : at + len(columns)])
            check_values(values, columns, condition, self.header, row)
            if condition not in self._seen:
                self._seen.add(condition)
                doubt_values(values, columns, condition, self.header)
            said[condition.said] = values[:, 0] if columns == [condition.name] else values
        return self.arm.conditions(len(piece), **said)

    def _needed(self, remarks: list[str]) -> dict[Condition, list[str]]:
        """The columns that say what points depend on beside angles. Raises UlnaInputError where nothing says it."""
        found: dict[Condition, list[str]] = {}
        for condition in CONDITIONS:
            if self._given.get(condition.said) is not None and condition not in self.arm.uses:
                remarks.append(f"arm '{self.arm.name}': {condition.vain}; the {condition.name} is not used.")
        self.arm.loads_of(self._given["payload"] if PAYLOAD in self.arm.uses else None)
        for condition, effect in self.arm.uses.items():
            columns = columns_of(condition, condition.name, self.header.columns, self.arm.n)
            given = self._given.get(condition.said)
            if not columns and given is None and condition not in self.arm.needs:
                continue
            if not columns and given is None:
                raise UlnaInputError(
                    f"{self.header.path}: no column '{condition.name}{'' if condition.common else 1}', but the "
                    f"{effect.whose} of arm '{self.arm.name}' {effect.does}; expected {condition.columns}. Add it"
                    f"{f', or give {condition.option} for all' if condition.option else ''}."
                )
            if columns and given is not None:
                remarks.append(
                    f"{self.header.path}: the {condition.name} given for all is not used: the file has its own."
                )
            if columns:
                found[condition] = columns
        return found

    def _probes(self, piece: Piece) -> int | NDArray[np.int64]:
        return self._index(piece, "probe", list(self.arm.probes)) if self._probe is None else self._probe

    def _loads(self, piece: Piece, column: str) -> F64:
        """(N, 4) what was carried."""
        names = [*self.arm.payloads, NOTHING_CARRIED]
        loads: F64 = np.array([self.arm.load_named(name) for name in names])[self._index(piece, column, names)]
        return loads

    def _index(self, piece: Piece, name: str, names: list[str]) -> NDArray[np.int64]:
        """(N,) into names, of a column of them. Raises UlnaInputError for one that is none."""
        column = piece.texts[name]
        index = column.replace_strict(names, list(range(len(names))), default=-1, return_dtype=pl.Int64).to_numpy()
        if (index < 0).any():
            row = int(np.argmax(index < 0))
            raise UlnaInputError(
                f"{self.header.path}: {self.header.at(piece.before + row + 1, name)}: arm "
                f"'{self.arm.name}' has no {name} '{column[row]}'.{nearest(str(column[row]), names)}"
            )
        return np.ascontiguousarray(index)

    def _fixed_probe(self, probe: str | None, remarks: list[str]) -> int | None:
        if "probe" not in self.header.columns:
            if probe is None and len(self.arm.probes) > 1:
                raise UlnaInputError(
                    f"{self.header.path}: no column 'probe', and arm '{self.arm.name}' has {len(self.arm.probes)} "
                    f"probes; say which is on: --probe {' or --probe '.join(self.arm.probes)}."
                )
            return self.arm.probe_index(probe)
        if probe is not None:
            self.arm.probe_index(probe)
            remarks.append(f"{self.header.path}: --probe {probe} is not used: the file has its own column 'probe'.")
        return None
