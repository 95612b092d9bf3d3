"""`ulna certificate`: a digital calibration certificate, to be checked and signed by the laboratory."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Force, Json
from ulna.cli.running import guard


@guard
def certificate(
    result: Annotated[
        Path | None, typer.Argument(metavar="RESULT", help="The result.json of a calibration.", show_default=False)
    ] = None,
    laboratory: Annotated[
        Path | None,
        typer.Argument(metavar="LAB", help="The laboratory file (TOML): see --make-lab.", show_default=False),
    ] = None,
    dcc: Annotated[
        bool, typer.Option("--dcc", help="As XML: PTB's DCC 3.3.0; so says a file ending in .xml too.")
    ] = False,
    verification: Annotated[
        list[Path] | None,
        typer.Option("--verification", metavar="FILE", help="A verification.json of the same arm; may be repeated."),
    ] = None,
    make_lab: Annotated[bool, typer.Option("--make-lab", help="Write a laboratory file to fill in.")] = False,
    out: Annotated[Path | None, typer.Option("-o", "--out", metavar="FILE", help="File to write.")] = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Write a digital calibration certificate: the parameters with their expanded uncertainties and covariance, what
    was not determined, test values with statements of conformity, and what the laboratory file says.

    It is an unsigned draft: the laboratory checks it and signs it. What the laboratory file leaves out is said to be
    missing, never made up. The printed certificate comes from ulna report --pdf, from the same laboratory file.

    Example: [bold]ulna certificate out/result.json lab.toml -o certificate.xml[/bold]
    """
    from ulna.cli.endings import by_ending
    from ulna.formats.output import refuse_inputs, write_file
    from ulna.ground.errors import UlnaInputError

    if out is None:
        raise UlnaInputError("option -o is missing; expected the file to write. Add -o FILE.")
    if make_lab:
        from ulna.documents.laboratory.template import TEMPLATE

        if result is not None or dcc or force or verification:
            raise UlnaInputError(
                "option --make-lab: writes an empty laboratory file and takes no RESULT, LAB, --dcc, "
                "--verification or --force. Leave them out."
            )
        write_file(out, TEMPLATE)
        _say(f"{out}: fill it in, then: ulna certificate RESULT {out} --dcc -o FILE.xml")
        return
    if result is None or laboratory is None:
        raise UlnaInputError(
            f"argument {'RESULT' if result is None else 'LAB'} is missing; expected the result.json of a calibration "
            "and a laboratory file. Give both, or write a laboratory file with --make-lab."
        )
    if not dcc:
        if out.suffix.lower() == ".pdf":
            raise UlnaInputError(
                f"option -o: {out} ends in .pdf, and this command writes XML; expected .xml. Print a certificate with "
                f"ulna report {result} --lab {laboratory} -o {out}."
            )
        by_ending(out, {".xml": "dcc"}, [], folder=False)
    from ulna.cli import output
    from ulna.cli.printed.certificate import certificate_report
    from ulna.documents.dcc.document import dcc_certificate

    tests = verification or []
    refuse_inputs([out], [result, laboratory, *tests])
    made = dcc_certificate(result, laboratory, tests)
    write_file(out, made.content, force)
    if as_json:
        output.print_json({"file": str(out), **made.as_dict()})
    else:
        output.print_renderable(*certificate_report(made.as_dict()))
    output.say(f"Written: {out}, an unsigned draft. The laboratory checks it and signs it.")


def _say(message: str) -> None:
    from ulna.cli import output

    output.say(message)
