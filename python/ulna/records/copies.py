"""Copies of a record: a backup beside it, a zip to carry it elsewhere, a record out of such a zip."""

from __future__ import annotations

import json
import re
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ulna.formats.output import new_file
from ulna.formats.unpacked import check_unpacked
from ulna.ground.errors import UlnaInputError
from ulna.ground.version import VERSION
from ulna.records import chain
from ulna.records.bench import Bench
from ulna.records.entry import FIRST, Entry
from ulna.records.place import BENCH, FILES, LINKS
from ulna.records.rebuild import entry_of, in_order, rebuild
from ulna.records.store import sha256_of

FORMAT = "ulna-records/1"
MANIFEST = "manifest.json"
_MEMBER = re.compile(rf"(?:{FILES}|{LINKS})/([0-9a-f]{{2}})/(\1[0-9a-f]{{62}})")


@dataclass(frozen=True)
class Copied:
    """What is in a copy."""

    path: Path
    entries: int
    files: int
    head: str
    """ "seq:SHA-256", to be noted elsewhere."""


def export(bench: Bench, path: Path, force: bool = False) -> Copied:
    """Every entry and every file that one names, as a zip: whole, or not at all. Raises UlnaInputError."""
    with bench.database.reading() as connection:  # of any schema: the chain is the same in all
        entries = list(chain.walk(connection))
        seq, head = chain.head(connection)
    named = sorted({sha256 for entry in entries for sha256 in entry.files.values()})
    end = f"{seq}:{head}"
    manifest = {"format": FORMAT, "head": end, "entries": len(entries), "files": len(named)}
    with new_file(path, force) as staged, zipfile.ZipFile(staged, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as made:
        made.writestr(MANIFEST, json.dumps({**manifest, "program": "ulna", "version": VERSION}, indent=1) + "\n")
        for entry in entries:
            made.writestr(f"{LINKS}/{entry.sha256[:2]}/{entry.sha256}", entry.text)
        for sha256 in named:
            made.writestr(f"{FILES}/{sha256[:2]}/{sha256}", bench.files.get(sha256))
    return Copied(path, len(entries), len(named), end)


def backup(bench: Bench, folder: Path) -> Copied:
    """An export named by the day and the chain's end, read once more before it is said to be there. Raises
    UlnaInputError."""
    with bench.database.reading() as connection:
        seq, head = chain.head(connection)
    day = chain.now()[:10]
    path = folder / f"record-{day}-{seq}-{head[:12] or 'empty'}.zip"
    if path.exists():
        with _opened(path) as archive:
            return _checked(archive, path)
    export(bench, path)
    with _opened(path) as archive:
        return _checked(archive, path)


def imported(path: Path, folder: Path, database: str | None = None, by: str | None = None) -> Copied:
    """A new record from a zip: the same chain. Raises UlnaInputError for a zip that is none, or is damaged: then
    nothing is made."""
    if (folder / BENCH).exists():
        raise UlnaInputError(
            f"{folder}: is a record already; expected a new or an empty folder: an import makes a record and joins "
            "none, since each has a chain of its own. Name another, and file what is missing here: ulna record show "
            "FILE --records THERE -o FILE, ulna record add FILE."
        )
    with _opened(path) as archive:
        said = _checked(archive, path)
        bench = Bench.make(folder, database, by)
        for name in archive.namelist():
            found = _MEMBER.fullmatch(name)
            if found is not None:
                store = bench.files if name.startswith(f"{FILES}/") else bench.links
                store.put(archive.read(name))
    rebuild(bench)
    return Copied(folder, said.entries, said.files, said.head)


@contextmanager
def _opened(path: Path) -> Iterator[zipfile.ZipFile]:
    """Raises UlnaInputError for what is no zip, or one that is damaged."""
    try:
        with zipfile.ZipFile(path) as archive:
            yield archive
    except FileNotFoundError:
        raise UlnaInputError(f"{path}: file not found. Correct the path.") from None
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, EOFError, RuntimeError) as error:
        raise UlnaInputError(
            f"{path}: no zip of a record, or damaged ({error}). Make it with ulna record export."
        ) from None


def _checked(archive: zipfile.ZipFile, path: Path) -> Copied:
    """What is in it, all of it looked at. Raises UlnaInputError."""
    check_unpacked(path, sum(each.file_size for each in archive.infolist()), "its files")
    names = archive.namelist()
    for name in names:
        if name != MANIFEST and not _MEMBER.fullmatch(name):
            raise UlnaInputError(
                f"{path}: the name {name[:80]!r} in it is none of a record; expected {FILES}/ab/…, {LINKS}/ab/…. It "
                "was not made by ulna record export."
            )
    head, entries, files = _manifest(archive, names, path), list[tuple[str, Entry]](), 0
    for name in names:
        content = b"" if name == MANIFEST else archive.read(name)
        if name != MANIFEST and sha256_of(content) != name.rsplit("/", 1)[-1]:
            raise UlnaInputError(f"{path}: {name} is not what its name says: the zip was changed.")
        if name.startswith(f"{LINKS}/"):
            entries.append((name, entry_of(content, f"{path}: {name}")))
        files += name.startswith(f"{FILES}/")
    ordered = in_order([entry for _, entry in entries], str(path))
    last = ordered[-1] if ordered else None
    if head != (f"{last.seq}:{last.sha256}" if last else f"0:{FIRST}"):
        raise UlnaInputError(f"{path}: the chain in it does not end where its {MANIFEST} says: the zip was changed.")
    absent = {sha256 for entry in ordered for sha256 in entry.files.values()}
    absent -= {name.rsplit("/", 1)[-1] for name in names if name.startswith(f"{FILES}/")}
    if absent:
        raise UlnaInputError(f"{path}: {len(absent)} files that its entries name are not in it: the zip was changed.")
    return Copied(path, len(ordered), files, head)


def _manifest(archive: zipfile.ZipFile, names: list[str], path: Path) -> str:
    """The head. Raises UlnaInputError."""
    try:
        manifest = json.loads(archive.read(MANIFEST)) if MANIFEST in names else {}
        head = manifest["head"] if manifest.get("format") == FORMAT else None
    except (ValueError, LookupError, AttributeError):
        head = None
    if not isinstance(head, str):
        raise UlnaInputError(f"{path}: no {MANIFEST} of {FORMAT} in it; expected a zip that ulna record export made.")
    return head
