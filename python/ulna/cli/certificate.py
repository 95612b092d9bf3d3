"""`ulna certificate`: a calibration certificate on paper or for software, for the laboratory to check and sign."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.completing import languages
from ulna.cli.options import Force, Json, one_of
from ulna.cli.recorded import Record, record, recording
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
    as_pdf: Annotated[
        bool, typer.Option("--pdf", help="On paper, two to three pages; so says a file ending in .pdf too.")
    ] = False,
    annex: Annotated[
        bool, typer.Option("--annex", help="PDF: with how the fit went, plots and outliers behind the certificate.")
    ] = False,
    language: Annotated[
        str | None, typer.Option("--language", metavar="CODE", help="PDF: en, de or zh.", autocompletion=languages)
    ] = None,
    study: Annotated[
        Path | None,
        typer.Option("--study", metavar="STUDY", help="PDF: of that calibration, where it is not found by itself."),
    ] = None,
    fonts: Annotated[
        Path | None,
        typer.Option("--fonts", metavar="FOLDER", help="PDF: fonts, looked at before the machine's."),
    ] = None,
    verification: Annotated[
        list[Path] | None,
        typer.Option("--verification", metavar="FILE", help="A verification.json of the same arm; may be repeated."),
    ] = None,
    make_lab: Annotated[bool, typer.Option("--make-lab", help="Write a laboratory file to fill in.")] = False,
    out: Annotated[Path | None, typer.Option("-o", "--out", metavar="FILE", help="File to write.")] = None,
    force: Force = False,
    as_json: Json = False,
    to_record: Record = None,
) -> None:
    """Write a calibration certificate, on paper (PDF) or for software (XML): the parameters with their expanded
    uncertainties, what was not determined, test values with statements of conformity, and what the laboratory file
    says.

    It is an unsigned draft: the laboratory checks it and signs it. What the laboratory file leaves out is said to be
    missing, never made up. The covariance is in the XML, how the fit went in the annex of the PDF (--annex).

    Example: [bold]ulna certificate out/result.json lab.toml -o certificate.pdf[/bold]
    """
    from ulna.cli import output
    from ulna.cli.endings import by_ending
    from ulna.cli.printed.certificate import certificate_report
    from ulna.documents.certificate import certificate as certificate_pdf
    from ulna.documents.dcc.document import dcc_certificate
    from ulna.documents.languages.languages import LANGUAGES
    from ulna.documents.write import NEEDS
    from ulna.formats.output import refuse_inputs, write_file
    from ulna.ground.errors import UlnaInputError
    from ulna.ground.extras import need

    of_pdf = {"--annex": annex, "--language": language, "--study": study, "--fonts": fonts}
    if out is None:
        raise UlnaInputError("option -o is missing; expected the file to write. Add -o FILE.")
    if make_lab:
        from ulna.documents.laboratory.template import TEMPLATE

        if result is not None or dcc or as_pdf or force or verification or any(of_pdf.values()) or to_record:
            raise UlnaInputError(
                "option --make-lab: writes an empty laboratory file and takes no RESULT, LAB, --dcc, --pdf, "
                "--verification, --force, --record or option of a PDF. Leave them out."
            )
        write_file(out, TEMPLATE)
        output.say(f"{out}: fill it in, then: ulna certificate RESULT {out} -o FILE.pdf")
        return
    if result is None or laboratory is None:
        raise UlnaInputError(
            f"argument {'RESULT' if result is None else 'LAB'} is missing; expected the result.json of a calibration "
            "and a laboratory file. Give both, or write a laboratory file with --make-lab."
        )
    forms = [name for name, given in (("dcc", dcc), ("pdf", as_pdf)) if given]
    if len(forms) > 1:
        raise UlnaInputError("options --dcc and --pdf: one file cannot be both. Write each with a command of its own.")
    (form,) = forms or by_ending(out, {".pdf": "pdf", ".xml": "dcc"}, [], folder=False)
    named = {".pdf": "pdf", ".xml": "dcc"}.get(out.suffix.lower(), form)
    if named != form:
        raise UlnaInputError(
            f"option --{form}: {out} ends in {out.suffix}; expected the ending of that form. Correct it."
        )
    given = [option for option, value in of_pdf.items() if value]
    if form != "pdf" and given:
        raise UlnaInputError(
            f"option {given[0]}: is of a PDF, and {out} becomes XML, which has the languages of the laboratory file "
            "and all that was computed. Leave it out, or name a file ending in .pdf."
        )
    tests = verification or []
    kept = recording(to_record, out)
    refuse_inputs([out], [result, laboratory, *tests, *([study] if study else [])])
    if form == "pdf":
        need("option --pdf", *NEEDS["pdf"])
        one_of("--language", language or "en", tuple(LANGUAGES))
        made = certificate_pdf(
            result, laboratory, tests, language=language or "en", annex=annex, study=study, fonts=fonts
        )
        write_file(out, made, force)
        if as_json:
            output.print_json({"file": str(out), "format": "PDF", "issued": False, "signed": False, "annex": annex})
    else:
        xml = dcc_certificate(result, laboratory, tests)
        write_file(out, xml.content, force)
        if as_json:
            output.print_json({"file": str(out), **xml.as_dict()})
        else:
            output.print_renderable(*certificate_report(xml.as_dict()))
    output.say(f"Written: {out}, an unsigned draft. The laboratory checks it and signs it.")
    record(kept, out)
