"""What became of one thing: everything that was done to it, and its figures over time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

from sqlalchemy import Connection, func, select

from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import listed, worded
from ulna.records import asked
from ulna.records.acts.registry import ACTS
from ulna.records.acts.standing import WITHDRAWN
from ulna.records.chain import walk
from ulna.records.entry import Entry
from ulna.records.filed.kind import BAD, GOOD, OUT
from ulna.records.tables import CALIBRATION, FIGURE, PARAMETER, STANDING

PARAMETERS = "parameter"
"""What stands for the state of a parameter's values over time."""


@dataclass(frozen=True)
class Happening:
    """One line of a history."""

    at: str
    """When it was, as it was stated; ISO 8601, UTC."""
    what: str
    text: str
    by: str
    seq: int
    """Of the entry."""
    sha256: str | None = None
    """Of the file, where there is one."""


@dataclass(frozen=True)
class Point:
    """A figure at one time. Lengths mm."""

    at: str
    value: float
    unit: str
    u: float | None
    k: float | None
    limit: float | None
    verdict: str | None
    source: str
    state: str
    artefact: str | None
    sha256: str


def history(connection: Connection, name: str) -> list[Happening]:
    """Everything of one thing, the earliest first. Raises UlnaInputError where it is not registered."""
    row = asked.equipment(connection, name)
    own = [
        _without_what_stayed(entry, earlier) for entry, earlier in _with_earlier(walk(connection, subject=row["name"]))
    ]
    found = [_happening(entry) for entry in own if entry is not None]
    found += [
        _happening(entry)
        for act in ("issued", "standing")
        for entry in walk(connection, act=act)
        if entry.stated.get("arm") == row["name"] and entry.subject != row["name"]
    ]
    return sorted(found, key=lambda each: (each.at, each.seq))


def _with_earlier(entries: Iterable[Entry]) -> Iterator[tuple[Entry, Entry | None]]:
    """Each entry, and the one before it that said how the equipment is."""
    earlier = None
    for entry in entries:
        yield entry, earlier
        earlier = entry if entry.act == "equipment" else earlier


def _without_what_stayed(entry: Entry, earlier: Entry | None) -> Entry | None:
    """Of how equipment is, what is new; None where an event said it already, and that is all."""
    if entry.act != "equipment" or earlier is None:
        return entry
    new = {key: value for key, value in entry.stated.items() if earlier.stated.get(key) != value}
    return replace(entry, stated=new) if set(new) - {"state"} else None


def _happening(entry: Entry) -> Happening:
    at = str(entry.stated.get("at") or entry.at)
    sha256 = entry.files.get("file") or entry.files.get("certificate")
    what = str(entry.stated.get("kind") or ACTS[entry.act].said) if entry.act in _BY_KIND else ACTS[entry.act].said
    return Happening(at, what, _TEXTS[entry.act](entry), entry.actor, entry.seq, sha256)


_BY_KIND = ("filed", "event")
"""Acts whose own word says less than what kind it was."""


def _filed(entry: Entry) -> str:
    rests = ", ".join(entry.stated.get("artefacts", ()))
    file = str(entry.stated["names"]["file"])
    return worded("{file}, on {artefacts}", file=file, artefacts=rests) if rests else file


def _equipment(entry: Entry) -> str:
    said = {key: value for key, value in entry.stated.items() if key not in ("kind", "state", "names")}
    details = ", ".join(f"{key} {value}" for key, value in said.items())
    return ", ".join(each for each in (entry.stated.get("kind"), entry.stated.get("state"), details) if each)


def _certified(entry: Entry) -> str:
    stated = entry.stated
    said = [f"{v['quantity']} {v['value']:.10g} {v['unit']}, u {v['u']:.2g}" for v in stated["values"]]
    if "number" in stated:
        said.append(worded("certificate {number}", number=stated["number"]))
    if "valid_to" in stated:
        said.append(worded("valid to {day}", day=stated["valid_to"]))
    return listed(said)


def _issued(entry: Entry) -> str:
    said = worded("certificate {number}", number=entry.subject)
    if not entry.stated.get("supersedes"):
        return said
    return listed([said, worded("supersedes {number}", number=entry.stated["supersedes"])])


def _standing(entry: Entry) -> str:
    of_file = len(entry.subject) == 64
    what = f"{entry.subject[:12]}…" if of_file else worded("certificate {number}", number=entry.subject)
    state, reason = entry.stated["state"], entry.stated["reason"]
    if state == WITHDRAWN:
        return worded("{what} withdrawn: {reason}", what=what, reason=reason)
    return f"{what} {state}: {reason}"


_TEXTS: dict[str, Callable[[Entry], str]] = {
    "filed": _filed,
    "equipment": _equipment,
    "certified": _certified,
    "event": lambda entry: str(entry.stated["text"]),
    "person": lambda entry: ", ".join(entry.stated["roles"]),
    "setting": lambda entry: str(entry.stated["value"]),
    "issued": _issued,
    "standing": _standing,
    "interval": lambda entry: worded(
        "{days} days ({method})", days=f"{entry.stated['days']:.0f}", method=entry.stated["method"]
    ),
}


