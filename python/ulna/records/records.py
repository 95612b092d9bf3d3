"""The record as people use it: `ulna.Records`, and what each of its methods hands on to."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from sqlalchemy import select

from ulna.comparison.compare import Comparison
from ulna.ground.errors import UlnaInputError
from ulna.ground.shown import About, Shown, Table
from ulna.records import asked, compared, copies, filing, listing, rebuild, registering, standing, verify
from ulna.records.acts.setting import NAMES
from ulna.records.advising import Advice, Wanted, advise, decide
from ulna.records.bench import Bench
from ulna.records.copies import Copied
from ulna.records.due import Due, due, today
from ulna.records.entry import Entry
from ulna.records.filed.kind import in_utc
from ulna.records.filing import Filed, Filing
from ulna.records.history import Happening, Outcome, Point, Series, calibrations, figures, history, last_of, series
from ulna.records.impact import Impact, impact
from ulna.records.issuing import Asked, IssuedCertificate, issue
from ulna.records.migrate import migrate
from ulna.records.registering import Value
from ulna.records.tables import EQUIPMENT, PERSON
from ulna.records.trend import Trend, trend

Path_ = str | os.PathLike[str]


class Records(Shown):
    """What became of every arm: files, equipment, events, certificates, in a bench folder.

    Every method raises UlnaInputError for what cannot be used, and where the record cannot be read or written; what is
    written is written whole, and on the disk when the method returns.
    """

    def __init__(self, bench: Bench) -> None:
        self.bench = bench

    @classmethod
    def init(cls, folder: Path_, database: str | None = None, by: str | None = None) -> Records:
        """A new record in a new or empty folder. database: URL of an empty PostgreSQL database; None: SQLite in the
        folder."""
        return cls(Bench.make(Path(folder), database, by))

    @classmethod
    def open(cls, folder: Path_ | None = None, by: str | None = None) -> Records:
        """folder: None: as ULNA_RECORDS or the settings file say. by: who works; None: as ULNA_BY or the settings say,
        else the login's name."""
        return cls(Bench.open(folder, by))

    def worked_by(self, name: str) -> Records:
        """The same record, with somebody else at work."""
        return Records(self.bench.worked_by(name))

    # ------------------------------------------------------------ what there is

    def equipment(self, kind: str | None = None) -> list[dict[str, Any]]:
        """As it is now, by name."""
        with self.bench.reading() as connection:
            rows = asked.rows(connection, asked.newest(EQUIPMENT, "name"))
        found = [dict(row) for row in rows if kind in (None, row["kind"])]
        return sorted(found, key=lambda row: str(row["name"]))  # databases differ in the order of letters

    def history(self, name: str) -> list[Happening]:
        """Everything that was done to one thing, the earliest first."""
        with self.bench.reading() as connection:
            return history(connection, name)

    def figures(self, arm: str, name: str, state: str | None = None, artefact: str | None = None) -> list[Point]:
        """A figure of an arm over time, the earliest first."""
        with self.bench.reading() as connection:
            return figures(connection, asked.equipment(connection, arm)["name"], name, state, artefact)

    def series(self, arm: str) -> list[Series]:
        """Every figure of an arm that is there over time."""
        with self.bench.reading() as connection:
            return series(connection, asked.equipment(connection, arm)["name"])

    def calibrations(self, arm: str) -> list[dict[str, Any]]:
        """Of an arm, the earliest first, without those that were withdrawn."""
        with self.bench.reading() as connection:
            return [dict(row) for row in calibrations(connection, asked.equipment(connection, arm)["name"])]

    def certified(self, artefact: str) -> list[dict[str, Any]]:
        """All that certificates of an artefact ever said, the newest first."""
        with self.bench.reading() as connection:
            return [dict(row) for row in listing.values(connection, artefact)]

    def certificates(self, arm: str | None = None) -> list[dict[str, Any]]:
        """That were issued, of all arms or of one, the newest first, each with its state and why it is so."""
        with self.bench.reading() as connection:
            return [dict(row) for row in listing.certificates(connection, arm)]

    def last_of(self, arm: str, source: str) -> Outcome | None:
        """How the newest check or test of an arm ended: the worst of its figures. source: check, verification."""
        with self.bench.reading() as connection:
            return last_of(connection, asked.equipment(connection, arm)["name"], source)

    def people(self) -> dict[str, tuple[str, ...]]:
        """Everybody who was ever registered, by name, with their roles; none: gone."""
        with self.bench.reading() as connection:
            rows = asked.rows(connection, asked.newest(PERSON, "name"))
        return {str(row["name"]): tuple(row["roles"].split()) for row in sorted(rows, key=lambda row: str(row["name"]))}

    def settings(self) -> dict[str, str]:
        """How the record is kept: four-eyes (yes, no), numbers (a pattern)."""
        with self.bench.reading() as connection:
            return {name: asked.setting(connection, name, usual) for name, usual in NAMES.items()}

    def due(self, on: str | None = None) -> list[Due]:
        """What must come back, the soonest first, seen from a day."""
        with self.bench.reading() as connection:
            return due(connection, today() if on is None else in_utc(on, "day")[:10])

    def impact(self, name: str, since: str | None = None, until: str | None = None) -> Impact:
        """What was done between the last good and the first bad figure of an arm, or between stated times."""
        times = [None if time is None else in_utc(time, what) for time, what in ((since, "since"), (until, "until"))]
        with self.bench.reading() as connection:
            return impact(connection, name, *times)

    def trend(self, arm: str, figure: str, **more: Any) -> Trend:
        """A figure over time: drift, when it meets its limit, whether it is in control. more: state, artefact, since,
        limit, guard, baseline (see `ulna.records.trend`)."""
        if more.get("since") is not None:
            more["since"] = in_utc(more["since"], "since")[:10]
        with self.bench.reading() as connection:
            return trend(connection, arm, figure, **more)

    def advise(self, arm: str, method: str, **more: Any) -> Advice:
        """When an arm should come back. method: staircase, drift, a3; more: figure, limit, guard, target."""
        with self.bench.reading() as connection:
            return advise(connection, Wanted(arm, **more), method)

    def compare(self, arm: str, last: int = 2, probe: str | None = None, shared_u: float = 0.0) -> Comparison:
        """The last calibrations of an arm, each with the next."""
        return compared.compare_last(self.bench, arm, last, probe, shared_u)

    def content(self, sha256: str) -> bytes:
        """A file of the record."""
        try:
            return self.bench.files.get(sha256)
        except ValueError:
            raise UlnaInputError(f"file {sha256[:70]!r}: no SHA-256; expected 64 hex digits. Correct it.") from None

    # ------------------------------------------------------------ what is added

    def register(self, name: str, kind: str = "arm", state: str | None = None, **details: str | None) -> Entry:
        """Equipment: new, or as it is from now on. kind: arm, robot, probe, artefact, thermometer. details: part_of,
        maker, model, serial, firmware, owner, location, remark."""
        return registering.register(self.bench, name, kind, state, details)

    def certify(self, artefact: str, values: Mapping[str, tuple[float, float]], **more: Any) -> Entry:
        """What a certificate says. values: quantity → (value, standard uncertainty), mm. more: certificate (path),
        number, by, valid_from, valid_to, temperature_c, expansion_per_k, expansion_u_per_k."""
        listed = [Value(quantity, value, u) for quantity, (value, u) in values.items()]
        return registering.certify(self.bench, artefact, listed, **more)

    def event(self, name: str, kind: str, text: str, at: str | None = None, file: Path_ | None = None) -> list[Entry]:
        """What happened to equipment: knock, repair, move, adjustment, firmware, quarantine, release, note."""
        return registering.happened(self.bench, name, kind, text, at, None if file is None else Path(file))

    def person(self, name: str, roles: Sequence[str]) -> Entry:
        """Somebody, in which roles from now on: reader, operator, reviewer, admin."""
        return registering.person(self.bench, name, roles)

    def set(self, name: str, value: str) -> Entry:
        """A setting: four-eyes (yes, no), numbers (a pattern)."""
        return registering.set_to(self.bench, name, value)

    def add(
        self,
        *paths: Path_,
        arm: str | None = None,
        at: str | None = None,
        artefacts: Sequence[str] = (),
        with_it: Mapping[str, Path_] | None = None,
        register: bool = False,
    ) -> list[Filed]:
        """Files, all or none; what each is, is found out. at: when it was measured; artefacts: on which of the record
        it rests; with_it: what belongs to it, by role; register: an arm that is not there yet is registered."""
        beside = {role: Path(path) for role, path in (with_it or {}).items()}
        return filing.file_all(self.bench, [Filing(Path(path), arm, at, artefacts, beside, register) for path in paths])

    def interval(self, name: str, days: float, method: str | None = None, why: str | None = None) -> Entry:
        """When equipment must come back, as somebody decided: days from its last calibration or test."""
        return decide(self.bench, name, days, method, why)

    def issue(self, result: str, laboratory: Path_, **more: Any) -> IssuedCertificate:
        """A certificate of a filed calibration, by its SHA-256 or the beginning of it. more: verification, number, form
        ("pdf", "dcc"), language, approved_by, supersedes, reason."""
        return issue(self.bench, Asked(result, Path(laboratory), **more))

    def withdraw(self, subject: str, reason: str) -> Entry:
        """A filed file by its SHA-256 or the beginning of it, or a certificate by its number: it is kept, and counts no
        longer."""
        return standing.withdraw(self.bench, subject, reason)

    # ------------------------------------------------------------ the record itself

    def verify(self, heads: Sequence[str] = ()) -> verify.Verified:
        """Whether it is what was written. heads: "seq:SHA-256" as noted elsewhere."""
        for head in heads:
            verify.check_head(head, "head")
        return verify.verify(self.bench, heads)

    def rebuild(self) -> int:
        """The database anew, from the files; the number of entries."""
        return rebuild.rebuild(self.bench)

    def export(self, path: Path_, force: bool = False) -> Copied:
        """All of it as one zip."""
        return copies.export(self.bench, Path(path), force)

    def backup(self, folder: Path_) -> Copied:
        """An export into a folder, named by the day and the chain's end, and read once more."""
        return copies.backup(self.bench, Path(folder))

    def migrate(self, backup_to: Path_) -> Copied | None:
        """From the schema of an earlier Ulna, after a backup; None where there is nothing to do."""
        return migrate(self.bench, Path(backup_to))

    @classmethod
    def from_export(cls, path: Path_, folder: Path_, database: str | None = None, by: str | None = None) -> Records:
        """A new record with the same chain, from a zip."""
        copies.imported(Path(path), Path(folder), database, by)
        return cls.open(folder, by)

    def about(self) -> About:
        """How many of what."""
        with self.bench.reading() as connection:
            kinds = connection.execute(select(asked.newest(EQUIPMENT, "name").subquery().c.kind)).scalars().all()
        rows = [(kind, str(kinds.count(kind))) for kind in sorted(set(kinds))]
        return About(f"Records in {self.bench.folder}", {}, [Table(("", "registered"), rows)])
