"""One cell of an Excel workbook as it stands in the file: its formula, and the text of its value.

The parts of the file are those of ECMA-376 (Office Open XML), Part 1, sections 18.2 and 18.3.
"""

from __future__ import annotations

import lzma
import posixpath
import re
import xml.etree.ElementTree as ElementTree
import zipfile
import zlib
from pathlib import Path

_ID = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"

_NOT_AS_EXPECTED = (
    *(zipfile.BadZipFile, zlib.error, lzma.LZMAError, ElementTree.ParseError),
    *(OSError, EOFError, LookupError, ValueError, RuntimeError, StopIteration),
)
"""What a damaged archive, or one that another program built otherwise, ends in."""

_CHUNK = 1 << 20
_MOST_CELLS = 30_000_000
"""Cells of a span that are read, however few of them hold anything: about 1 GB."""
_WIDE = re.compile(rb'<c [^>]*?\br="([A-Z]{2,3}[0-9]{1,7})"')
_ANY = re.compile(rb'<c [^>]*?\br="([A-Z]{1,3}[0-9]{1,7})"')


def address(sheet: str, row: int, column: int) -> str:
    """`Sheet1!C7`, counted from 0; without the sheet `C7`. A sheet's name is in quotes where Excel writes them."""
    letters = ""
    number = column + 1
    while number:
        number, rest = divmod(number - 1, 26)
        letters = chr(ord("A") + rest) + letters
    if not sheet:
        return f"{letters}{row + 1}"
    plain = re.fullmatch(r"[A-Za-z_][A-Za-z0-9_.]*", sheet)
    quoted = sheet if plain else "'" + sheet.replace("'", "''") + "'"
    return f"{quoted}!{letters}{row + 1}"


def stored_cell(path: Path, sheet: str, reference: str) -> tuple[str | None, str]:
    """The formula (None where there is none) and the text of the value of one cell, such as C7; (None, "") where the
    file has no such cell, or is not built as expected: this only makes a message clearer."""
    try:
        with zipfile.ZipFile(path) as archive, archive.open(_part(archive, sheet)) as stream:
            for _, element in ElementTree.iterparse(stream):
                if element.tag.endswith("}row"):
                    element.clear()
                elif element.tag.endswith("}c") and element.get("r") == reference:
                    formula = next((each.text or "" for each in element if each.tag.endswith("}f")), None)
                    return formula, next((each.text or "" for each in element if each.tag.endswith("}v")), "")
    except _NOT_AS_EXPECTED:
        pass
    return None, ""


def far_cell(path: Path, sheet: str) -> str | None:
    """The cell because of which a sheet spans far more than it holds, such as XFD1048576; None where none does, or the
    file is not built as expected. Whoever reads the whole span would need memory for all that lies between."""
    count, last, widest, row = 0, b"", b"A1", 0
    try:
        with zipfile.ZipFile(path) as archive, archive.open(_part(archive, sheet)) as stream:
            rest = b""
            while chunk := stream.read(_CHUNK):
                chunk = rest + chunk
                end = chunk.rfind(b"<") if len(chunk) < 2 * _CHUNK else len(chunk)
                chunk, rest = chunk[:end], chunk[end:]
                count += chunk.count(b"<c ")
                for found in _WIDE.finditer(chunk):  # rare: beyond column Z
                    widest = max(widest, found[1], key=_column)
                    last = found[1]
                at = chunk.rfind(b"<c ")
                match = _ANY.search(chunk, at) if at >= 0 else None
                last = match[1] if match else last
                row = max(row, int(re.sub(rb"[A-Z]", b"", last) or b"0"))
    except _NOT_AS_EXPECTED:
        return None
    span = row * max(_column(widest), 26)
    if span < _MOST_CELLS or 20 * count > span:
        return None
    return (widest if _column(widest) > 26 else last).decode()


def _column(reference: bytes) -> int:
    """The number of a cell's column, from 1."""
    number = 0
    for letter in reference.rstrip(b"0123456789"):
        number = 26 * number + letter - ord("A") + 1
    return number


def _part(archive: zipfile.ZipFile, sheet: str) -> str:
    """Name of the archive's part that holds a sheet."""
    book = ElementTree.fromstring(archive.read("xl/workbook.xml"))
    key = next(each.get(_ID) for each in book.iter() if each.tag.endswith("}sheet") and each.get("name") == sheet)
    links = ElementTree.fromstring(archive.read("xl/_rels/workbook.xml.rels"))
    target = next(each.get("Target") or "" for each in links if each.get("Id") == key)
    return posixpath.normpath(posixpath.join("/xl", target)).lstrip("/")