def withdrawn() -> Any:
    """SQL: the SHA-256 of files that no longer stand."""
    return select(STANDING.c.subject).where(STANDING.c.state == WITHDRAWN)


@dataclass(frozen=True)
class Series:
    """A figure that is there over time."""

    name: str
    state: str
    artefact: str | None
    count: int
    last: str
    """When the newest is of; ISO 8601, UTC."""

    @property
    def said(self) -> str:
        """In words."""
        of = f" of {self.artefact}" if self.artefact else ""
        return f"{self.name}{of} ({self.state})"


def series(connection: Connection, arm: str) -> list[Series]:
    """Of an arm, by name, without files that were withdrawn."""
    columns = FIGURE.c.name, FIGURE.c.state, FIGURE.c.artefact
    asked_for = (
        select(*columns, func.count(), func.max(FIGURE.c.at))
        .where(FIGURE.c.arm == arm, FIGURE.c.sha256.not_in(withdrawn()))
        .group_by(*columns)
    )
    found = [Series(*row) for row in connection.execute(asked_for)]
    return sorted(found, key=lambda each: (each.name, each.state, each.artefact or ""))


def figures(
    connection: Connection, arm: str, name: str, state: str | None = None, artefact: str | None = None
) -> list[Point]:
    """A figure of an arm, or a parameter of its calibrations, over time, the earliest first, without files that were
    withdrawn. Raises UlnaInputError where there is none."""
    asked_for = (
        select(FIGURE)
        .where(FIGURE.c.arm == arm, FIGURE.c.name == name, FIGURE.c.sha256.not_in(withdrawn()))
        .order_by(FIGURE.c.at, FIGURE.c.seq, FIGURE.c.line)
    )
    if state is not None:
        asked_for = asked_for.where(FIGURE.c.state == state)
    if artefact is not None:
        asked_for = asked_for.where(FIGURE.c.artefact == artefact)
    found = [_point(row) for row in asked.rows(connection, asked_for)]
    if not found and artefact is None and state in (None, PARAMETERS):
        found = _of_parameter(connection, arm, name)
    if not found:
        known = series(connection, arm)
        same = [each.said for each in known if each.name == name] or [each.said for each in known]
        of = (f" ({artefact})" if artefact else "") + (f" in the state '{state}'" if state else "")
        raise UlnaInputError(f"record: no figure '{name}'{of} of '{arm}'.{nearest(name, same)}")
    return found


def _of_parameter(connection: Connection, arm: str, name: str) -> list[Point]:
    """Of calibrations that converged and determined it."""
    asked_for = (
        select(PARAMETER)
        .join(CALIBRATION, CALIBRATION.c.seq == PARAMETER.c.seq)
        .where(PARAMETER.c.arm == arm, PARAMETER.c.name == name, PARAMETER.c.status == "fitted")
        .where(CALIBRATION.c.converged, PARAMETER.c.sha256.not_in(withdrawn()))
        .order_by(PARAMETER.c.at, PARAMETER.c.seq)
    )
    return [
        Point(
            row["at"],
            row["value"],
            row["unit"],
            row["u"],
            None,
            None,
            None,
            PARAMETERS,
            PARAMETERS,
            None,
            row["sha256"],
        )
        for row in asked.rows(connection, asked_for)
    ]


def _point(row: asked.Row) -> Point:
    names = ("at", "value", "unit", "u", "k", "verdict", "source", "state", "artefact", "sha256")
    return Point(**{name: row[name] for name in names}, limit=row["limit_value"])


def calibrations(connection: Connection, arm: str) -> list[asked.Row]:
    """Of an arm, the earliest first, without those that were withdrawn."""
    asked_for = (
        select(CALIBRATION)
        .where(CALIBRATION.c.arm == arm, CALIBRATION.c.sha256.not_in(withdrawn()))
        .order_by(CALIBRATION.c.at, CALIBRATION.c.seq)
    )
    return asked.rows(connection, asked_for)


@dataclass(frozen=True)
class Outcome:
    """How a check or a test ended."""

    at: str
    sha256: str
    verdict: str | None
    """The worst of its figures'; None where none has one."""


def last_of(connection: Connection, arm: str, source: str) -> Outcome | None:
    """The newest that counts."""
    asked_for = (
        select(FIGURE.c.at, FIGURE.c.sha256, FIGURE.c.verdict)
        .where(FIGURE.c.arm == arm, FIGURE.c.source == source, FIGURE.c.sha256.not_in(withdrawn()))
        .order_by(FIGURE.c.at.desc(), FIGURE.c.seq.desc())
    )
    rows = asked.rows(connection, asked_for.limit(1))
    if not rows:
        return None
    at, sha256 = rows[0]["at"], rows[0]["sha256"]
    own = asked.rows(connection, select(FIGURE.c.verdict).where(FIGURE.c.sha256 == sha256))
    verdicts = [row["verdict"] for row in own if row["verdict"] is not None]
    return Outcome(at, sha256, min(verdicts, key=_badness) if verdicts else None)


_WORST = (BAD, OUT)
"""Verdicts, the worst first; others are better."""


def _badness(verdict: str) -> int:
    return _WORST.index(verdict) if verdict in _WORST else len(_WORST) + (verdict == GOOD)
