"""`ulna record add`, `list`, `show`, `withdraw`: files, and what there is."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Force, Json
from ulna.cli.recording.options import By, Where, opened
from ulna.cli.running import guard


@guard
def add(
    files: Annotated[
        list[Path],
        typer.Argument(metavar="FILE", help="Files, or folders with a result.json.", show_default=False),
    ],
    arm: Annotated[
        str | None, typer.Option("--arm", metavar="NAME", help="Of which arm; else as the file says.")
    ] = None,
    at: Annotated[
        str | None, typer.Option("--at", metavar="TIME", help="When it was measured; else when the file was made.")
    ] = None,
    on: Annotated[
        list[str] | None,
        typer.Option("--on", metavar="ARTEFACT", help="On which of the record it rests; may be repeated."),
    ] = None,
    study: Annotated[
        Path | None, typer.Option("--study", metavar="FILE", help="The study of a result, kept with it.")
    ] = None,
    readings: Annotated[
        list[Path] | None,
        typer.Option("--readings", metavar="FILE", help="Readings of a result, kept with it; may be repeated."),
    ] = None,
    where: Where = None,
    by: By = None,
    as_json: Json = False,
) -> None:
    """File results, evaluations, tests, arms, or any other file of an arm: all of them or none.

    What each is, is found out; what Ulna made is read and checked as every command does. The files are kept by their
    SHA-256, as they are. One that is there already stays.

    Example: [bold]ulna record add out/result.json --study study.toml --readings bars.csv --on KB-443[/bold]
    """
    from dataclasses import asdict

    from ulna.cli import output
    from ulna.ground.errors import UlnaInputError

    beside = {"study": study} if study is not None else {}
    beside |= {f"readings {k}": each for k, each in enumerate(readings or [], start=1)}
    if beside and len(files) > 1:
        raise UlnaInputError(
            "options --study, --readings: belong to one FILE; expected one. Add the others by themselves."
        )
    made = opened(where, by).add(*files, arm=arm, at=at, artefacts=on or [], with_it=beside)
    if as_json:
        output.print_json({"filed": [{**asdict(each), "path": str(each.path)} for each in made]})
    for each in made:
        was = "filed" if each.new else "was there already"
        output.say(f"{each.path}: {each.kind} of {each.arm}, {was} ({each.sha256[:12]}…). Entry {each.seq}.")


@guard
def list_(
    kind: Annotated[
        str | None,
        typer.Option("--kind", metavar="KIND", help="arm, robot, probe, artefact or thermometer alone."),
    ] = None,
    where: Where = None,
    as_json: Json = False,
) -> None:
    """List what is registered.

    Example: [bold]ulna record list[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.records import listed_report

    found = opened(where).equipment(kind)
    if as_json:
        output.print_json({"equipment": found})
    else:
        output.print_renderable(*listed_report(found, output.columns()))


@guard
def show(
    sha256: Annotated[
        str, typer.Argument(metavar="FILE", help="SHA-256 of a filed file, or its first letters.", show_default=False)
    ],
    out: Annotated[Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write it there.")] = None,
    where: Where = None,
    force: Force = False,
) -> None:
    """Say what a filed file is and of which arm, or write it out again as it was filed.

    Example: [bold]ulna record show 3f0c88a1 -o result.json[/bold]
    """
    from ulna.cli import output
    from ulna.formats.output import write_file
    from ulna.records.standing import filed

    records = opened(where)
    with records.bench.reading() as connection:
        name, arm = filed(connection, sha256)
    content = records.content(name)
    if out is not None:
        write_file(out, content, force)
    output.say(f"{name}: of {arm}, {len(content)} bytes." + (f" Written: {out}" if out is not None else ""))


@guard
def withdraw(
    subject: Annotated[
        str,
        typer.Argument(metavar="WHAT", help="A certificate's number, or a file's SHA-256.", show_default=False),
    ],
    reason: Annotated[str, typer.Option("--reason", metavar="TEXT", help="Why; it is kept.", show_default=False)],
    where: Where = None,
    by: By = None,
) -> None:
    """Withdraw a certificate or a filed file: it is kept, and counts no longer.

    Example: [bold]ulna record withdraw EX-2026-0042 --reason "wrong bar"[/bold]
    """
    from ulna.cli import output

    entry = opened(where, by).withdraw(subject, reason)
    output.say(f"{entry.subject}: withdrawn. Entry {entry.seq}.")


@guard
def issue(
    result: Annotated[
        str,
        typer.Argument(
            metavar="RESULT", help="An arm: its last calibration; or a SHA-256's beginning.", show_default=False
        ),
    ],
    laboratory: Annotated[Path, typer.Argument(metavar="LAB", help="The laboratory file (TOML).", show_default=False)],
    out: Annotated[
        Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write it there as well: .pdf, .xml.")
    ] = None,
    verification: Annotated[
        list[str] | None, typer.Option("--verification", metavar="FILE", help="A filed test; may be repeated.")
    ] = None,
    number: Annotated[
        str | None, typer.Option("--number", metavar="TEXT", help="Else the next by the record's pattern.")
    ] = None,
    language: Annotated[str, typer.Option("--language", metavar="CODE", help="en, de or zh.")] = "en",
    approved_by: Annotated[
        str | None, typer.Option("--approved-by", metavar="NAME", help="Who authorises it, where four eyes are needed.")
    ] = None,
    supersedes: Annotated[
        str | None, typer.Option("--supersedes", metavar="NUMBER", help="A certificate that it takes the place of.")
    ] = None,
    reason: Annotated[str | None, typer.Option("--reason", metavar="TEXT", help="Why.")] = None,
    where: Where = None,
    by: By = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Issue a certificate of a filed calibration: numbered, kept, with the head of the record on it, no draft any more.

    Example: [bold]ulna record issue P7 lab.toml -o certificate.pdf[/bold]
    """
    from ulna.cli import output
    from ulna.cli.endings import by_ending
    from ulna.cli.options import one_of
    from ulna.documents.languages.languages import LANGUAGES
    from ulna.formats.output import check_output, write_file

    one_of("--language", language, tuple(LANGUAGES))
    form = "pdf"
    if out is not None:
        form = (by_ending(out, {".pdf": "pdf", ".xml": "dcc"}, [], folder=False) or ["pdf"])[0]
        check_output(out.parent, [out.name], force)
    made = opened(where, by).issue(
        result,
        laboratory,
        verification=verification or [],
        number=number,
        form=form,
        language=language,
        approved_by=approved_by,
        supersedes=supersedes,
        reason=reason,
    )
    if out is not None:
        write_file(out, made.content, force)
    if as_json:
        output.print_json({"number": made.number, "arm": made.arm, "sha256": made.sha256, "head": made.head})
    output.say(f"Certificate {made.number} of {made.arm}: issued." + (f" Written: {out}" if out is not None else ""))


COMMANDS = {"add": add, "list": list_, "show": show, "issue": issue, "withdraw": withdraw}
