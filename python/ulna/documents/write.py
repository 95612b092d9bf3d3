"""Writing reports: where each format goes, and all of them or none."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

from ulna.documents.content.content import Content
from ulna.formats.output import check_output, output_folder, refuse_inputs, write_file
from ulna.ground.errors import UlnaInputError
from ulna.ground.extras import need


def _html(content: Content, language: str, _: Path | None) -> bytes:
    from ulna.documents.html.page import render

    return render(content, language).encode()


def _pdf(content: Content, language: str, fonts: Path | None) -> bytes:
    from ulna.documents.pdf.render import render

    return render(content, language, fonts)


FORMATS: dict[str, Callable[[Content, str, Path | None], bytes]] = {"html": _html, "pdf": _pdf}
"""Format → how a content becomes a file of it, in a language, with the fonts of a folder."""

NEEDS = {"html": (), "pdf": ("typst", "matplotlib", "fontTools")}
"""Format → packages that not everybody has."""


def targets(out: Path, formats: Sequence[str], force: bool) -> dict[str, Path]:
    """Format → file: `out` itself where it ends in the one format's name, else report.FORMAT in the folder `out`.

    Raises UlnaInputError where a file exists and `force` is not given, the place is none, or what writes a format is
    not installed.
    """
    for each in formats:
        need(f"option --{each}", *NEEDS[each])
    known = {f".{each}" for each in FORMATS}
    if out.suffix.lower() in known and not out.is_dir():
        if len(formats) > 1 or out.suffix.lower() != f".{formats[0]}":
            raise UlnaInputError(
                f"option -o: {out} names one {out.suffix[1:].upper()} file, but {' and '.join(formats)} was asked for; "
                "expected a folder, or a file of that format. Correct it."
            )
        check_output(out.parent, [out.name], force)
        return {formats[0]: out}
    names = {each: f"report.{each}" for each in formats}
    check_output(out, list(names.values()), force)
    return {each: out / file for each, file in names.items()}


def write_report(
    content: Content,
    wanted: Mapping[str, Path],
    language: str,
    inputs: Iterable[Path],
    force: bool,
    fonts: Path | None = None,
) -> None:
    """All formats or none. Raises UlnaInputError where a file would take the place of one that was read.

    fonts: a folder with fonts for the PDF, looked at before those of the machine.
    """
    refuse_inputs(wanted.values(), [*inputs, *(Path(file.path) for file in content.provenance.files)])
    made = {path: FORMATS[each](content, language, fonts) for each, path in wanted.items()}
    if len(made) == 1:
        ((path, rendered),) = made.items()
        write_file(path, rendered, force)
        return
    folder = next(iter(made)).parent
    with output_folder(folder, [path.name for path in made], force) as staging:
        for path, rendered in made.items():
            (staging / path.name).write_bytes(rendered)
