"""What was done with an arm between the last time that it was found good and the first time that it was found bad; what
rests on an artefact."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import Connection, select

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import listed, worded
from ulna.records import asked
from ulna.records.filed.kind import BAD, GOOD, OUT
from ulna.records.history import Happening, history, withdrawn
from ulna.records.tables import CERTIFICATE, FIGURE, USED

_LEFT = ("as-left", "after", "left-out-after")
"""States after an adjustment: they say nothing of what was measured before."""


@dataclass(frozen=True)
class Impact:
    """Between two times."""

    name: str
    good: str | None
    """When it was last found good; None: never before."""
    bad: str
    """When it was found bad."""
    why: str
    """By which figure, or by whose word."""
    touched: list[Happening]
    """What was filed, issued and what happened meanwhile."""
    certificates: list[str]
    """Numbers, of those issued meanwhile: for recall."""


def impact(connection: Connection, name: str, since: str | None = None, until: str | None = None) -> Impact:
    """Of an arm between its last good and its first bad figure after it, or between stated times; of an artefact
    between stated times. Times ISO 8601, UTC. Raises UlnaInputError where no figure was bad and no time is stated."""
    row = asked.equipment(connection, name)
    if since is not None and until is not None and since > until:
        raise UlnaInputError(f"record: good on {since[:10]}, bad on {until[:10]}; expected good first. Turn them.")
    good, bad, why = since, until, worded("as stated")
    if row["kind"] == "artefact":
        if until is None:
            raise UlnaInputError(
                f"record: when '{name}' was found wrong is not said; expected a day. Give --until DAY."
            )
    elif until is None:
        good, bad, why = _found(connection, row["name"], since)
    assert bad is not None
    if row["kind"] == "artefact":
        touched = _rests_on(connection, row["name"], good, bad)
    else:
        touched = [each for each in history(connection, row["name"]) if (good or "") < each.at <= bad]
    return Impact(row["name"], good, bad, why, touched, _certificates(connection, touched))


def _found(connection: Connection, arm: str, since: str | None) -> tuple[str | None, str, str]:
    """The last bad run: when it was good before, when it was first bad, by which figure."""
    asked_for = (
        select(FIGURE)
        .where(FIGURE.c.arm == arm, FIGURE.c.verdict.in_((GOOD, BAD, OUT)), FIGURE.c.state.not_in(_LEFT))
        .where(FIGURE.c.sha256.not_in(withdrawn()), FIGURE.c.at > (since or ""))
        .order_by(FIGURE.c.at, FIGURE.c.seq, FIGURE.c.line)
    )
    times: dict[str, list[asked.Row]] = {}
    for row in asked.rows(connection, asked_for):
        times.setdefault(row["at"], []).append(row)
    good, first, why, was_good = since, None, "", True
    last_good = since
    for at, rows in times.items():
        worst = next((row for row in rows if row["verdict"] in (BAD, OUT)), None)
        if worst is None:
            last_good, was_good = at, True
        elif was_good:
            good, first, why, was_good = last_good, at, _why(worst), False
    if first is None:
        raise UlnaInputError(
            f"record: no figure of '{arm}' failed; expected a check or a test that did. Name the times with --since "
            "DAY --until DAY."
        )
    return good, first, why


def _why(row: asked.Row) -> str:
    said = [f"{row['name']} {row['value']:.4g} {row['unit']}"]
    if row["limit_value"] is not None:
        said.append(worded("limit {limit} {unit}", limit=f"{row['limit_value']:g}", unit=row["unit"]))
    if row["verdict"] == OUT:
        said.append(worded("out of control"))
    return worded("{what} ({source})", what=listed(said), source=row["source"])


def _rests_on(connection: Connection, artefact: str, good: str | None, bad: str) -> list[Happening]:
    """What was filed of any arm that rests on an artefact."""
    asked_for = (
        select(USED)
        .where(USED.c.artefact == artefact, USED.c.at > (good or ""), USED.c.at <= bad)
        .order_by(USED.c.at, USED.c.seq)
    )
    return [
        Happening(row["at"], "rests on it", f"{row['arm']}: {row['sha256'][:12]}…", "", row["seq"], row["sha256"])
        for row in asked.rows(connection, asked_for)
    ]


def _certificates(connection: Connection, touched: list[Happening]) -> list[str]:
    """Of what was filed, and those that were issued meanwhile."""
    files = {each.sha256 for each in touched if each.sha256}
    asked_for = select(CERTIFICATE.c.number, CERTIFICATE.c.of, CERTIFICATE.c.sha256).order_by(CERTIFICATE.c.seq)
    return [number for number, of, sha256 in connection.execute(asked_for) if of in files or sha256 in files]
