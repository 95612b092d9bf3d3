"""`ulna record arm`, `artefact`, `event`: what is said by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Json
from ulna.cli.recording.options import At, By, Name, Where, opened
from ulna.cli.running import guard


def _detail(name: str, what: str) -> typer.models.OptionInfo:
    option: typer.models.OptionInfo = typer.Option(f"--{name}", metavar="TEXT", help=what)
    return option


Maker = Annotated[str | None, _detail("maker", "Who made it.")]
Model = Annotated[str | None, _detail("model", "Which model it is.")]
Serial = Annotated[str | None, _detail("serial", "Its maker's number.")]
Owner = Annotated[str | None, _detail("owner", "Whose it is.")]
Location = Annotated[str | None, _detail("location", "Where it is.")]
Remark = Annotated[str | None, _detail("remark", "Anything else.")]
State = Annotated[
    str | None, typer.Option("--state", metavar="STATE", help="in use, quarantined or retired.", show_default=False)
]


@guard
def arm(
    name: Name,
    kind: Annotated[str, typer.Option("--kind", metavar="KIND", help="arm, robot, probe or thermometer.")] = "arm",
    of: Annotated[str | None, typer.Option("--of", metavar="ARM", help="Of a probe: its arm.")] = None,
    maker: Maker = None,
    model: Model = None,
    serial: Serial = None,
    firmware: Annotated[str | None, _detail("firmware", "Its version.")] = None,
    owner: Owner = None,
    location: Location = None,
    remark: Remark = None,
    state: State = None,
    where: Where = None,
    by: By = None,
    as_json: Json = False,
) -> None:
    """Register an arm, a robot, a probe or a thermometer; or say what is otherwise now. What is not said stays.

    Example: [bold]ulna record arm P7 --maker "Example Arms" --serial P07-0815[/bold]
    """
    details = {"maker": maker, "model": model, "serial": serial, "firmware": firmware, "owner": owner}
    details |= {"location": location, "remark": remark, "part_of": of}
    entry = opened(where, by).register(name, kind, state, **details)
    _said(entry, f"{entry.subject}: {entry.stated['kind']}, {entry.stated['state']}.", as_json)


@guard
def artefact(
    name: Name,
    value: Annotated[
        list[str] | None,
        typer.Option(
            "--value", metavar="QUANTITY=SIZE±U", help='Certified, mm: "length=443.172±0.001"; may be repeated.'
        ),
    ] = None,
    certificate: Annotated[
        Path | None, typer.Option("--certificate", metavar="FILE", help="Its certificate, to be kept.")
    ] = None,
    number: Annotated[str | None, _detail("number", "Of its certificate.")] = None,
    certified_by: Annotated[str | None, _detail("certified-by", "Who issued that.")] = None,
    valid_from: Annotated[
        str | None, typer.Option("--valid-from", metavar="DAY", help="From when it is relied on.")
    ] = None,
    valid_to: Annotated[str | None, typer.Option("--valid-to", metavar="DAY", help="Until when.")] = None,
    temperature: Annotated[
        float | None, typer.Option("--temperature", metavar="C", help="°C at which the values hold.")
    ] = None,
    expansion: Annotated[
        str | None, typer.Option("--expansion", metavar="A±U", help="Its coefficient of expansion, 1/K: 11.5e-6±1e-6.")
    ] = None,
    maker: Maker = None,
    model: Model = None,
    serial: Serial = None,
    owner: Owner = None,
    location: Location = None,
    remark: Remark = None,
    state: State = None,
    where: Where = None,
    by: By = None,
    as_json: Json = False,
) -> None:
    """Register an artefact, and what its certificate says: values with standard uncertainties, and until when.

    Example: [bold]ulna record artefact KB-443 --value "length=443.172±0.001" --number EX-2025-0911 --valid-to
    2027-09-30[/bold]
    """
    from ulna.ground.errors import UlnaInputError
    from ulna.records.said import expansion_said, values_said

    values = values_said(value or [])
    alpha, alpha_u = expansion_said(expansion)
    records = opened(where, by)
    details = {"maker": maker, "model": model, "serial": serial, "owner": owner, "location": location}
    if values:
        known = {row["name"] for row in records.equipment("artefact")}
        anew = name not in known or any([*details.values(), remark, state])
        entry = records.certify(
            name,
            values,
            certificate=certificate,
            number=number,
            by=certified_by,
            valid_from=valid_from,
            valid_to=valid_to,
            temperature_c=temperature,
            expansion_per_k=alpha,
            expansion_u_per_k=alpha_u,
            anew={**details, "remark": remark, "state": state} if anew else None,
        )
    else:
        of_certificate = (certificate, number, certified_by, valid_from, valid_to, temperature, alpha)
        if any(each is not None for each in of_certificate):
            raise UlnaInputError(
                f"artefact '{name}': a certificate without a value; expected one. Give it, such as "
                '--value "length=443.172±0.001".'
            )
        entry = records.register(name, "artefact", state, **details, remark=remark)
    _said(entry, f"{entry.subject}: {len(values)} certified value{'s' * (len(values) != 1)}.", as_json)


@guard
def event(
    name: Name,
    kind: Annotated[
        str,
        typer.Argument(
            metavar="KIND",
            help="knock, repair, move, adjustment, firmware, quarantine, release, note.",
            show_default=False,
        ),
    ],
    text: Annotated[str, typer.Argument(metavar="TEXT", help="What happened.", show_default=False)],
    at: At = None,
    file: Annotated[Path | None, typer.Option("--file", metavar="FILE", help="What shows it, to be kept.")] = None,
    where: Where = None,
    by: By = None,
    as_json: Json = False,
) -> None:
    """Say what happened to equipment. After a quarantine it is not in use until its release.

    Example: [bold]ulna record event P7 knock "fell against the table" --at 2026-05-04[/bold]
    """
    made = opened(where, by).event(name, kind, text, at, file)
    _said(made[-1], f"{made[0].subject}: {kind}.", as_json)


def _said(entry: object, message: str, as_json: bool) -> None:
    from ulna.cli import output
    from ulna.records.entry import Entry

    assert isinstance(entry, Entry)
    if as_json:
        import json

        output.print_json({**json.loads(entry.text), "sha256": entry.sha256})
    output.say(f"{message} Entry {entry.seq}.")


COMMANDS = {"arm": arm, "artefact": artefact, "event": event}
