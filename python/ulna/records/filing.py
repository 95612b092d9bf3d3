"""Files into the record: what they are is found out, what they say is checked as every command checks it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from sqlalchemy import Connection, select

from ulna.arm.file import result_file
from ulna.ground.errors import UlnaInputError
from ulna.records import asked, chain
from ulna.records.acts.filed import MAIN
from ulna.records.acts.standing import WITHDRAWN
from ulna.records.bench import Bench, Writing, checked_text
from ulna.records.filed.kind import About, FiledKind, in_utc
from ulna.records.filed.registry import format_of, kind_of
from ulna.records.projection import stated_rows
from ulna.records.registering import content_of, file_name, registered
from ulna.records.store import sha256_of
from ulna.records.tables import ENTRY, EQUIPMENT, FILE

ARMS = ("arm", "robot")


@dataclass(frozen=True)
class Filing:
    """A file to keep, and what is said of it."""

    path: Path
    arm: str | None = None
    """As registered; None: as the file says."""
    at: str | None = None
    """When it was measured; None: as the file says, else now."""
    artefacts: Sequence[str] = ()
    """Of the record, on which it rests."""
    with_it: Mapping[str, Path] = field(default_factory=dict)
    """What belongs to it: a role, such as "study" → the file."""
    anew: bool = False
    """An arm that is not registered is registered first; both or nothing."""


@dataclass(frozen=True)
class Filed:
    """What became of a file."""

    path: Path
    arm: str
    kind: str
    sha256: str
    seq: int
    """Of the entry that has it."""
    new: bool
    """False: it was there already."""


def file_all(bench: Bench, filings: Sequence[Filing]) -> list[Filed]:
    """All of them or none; a file that is there already of the same arm stays as it is. Raises UlnaInputError."""
    ready = [_ready(bench, each) for each in filings]
    with bench.writing() as doing:
        return [_filed(doing, each) for each in ready]


@dataclass(frozen=True)
class _Ready:
    """A file that was read and kept."""

    filing: Filing
    kind: FiledKind
    stated: dict[str, object]
    files: dict[str, str]
    arm: str
    """As it was said, or as the file says."""


def _ready(bench: Bench, filing: Filing) -> _Ready:
    path = result_file(filing.path)
    content = content_of(path)
    sha256 = sha256_of(content)
    said = format_of(path, content)
    kind = kind_of(said)
    read = kind.read(path)
    if content_of(path) != content:
        raise UlnaInputError(f"{path}: was changed while it was read. Try again.")
    beside = {role: content_of(each) for role, each in {**read.beside, **filing.with_it}.items()}
    names = {MAIN: file_name(path)} | {role: file_name(each) for role, each in filing.with_it.items()}
    at = _when(filing, read.at)
    stated: dict[str, object] = {"kind": kind.name, "at": at, "names": names, "artefacts": list(filing.artefacts)}
    if said is not None:
        stated["formats"] = {MAIN: said}
    if filing.arm is None and read.arm is None:
        raise UlnaInputError(f"{path}: does not say of which arm it is; expected that. Give --arm NAME.")
    arm = filing.arm or checked_text(str(read.arm), f"{path}: the arm's name")
    # what a reader takes and no row can be made of would be a record that nobody can make anew
    stated_rows(kind.rows(content, About(arm, sha256, at)), str(path))
    files = {role: bench.files.put(each) for role, each in {MAIN: content, **beside}.items()}
    return _Ready(filing, kind, stated, files, arm)


def _when(filing: Filing, said: str | None) -> str:
    """As whoever files it says, else as the file says, else now."""
    if filing.at is not None:
        return in_utc(filing.at, "option --at")
    return chain.now() if said is None else in_utc(said, f"{filing.path}: its time")


def _filed(doing: Writing, ready: _Ready) -> Filed:
    connection = doing.connection
    if ready.filing.anew and asked.last_of(connection, EQUIPMENT, "name", ready.arm) is None:
        registered(doing, checked_text(ready.arm, "name"), "arm")
    arm = _arm(connection, ready.arm, ready.filing)
    stated = dict(ready.stated)
    stated["artefacts"] = [asked.equipment(connection, each, ("artefact",))["name"] for each in ready.filing.artefacts]
    sha256, path, kind = ready.files[MAIN], ready.filing.path, ready.kind.name
    _stands(connection, sha256, path)
    there = there_already(connection, arm, sha256)
    if there is not None:
        return Filed(path, arm, kind, sha256, there, False)
    entry = doing.add("filed", arm, stated, ready.files)
    return Filed(path, arm, kind, sha256, entry.seq, True)


def _stands(connection: Connection, sha256: str, path: Path) -> None:
    """Raises UlnaInputError for a file that was withdrawn: of whatever arm it is said to be, it would count nowhere."""
    row = asked.standing(connection, sha256)
    if row is None or row["state"] != WITHDRAWN:
        return
    at, actor = connection.execute(select(ENTRY.c.at, ENTRY.c.actor).where(ENTRY.c.seq == row["seq"])).one()
    raise UlnaInputError(
        f"{path}: this file was filed and was withdrawn on {at[:10]} by {actor}: {row['reason']}. It is kept, and "
        "counts no longer; expected another one. If what was measured holds, let its command write it anew, and add "
        "that."
    )


def _arm(connection: Connection, name: str, filing: Filing) -> str:
    try:
        return str(asked.equipment(connection, name, ARMS)["name"])
    except UlnaInputError as error:
        if filing.arm is not None:
            raise
        raise UlnaInputError(
            f"{filing.path}: is of the arm '{name}'. {error} Or say of which it is with --arm."
        ) from None


def there_already(connection: Connection, arm: str, sha256: str) -> int | None:
    """Number of the entry by which a file of this arm was filed; None of none."""
    asked_for = (
        select(FILE.c.seq)
        .join(ENTRY, ENTRY.c.seq == FILE.c.seq)
        .where(FILE.c.sha256 == sha256, FILE.c.role == MAIN, ENTRY.c.subject == arm, ENTRY.c.act == "filed")
        .order_by(FILE.c.seq)
        .limit(1)
    )
    return connection.scalar(asked_for)
