"""Typst: a fixed template and JSON in, a PDF out. The same data give the same bytes."""

from __future__ import annotations

import datetime
import json
import shutil
import tempfile
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any, Literal

from ulna.documents.pdf.fonts import Chosen
from ulna.ground.errors import UlnaInputError

#: archivable, and readable by machines and by people who cannot see it
STANDARDS: list[Literal["a-2a", "ua-1"]] = ["a-2a", "ua-1"]


def typeset(data: Mapping[str, Any], fonts: Chosen) -> bytes:
    """The PDF. Raises UlnaInputError where Typst cannot set it, as for a picture that is none."""
    compiled = _compiled(data, fonts, "pdf")
    if len(compiled) != 1:
        raise RuntimeError("one PDF expected")  # a mistake of ours, not of the user
    return compiled[0]


def pictures(data: Mapping[str, Any], fonts: Chosen, ppi: float) -> list[bytes]:
    """Each page as a PNG: for the documentation, and for looking at."""
    return _compiled(data, fonts, "png", ppi)


def _compiled(data: Mapping[str, Any], fonts: Chosen, kind: Literal["pdf", "png"], ppi: float = 144.0) -> list[bytes]:
    import typst

    standards: Any = _standards(data) if kind == "pdf" else []
    template = (resources.files("ulna.documents.pdf") / "certificate.typ").read_bytes()
    inputs = {"data": json.dumps(data, ensure_ascii=False, allow_nan=False)}
    with tempfile.TemporaryDirectory(prefix="ulna-fonts-") as folder:
        for number, file in enumerate(fonts.files):
            _lay(file, Path(folder) / f"{number}-{file.name}")
        found = typst.Fonts(include_system_fonts=False, include_embedded_fonts=True, font_paths=[folder])
        try:
            # the root is a folder with nothing but fonts: neither the template nor a picture can read a file
            compiler = typst.Compiler(template, root=folder, font_paths=found, sys_inputs=inputs)
            compiled, warnings = compiler.compile_with_warnings(
                format=kind,
                ppi=ppi,
                pdf_standards=standards,
                timestamp=_stamp(data),
            )
        except typst.TypstError as error:
            hints = "".join(f" ({hint})" for hint in error.hints)
            raise UlnaInputError(f"PDF: Typst could not set it: {error.message}{hints}.") from None
    if warnings:
        raise RuntimeError(f"Typst warns: {'; '.join(str(each) for each in warnings)}")  # a mistake of ours
    if compiled is None:
        raise RuntimeError("Typst gave nothing")  # a mistake of ours
    return [compiled] if isinstance(compiled, bytes) else compiled


def _standards(data: Mapping[str, Any]) -> list[Literal["a-2a", "ua-1"]]:
    """A sheet to be filled in by hand has no date, and what has none is not for archives."""
    return list(STANDARDS) if data.get("archived", True) else ["ua-1"]


def _stamp(data: Mapping[str, Any]) -> int:
    """The document's date, never the clock's."""
    year, month, day = data["date"] or (1970, 1, 1)
    return int(datetime.datetime(year, month, day, tzinfo=datetime.UTC).timestamp())


def _lay(file: Path, target: Path) -> None:
    try:
        target.symlink_to(file.resolve())
    except OSError:  # systems that allow no links
        shutil.copyfile(file, target)
