"""`ulna record init`, `verify`, `backup`, `export`, `import`, `migrate`, `rebuild`, `set`, `person`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Force, Json
from ulna.cli.recording.options import By, Where, opened
from ulna.cli.running import guard

Database = Annotated[
    str | None,
    typer.Option("--database", metavar="URL", help="An empty PostgreSQL database; else SQLite in the folder."),
]


@guard
def init(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A new or empty folder.", show_default=False)],
    database: Database = None,
    by: By = None,
) -> None:
    """Make a new record.

    Example: [bold]ulna record init bench[/bold]
    """
    from ulna.cli import output
    from ulna.records.place import WHERE, settings_path
    from ulna.records.records import Records

    Records.init(folder, database, by)
    output.say(
        f"{folder}: a record, empty yet. So that nobody types it: {WHERE}={folder.absolute()}, or in "
        f"{settings_path()}\n"
        f'  format = "ulna-settings/1"\n  [record]\n  folder = "{folder.absolute()}"\n'
        "Next: ulna record arm NAME --serial NUMBER"
    )


@guard
def verify(
    head: Annotated[
        list[str] | None, typer.Option("--head", metavar="HEAD", help="A head noted earlier; may be repeated.")
    ] = None,
    heads: Annotated[Path | None, typer.Option("--heads", metavar="FILE", help="A file of such, one a line.")] = None,
    where: Where = None,
    as_json: Json = False,
) -> None:
    """Look at every entry, every file and every row: whether they are what was written.

    What was changed, deleted, added or relinked is named. It also prints the head of the chain: note it elsewhere (it
    stands on every certificate), and give it here another time. Exit code 1 where something is wrong.

    Example: [bold]ulna record verify[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.records import verified_report
    from ulna.records.verify import heads_in

    noted = [*(head or []), *(heads_in(heads) if heads is not None else [])]
    found = opened(where).verify(noted)
    if as_json:
        from dataclasses import asdict

        output.print_json({"format": "ulna-record-verified/1", **asdict(found), "good": found.good})
    else:
        output.print_renderable(*verified_report(found))
    raise typer.Exit(int(not found.good))


@guard
def backup(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Where to, on another disk.", show_default=False)],
    where: Where = None,
    as_json: Json = False,
) -> None:
    """Write all of the record as one zip, named by the day and the chain's end, and read it once more.

    Example: [bold]ulna record backup /mnt/backups[/bold]
    """
    _copied(opened(where).backup(folder), as_json)


@guard
def export(
    out: Annotated[Path, typer.Option("-o", "--out", metavar="FILE", help="Zip to write.", show_default=False)],
    where: Where = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Write all of the record as one zip, to be carried elsewhere.

    Example: [bold]ulna record export -o bench.zip[/bold]
    """
    _copied(opened(where).export(out, force), as_json)


@guard
def import_(
    archive: Annotated[Path, typer.Argument(metavar="ZIP", help="Of ulna record export.", show_default=False)],
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A new or empty folder.", show_default=False)],
    database: Database = None,
    by: By = None,
) -> None:
    """Make a record out of a zip, with the same chain. A zip that was changed is refused, and nothing is made.

    Example: [bold]ulna record import bench.zip bench-here[/bold]
    """
    from ulna.cli import output
    from ulna.records.records import Records

    Records.from_export(archive, folder, database, by)
    output.say(f"{folder}: the record of {archive}.")


@guard
def migrate(
    backup_to: Annotated[
        Path, typer.Option("--backup", metavar="DIR", help="Where the backup goes that is made first.")
    ] = Path("record-backups"),
    where: Where = None,
) -> None:
    """Bring the record of an earlier Ulna to this one's schema, after a backup.

    Example: [bold]ulna record migrate --backup /mnt/backups[/bold]
    """
    from ulna.cli import output
    from ulna.records.bench import Bench
    from ulna.records.place import found
    from ulna.records.records import Records

    folder = found(where)
    made = Records(Bench(folder)).migrate(backup_to)
    if made is None:
        output.say(f"{folder}: has this Ulna's schema already.")
        return
    output.say(f"{folder}: migrated. As it was before: {made.path}")


@guard
def rebuild(where: Where = None) -> None:
    """Make the database anew from the files: after it was damaged, lost, or changed by others.

    Example: [bold]ulna record rebuild[/bold]
    """
    from ulna.cli import output
    from ulna.records.bench import Bench
    from ulna.records.place import found
    from ulna.records.records import Records

    folder = found(where)
    count = Records(Bench(folder)).rebuild()
    output.say(f"{folder}: made anew from {count} entries.")


@guard
def set_(
    name: Annotated[str, typer.Argument(metavar="NAME", help="four-eyes or numbers.", show_default=False)],
    value: Annotated[str, typer.Argument(metavar="VALUE", help="yes or no; a pattern.", show_default=False)],
    where: Where = None,
    by: By = None,
) -> None:
    """Say how the record is kept: whether certificates need four eyes, and how they are numbered.

    Example: [bold]ulna record set numbers "AB-{year}-{n:04}"[/bold]
    """
    from ulna.cli import output

    opened(where, by).set(name, value)
    output.say(f"{name}: {value}.")


@guard
def person(
    name: Annotated[str, typer.Argument(metavar="NAME", help="As --by has it.", show_default=False)],
    role: Annotated[
        list[str] | None,
        typer.Option("--role", metavar="ROLE", help="reader, operator, reviewer, admin; may be repeated."),
    ] = None,
    where: Where = None,
    by: By = None,
) -> None:
    """Say who somebody is: a reader, an operator, a reviewer, an admin. Without a role: none any more.

    Example: [bold]ulna record person "Erika Muster" --role reviewer[/bold]
    """
    from ulna.cli import output

    opened(where, by).person(name, role or [])
    output.say(f"{name}: {', '.join(role or ['no role any more'])}.")


def _copied(made: object, as_json: bool) -> None:
    from dataclasses import asdict

    from ulna.cli import output
    from ulna.records.copies import Copied

    assert isinstance(made, Copied)
    if as_json:
        output.print_json({**asdict(made), "path": str(made.path)})
    output.say(f"{made.path}: {made.entries} entries, {made.files} files. Head: {made.head}")


FIRST = {"init": init}
COMMANDS = {
    "person": person,
    "set": set_,
    "verify": verify,
    "backup": backup,
    "export": export,
    "import": import_,
    "migrate": migrate,
    "rebuild": rebuild,
}
