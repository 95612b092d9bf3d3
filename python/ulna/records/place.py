"""Where a record is: a bench folder, and how it is found without being typed."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import Literal

from ulna.formats.models import Strict, fill
from ulna.formats.output import write_file
from ulna.formats.toml import check_format, read_toml
from ulna.formats.toml_text import toml_value
from ulna.ground.errors import UlnaInputError

BENCH, DATABASE, FILES, LINKS = "bench.toml", "record.sqlite", "objects", "chain"
"""In a bench folder: what it is, the database where it is SQLite, originals, the entries' files."""
FORMAT: Literal["ulna-bench/1"] = "ulna-bench/1"
WHERE, WHO = "ULNA_RECORDS", "ULNA_BY"
"""In the environment: the folder, and who works."""
_NETWORK = ("nfs", "nfs4", "cifs", "smb3", "smbfs", "9p", "afs", "fuse.sshfs", "davfs")


class BenchFile(Strict):
    """`bench.toml`: that a folder is a record, and where its database is."""

    format: Literal["ulna-bench/1"]
    database: str | None = None
    """URL of a PostgreSQL database; none: SQLite in the folder."""


class RecordTable(Strict):
    """Of a settings file: where the record is, and who works with it."""

    folder: str | None = None
    by: str | None = None


class SettingsFile(Strict):
    """What somebody need not type: `settings.toml`."""

    format: Literal["ulna-settings/1"]
    record: RecordTable = RecordTable()


def settings_path() -> Path:
    """Where this person's settings file is, or would be."""
    if sys.platform == "win32":
        base = os.environ.get("APPDATA") or str(Path.home() / "AppData" / "Roaming")
    else:
        base = os.environ.get("XDG_CONFIG_HOME") or str(Path.home() / ".config")
    return Path(base) / "ulna" / "settings.toml"


def settings() -> RecordTable:
    """What it says of records. Raises UlnaInputError for a file that is none."""
    path = settings_path()
    if not path.is_file():
        return RecordTable()
    document, _ = read_toml(path, 'a settings file (TOML, format = "ulna-settings/1")')
    check_format(document, path, "ulna-settings")
    return fill(SettingsFile, document, path).record


def found(given: str | os.PathLike[str] | None) -> Path:
    """The bench folder: as given, as the environment says, as the settings say. Raises UlnaInputError where nobody
    says."""
    said = os.fspath(given) if given is not None else os.environ.get(WHERE) or settings().folder
    if not said:
        raise UlnaInputError(
            f'no record is named; expected its folder. Give --records DIR, set {WHERE}, or write folder = "DIR" below '
            f"[record] in {settings_path()}. A new one: ulna record init DIR."
        )
    return Path(said)


def bench_file(folder: Path) -> BenchFile:
    """Raises UlnaInputError for a folder that is no record."""
    path = folder / BENCH
    if not path.is_file():
        raise UlnaInputError(
            f"{folder}: no record ({BENCH} is not there). Name another, or: ulna record init {folder}."
        )
    document, _ = read_toml(path, "a record's bench.toml")
    check_format(document, path, "ulna-bench")
    return fill(BenchFile, document, path)


def url_of(folder: Path, file: BenchFile) -> str:
    """Of the database. Raises UlnaInputError for SQLite on a disk of another machine, whose locks cannot be relied
    on."""
    if file.database is not None:
        return file.database
    kind = _kind_of_disk(folder)
    if kind in _NETWORK:
        raise UlnaInputError(
            f"{folder}: is on another machine's disk ({kind}), where SQLite may lose what several write. Keep it on a "
            "disk of this machine, or give it a PostgreSQL database: ulna record init --database URL."
        )
    return f"sqlite:///{(folder / DATABASE).absolute()}"


def make_folder(folder: Path, database: str | None) -> None:
    """A bench folder without a record in it. Raises UlnaInputError where there is something."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise UlnaInputError(f"{folder}: there is something already; expected a new or an empty folder. Name another.")
    file = BenchFile(format=FORMAT, database=database)
    if database is None:
        folder.mkdir(parents=True, exist_ok=True)
        url_of(folder, file)
    said = f'format = "{FORMAT}"\n' + ("" if database is None else f"database = {toml_value(database)}\n")
    write_file(folder / BENCH, said)


def unmade(folder: Path, there: bool) -> None:
    """Take away what `make_folder` and a database that was not finished left; there: the folder was there before."""
    with suppress(OSError):
        for name in (BENCH, DATABASE, f"{DATABASE}-wal", f"{DATABASE}-shm", f"{DATABASE}-journal"):
            (folder / name).unlink(missing_ok=True)
        if not there:
            folder.rmdir()


def _kind_of_disk(folder: Path) -> str:
    """As Linux calls it; "" where nobody says."""
    try:
        lines = Path("/proc/self/mounts").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    place, best, kind = str(folder.resolve()), "", ""
    for line in lines:
        point, called = line.split(" ")[1:3]
        point = point.replace("\\040", " ")
        if (place == point or place.startswith(point.rstrip("/") + "/")) and len(point) >= len(best):
            best, kind = point, called
    return kind
